// What the benchmark measures and how it is shown. A suite is one file, suite_NAME.cpp, and one line in suites().
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "raygrain/mesh.h"

namespace raygrain::bench {

struct Settings {
  bool quick = false;
  std::string scenes;             // folder of further models; may be empty
  std::string json;               // file to write; may be empty
  std::string filter;             // names of scenes hold this
  std::vector<unsigned> threads;  // each is measured; 1 first
  std::vector<size_t> sizes;      // rays a call, of the suite `sizes`; none is 0
};

/// How often two tracers differ about a set, and what brute force says of some of these rays.
struct Differences {
  size_t count = 0;              // hit here and miss there, or t further apart than rounding explains
  size_t asked = 0, agreed = 0;  // of up to ten: how often brute force gave raygrain's answer
};

/// What the areas of a light or a camera have beyond the global tree, beside the global tree of preset `best`.
struct AreaBuildRow {
  std::string scene;
  size_t triangles = 0;
  std::string structure;  // sun, lamp or camera
  unsigned threads = 1;
  double build_seconds = 0;
  double global_best_build_seconds = 0;  // binary and wide tree
  size_t memory_bytes = 0;
  double area_build_seconds = 0;        // the slowest of the areas, built alone
  size_t area_memory_bytes = 0;         // the coverage of the largest
  size_t global_memory_bytes = 0;       // wide and binary tree, as accelerators keep them; no corners of triangles
  size_t global_wide_memory_bytes = 0;  // ... the wide tree alone
};

/// One ray set, traced by one interface of raygrain and by Embree. 0 Mrays/s, and nothing: not measured.
struct Row {
  std::string suite, scene;
  size_t triangles = 0;
  std::string rays, query, api;  // query: closest or any
  unsigned threads = 1;
  std::string tree;  // raygrain's: the fastest of those that the suite built, as Embree's mode is
  double raygrain_mrays = 0, embree_single_mrays = 0, embree_best_mrays = 0;
  std::string embree_single_mode, embree_best_mode;
  std::optional<Differences> differences;  // from its best mode; of single rays from its best single-ray mode

  // Of the suite `rays` alone.
  double embree_sorted_mrays = 0;  // on rays sorted for it, the time for sorting counted
  std::string embree_sorted_mode;
  std::optional<Differences> sorted_differences;  // of batches
  double global_mrays = 0;                        // raygrain's global tree alone, by the same interface
  std::optional<AreaBuildRow> area_build;
  std::optional<double> break_even_rays;    // so many until the build has paid off against the global tree; inf: never
  std::optional<double> cost, global_cost;  // of turned scenes: pruned, a ray; cells and wide nodes 2, triangles 1.2
  int turn = -1;                            // which of the rotations or directions
};

struct BuildRow {
  std::string scene;
  size_t triangles = 0;
  std::string preset;
  unsigned threads = 1;
  double raygrain_seconds = 0, embree_seconds = 0;
  std::string embree_quality;
  size_t raygrain_bytes = 0, embree_bytes = 0;
  double sah_cost = 0;
};

/// One ray set in calls of `size` rays. Nanoseconds a ray; 0: not measured.
struct SizeRow {
  std::string scene;
  size_t triangles = 0;
  std::string rays;
  size_t size = 0;
  unsigned threads = 1;
  double batch = 0, single = 0, array = 0;  // by the batch call, one a call, in an array of any rays
  double global = 0;                        // in an array through the global tree alone
};

/// One structure alone on one ray set. 0 ns: not measured.
struct StructureRow {
  std::string scene;
  size_t triangles = 0;
  std::string rays, query, structure, api;  // api: single, batch or array
  unsigned threads = 1;
  double nanoseconds = 0, embree_single_nanoseconds = 0, embree_best_nanoseconds = 0;  // a ray
  std::string embree_single_mode, embree_best_mode;
  double build_seconds = 0, global_build_seconds = 0;  // of all that the set's areas have; of the global tree
  size_t memory_bytes = 0, global_bytes = 0;
  size_t differences = 0;  // answers that are not those of the global tree, bit by bit
};

struct Results {
  std::vector<Row> rows;
  std::vector<AreaBuildRow> area_builds;
  std::vector<BuildRow> builds;
  std::vector<SizeRow> sizes;
  std::vector<StructureRow> structures;
};

struct BenchScene {
  std::string name;
  TriangleMesh mesh;
};

struct Suite {
  const char* name;
  void (*run)(const Settings& settings, Results& results);
};

/// All suites, in the order in which they run.
std::vector<Suite> suites();

void run_general(const Settings& settings, Results& results);
void run_builds(const Settings& settings, Results& results);
void run_rays(const Settings& settings, Results& results);
void run_sizes(const Settings& settings, Results& results);
void run_structures(const Settings& settings, Results& results);

/// What load_bench_scene takes: the procedural scenes, in small or in both sizes, and the models of settings.scenes.
std::vector<std::string> scene_sources(const Settings& settings);
BenchScene load_bench_scene(const std::string& source);

/// Adds to the results and prints at once.
void report(const Row& row, Results& results);
void report(const AreaBuildRow& row, Results& results);
void report(const BuildRow& row, Results& results);
void report(const SizeRow& row, Results& results);
void print_summary(const Results& results);
void save_json(const Results& results, const std::string& path);

}  // namespace raygrain::bench

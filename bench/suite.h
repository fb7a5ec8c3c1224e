// What the benchmark measures and how it is shown.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "raygrain/mesh.h"

namespace raygrain::bench {

struct Settings {
  bool quick = false;
  std::string scenes;             // folder of further models; may be empty
  std::string json;               // file to write; may be empty
  std::string filter;             // names of scenes hold this
  std::vector<unsigned> threads;  // each is measured
};

struct Row {
  std::string suite, scene;
  size_t triangles = 0;
  std::string rays, query, api;
  unsigned threads = 1;
  double raygrain_mrays = 0, embree_single_mrays = 0, embree_best_mrays = 0;  // 0: not measured
  std::string embree_best_mode;
  size_t differences = 0;                      // hit here and miss there, or t further apart than rounding explains
  size_t oracle_agrees = 0, oracle_asked = 0;  // of the differences: how often brute force gave raygrain's answer
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

struct Results {
  std::vector<Row> rows;
  std::vector<BuildRow> builds;
};

struct BenchScene {
  std::string name;
  TriangleMesh mesh;
};
std::vector<std::string> scene_sources(const Settings& settings);
BenchScene load_bench_scene(const std::string& source);

void run_general(const BenchScene& scene, const Settings& settings, Results& results);

void print_row(const Row& row);
void print_summary(const Results& results);
void save_json(const Results& results, const std::string& path);

}  // namespace raygrain::bench

// Ordinary rays: raygrain's wide trees, one ray at a time and over arrays, against Embree's best modes.
#include "raygrain/refine.h"
#include "raygrain/wide.h"

#include "base/parallel.h"
#include "measure.h"
#include "presets.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

struct NamedTree {
  std::string name;
  WideBvh tree;
};

/// The presets that a user would take for many rays.
std::vector<NamedTree> build_trees(const TriangleMesh& mesh) {
  std::vector<NamedTree> trees;
  for (const Quality quality : {Quality::kBalanced, Quality::kBest}) {
    Bvh binary = build_preset(mesh, quality, 0);
    trees.push_back({name(quality), WideBvh(binary, mesh)});
    reinsert(binary);
    trees.push_back({std::string(name(quality)) + " reinsert", WideBvh(binary, mesh)});
  }
  return trees;
}

void trace_array(const WideBvh& tree, bool any, const Part& part, unsigned threads) {
  if (any)
    tree.occluded(part.rays, part.flags, threads);
  else
    tree.intersect(part.rays, part.hits, threads);
}

void trace_singly(const WideBvh& tree, bool any, const Part& part, unsigned threads) {
  parallel_for(part.rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) {
      if (any)
        part.flags[i] = tree.occluded(part.rays[i]);
      else
        part.hits[i] = tree.intersect(part.rays[i]);
    }
  });
}

std::vector<Entrant> entrants(const std::vector<NamedTree>& trees) {
  std::vector<Entrant> result;
  for (const NamedTree& named : trees) {
    const WideBvh& tree = named.tree;
    result.push_back({"array", named.name,
                      [tree](bool any, const Part& part, unsigned threads) { trace_array(tree, any, part, threads); }});
    result.push_back({"single", named.name, [tree](bool any, const Part& part, unsigned threads) {
                        trace_singly(tree, any, part, threads);
                      }});
  }
  return result;
}

void run_scene(const BenchScene& scene, const Settings& settings, Results& results) {
  measure_builds(scene, settings, results);
  const std::vector<NamedTree> trees = build_trees(scene.mesh);
  const Peer peer(scene.mesh);
  const size_t count = settings.quick ? 50000 : 100000;
  Row row;
  row.suite = "general";
  row.scene = scene.name;
  for (const BenchRays& set : general_ray_sets(scene.mesh, trees.front().tree, count))
    for (const unsigned threads : settings.threads)
      measure(row, scene.mesh, set, entrants(trees), peer, threads, results);
}

}  // namespace

void run_general(const Settings& settings, Results& results) {
  for (const std::string& source : scene_sources(settings)) run_scene(load_bench_scene(source), settings, results);
}

}  // namespace raygrain::bench

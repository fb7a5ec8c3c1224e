#include "presets.h"

#include <algorithm>
#include <limits>

#include "raygrain/accelerator.h"
#include "raygrain/analyze.h"

#include "base/timer.h"
#include "peer.h"

namespace raygrain::bench {

const char* name(Quality quality) {
  return quality == Quality::kFast ? "fast" : (quality == Quality::kBalanced ? "balanced" : "best");
}

Bvh build_preset(const TriangleMesh& mesh, Quality quality, unsigned threads) {
  Recipe recipe{"SAH", "ALL", "", {}};
  set_quality(recipe, quality);
  return build_global_tree(mesh, recipe, default_registry(), nullptr, {}, {threads, {}});
}

namespace {

PeerQuality counterpart(Quality quality) {
  return quality == Quality::kFast ? PeerQuality::kLow
                                   : (quality == Quality::kBalanced ? PeerQuality::kMedium : PeerQuality::kHigh);
}

BuildRow measure_build(const BenchScene& scene, Quality quality, unsigned threads) {
  BuildRow row;
  row.scene = scene.name;
  row.triangles = scene.mesh.triangle_count();
  row.preset = name(quality);
  row.threads = threads;
  row.raygrain_seconds = row.embree_seconds = std::numeric_limits<double>::infinity();
  row.embree_quality = Peer::is_there() ? name(counterpart(quality)) : "";
  const int rounds = row.triangles > 400000 ? 3 : 7;
  for (int round = 0; round < rounds; ++round) {
    const PeerBuild theirs = build_peer(scene.mesh, counterpart(quality), threads);
    row.embree_seconds = std::min(row.embree_seconds, theirs.seconds);
    row.embree_bytes = theirs.bytes;
    const Timer timer;
    const Bvh binary = build_preset(scene.mesh, quality, threads);
    const WideBvh tree(binary, scene.mesh, {.threads = threads});
    row.raygrain_seconds = std::min(row.raygrain_seconds, timer.seconds());
    row.raygrain_bytes = tree.memory_bytes();
    if (round == 0) row.sah_cost = analyze(binary, RayMeasure()).estimated_cost;
  }
  return row;
}

}  // namespace

void measure_builds(const BenchScene& scene, const Settings& settings, Results& results) {
  for (const Quality quality : {Quality::kFast, Quality::kBalanced, Quality::kBest})
    for (const unsigned threads : settings.threads) report(measure_build(scene, quality, threads), results);
}

}  // namespace raygrain::bench

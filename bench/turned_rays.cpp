#include "turned_rays.h"

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "raygrain/trace.h"

#include "area_builds.h"
#include "base/random.h"
#include "rays_rows.h"

namespace raygrain::bench {
namespace {

constexpr size_t kMostTriangles = 300000;  // 20 accelerators are there at once, up to 2 GB
constexpr int kTurns = 20, kRounds = 15;
constexpr int kGlobalRounds = 3;  // the global tree alone is slow, and no one asks it for a few per cent

/// A scene as it was turned, or under another sun.
struct Turned {
  int turn = 0;
  StructuredRays rays;
  Accelerator ours, global;
};

/// A rotation from three of uniform numbers, after Shoemake, "Uniform random rotations" (1992).
struct Rotation {
  double w, x, y, z;

  explicit Rotation(int turn) {
    Random random(static_cast<uint64_t>(turn) + 1);
    const double u = random.uniform(), a = 2 * std::numbers::pi * random.uniform();
    const double b = 2 * std::numbers::pi * random.uniform();
    w = std::sqrt(1 - u) * std::sin(a), x = std::sqrt(1 - u) * std::cos(a);
    y = std::sqrt(u) * std::sin(b), z = std::sqrt(u) * std::cos(b);
  }
  Vec3 operator()(Vec3 p) const {
    const Vec3d v = to_double(p), axis{x, y, z};
    const Vec3d twice = cross(axis, v) * 2.0;
    return to_float(v + twice * w + cross(axis, twice));
  }
};

constexpr Vec3 kTurnedSun{-0.42f, -0.85f, 0.31f};

class TurnedRays {
 public:
  TurnedRays(const BenchScene& scene, const Settings& settings, Results& results)
      : scene_(scene), settings_(settings), results_(results) {}

  void run() const {
    const int turns = settings_.quick ? 5 : kTurns;
    for (const std::string name : {"turned", "again"}) {  // `turn` of "again" is the number of the copy
      std::vector<Turned> all;
      for (int turn = 0; turn < turns; ++turn) {
        const Rotation rotation(name == "turned" ? turn : 0);
        TriangleMesh turned = scene_.mesh;
        for (Vec3& v : turned.vertices) v = rotation(v);
        all.push_back(turn_to(turn, turned, rotation(kTurnedSun)));
      }
      measure(name, all);
    }
    std::vector<Turned> all;
    for (int turn = 0; turn < turns; ++turn) {
      Vec3 light = Rotation(turn)(kTurnedSun);
      light.y = -std::abs(light.y) - 0.05f;  // from above
      all.push_back(turn_to(turn, scene_.mesh, light));
    }
    measure("directions", all);
  }

 private:
  Turned turn_to(int turn, const TriangleMesh& mesh, Vec3 light) const {
    StructuredRays rays = sun_rays(mesh, light, settings_.quick ? 50000 : 100000);
    Accelerator ours(mesh, rays.areas, rays_options());
    Accelerator global = ours.with_local_trees({});
    return {turn, std::move(rays), std::move(ours), std::move(global)};
  }

  /// All take turns, so that a machine that becomes slower meanwhile does not set them apart.
  void measure(const std::string& name, const std::vector<Turned>& all) const {
    const bool with_global = name != "again";
    std::vector<Contestant> contestants;
    for (const Turned& t : all)
      contestants.push_back(contestant(t.rays, [&](Answers& a) { trace_batch(t.ours, t.rays, a, 1); }));
    for (const Turned& t : all) {
      contestants.push_back(contestant(t.rays, [&](Answers& a) { trace_array(t.global, t.rays, a, 1); }));
      contestants.back().rounds = with_global ? kGlobalRounds : 0;
    }
    race_whole(contestants, kRounds, 1);
    for (size_t i = 0; i < all.size(); ++i) {
      Row row = structured_row(scene_, all[i].rays, 1);
      row.rays = name;
      row.raygrain_mrays = mrays(all[i].rays, contestants[i].seconds);
      if (with_global) row.global_mrays = mrays(all[i].rays, contestants[all.size() + i].seconds);
      add_costs(all[i], row);
      report(row, results_);
    }
  }

  /// With the paper's constants.
  static double cost_of(const TraceCounters& c) {
    return 2 * static_cast<double>(c.inner_hits) + 1.2 * static_cast<double>(c.leaf_triangles);
  }

  static void add_costs(const Turned& t, Row& row) {
    row.api = "batch";
    row.tree = "coverage";
    row.turn = t.turn;
    const std::vector<Ray>& rays = t.rays.set.rays;
    CoverageCounters counters;
    std::vector<uint32_t> rest;
    Answers answers(rays.size());
    t.ours.coverages()[0].occluded(t.rays.points, t.rays.common, answers.flags, rest, {}, 1, &counters);
    AcceleratorCounters world;
    t.global.occluded(rays, answers.flags, 1, &world);
    std::vector<Ray> left;  // by the coverage: they pay for the global tree, too
    for (const uint32_t ray : rest) left.push_back(rays[ray]);
    AcceleratorCounters others;
    t.global.occluded(left, std::span(answers.flags).first(left.size()), 1, &others);
    const auto per_ray = [&](double sum) { return sum / static_cast<double>(rays.size()); };
    // A cell counts as a node.
    row.cost = 2 + per_ray(1.2 * static_cast<double>(counters.triangle_tests) + cost_of(others.global));
    row.global_cost = per_ray(cost_of(world.global));
  }

  const BenchScene& scene_;
  const Settings& settings_;
  Results& results_;
};

}  // namespace

void run_turned(const BenchScene& scene, const Settings& settings, Results& results) {
  if (scene.mesh.triangle_count() < kMostTriangles) TurnedRays(scene, settings, results).run();
}

}  // namespace raygrain::bench

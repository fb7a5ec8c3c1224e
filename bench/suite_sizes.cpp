// How many rays a call must have to be worth its machinery: the batch calls and the arrays of any rays, in calls of one
// ray up to a million, beside the same rays one a call and beside the global tree's arrays.
#include <algorithm>
#include <limits>
#include <stdexcept>

#include "base/random.h"
#include "measure.h"
#include "race_whole.h"
#include "structured_rays.h"
#include "suite.h"

namespace raygrain::bench {
namespace {

constexpr int kRounds = 5;
constexpr size_t kLeastRays = 100000, kMostDistinctRays = 1000000;

/// A set, and the accelerator that knows its areas.
struct Sized {
  StructuredRays rays;
  Accelerator accelerator;
  Accelerator global;  // the same global tree alone
};

Accelerator make_accelerator(const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas) {
  AcceleratorOptions options;
  options.quality = Quality::kBalanced;
  options.space = LocalSpace::kNone;
  return Accelerator(TriangleMesh(mesh), areas, options);
}

template <class T>
void shuffle(std::vector<T>& values) {
  Random random(17);
  for (size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[random.below(i)]);
}

/// Rays of several sets in no order, each as any caller may have it in an array.
StructuredRays mix(const std::string& name, std::span<const StructuredRays* const> sets, size_t count) {
  StructuredRays mixed;
  mixed.set = {name, sets[0]->set.any, {}};
  for (const StructuredRays* s : sets)
    mixed.set.rays.insert(
        mixed.set.rays.end(), s->set.rays.begin(),
        s->set.rays.begin() + static_cast<std::ptrdiff_t>(std::min(s->set.rays.size(), count / sets.size())));
  shuffle(mixed.set.rays);
  return mixed;
}

/// As many rays as asked for, by repetition.
template <class T>
void repeat(std::vector<T>& values, size_t count) {
  const size_t distinct = values.size();
  if (distinct == 0 || distinct >= count) return values.resize(std::min(distinct, count));
  values.resize(count);
  for (size_t i = distinct; i < count; ++i) values[i] = values[i - distinct];
}

/// A part of a set in one call.
void call_batch(const Accelerator& accelerator, const StructuredRays& rays, size_t begin, size_t count, Answers& a,
                unsigned threads) {
  const std::span<const Vec3> points = std::span(rays.points).subspan(begin, count);
  const std::span<uint8_t> flags = std::span(a.flags).subspan(begin, count);
  const std::span<Hit> hits = std::span(a.hits).subspan(begin, count);
  if (rays.sharing == Sharing::kEnd) return accelerator.occluded_towards(points, rays.common, flags, threads);
  if (rays.sharing == Sharing::kStart) return accelerator.intersect_from(rays.common, points, hits, threads);
  if (rays.set.any) return accelerator.occluded(points, rays.common, flags, threads);
  accelerator.intersect(points, rays.common, hits, threads);
}

void call_array(const Accelerator& accelerator, const StructuredRays& rays, size_t begin, size_t count, Answers& a,
                unsigned threads) {
  const std::span<const Ray> some = std::span(rays.set.rays).subspan(begin, count);
  if (rays.set.any) return accelerator.occluded(some, std::span(a.flags).subspan(begin, count), threads);
  accelerator.intersect(some, std::span(a.hits).subspan(begin, count), threads);
}

class SizesSuite {
 public:
  SizesSuite(const BenchScene& scene, const Settings& settings, Results& results)
      : scene_(scene), settings_(settings), results_(results) {}

  void run() {
    const size_t most = std::ranges::max(settings_.sizes);
    sets_ = structured_ray_sets(scene_.mesh, std::clamp(most, kLeastRays, kMostDistinctRays));
    for (const char* name : {"sun_any", "point_any", "sun_closest_shuffled", "pinhole_closest_shuffled"}) {
      if (find(name).set.rays.empty()) continue;
      Accelerator accelerator = make_accelerator(scene_.mesh, find(name).areas);
      measure_sizes({find(name), accelerator, accelerator.with_local_trees({})});
    }
    run_mixed();
  }

 private:
  const StructuredRays& find(const std::string& name) const {
    return *std::ranges::find(sets_, name, [](const StructuredRays& s) { return s.set.name; });
  }

  /// Through one accelerator that knows a sun, a lamp and a camera.
  void run_mixed() {
    const StructuredRays &sun = find("sun_any"), &lamp = find("point_any"), &any = find("foreign_any");
    const StructuredRays &first = find("sun_closest_shuffled"), &camera = find("pinhole_closest_shuffled");
    const StructuredRays& closest = find("foreign_closest");
    std::vector<InfluenceArea> areas = sun.areas;
    areas.insert(areas.end(), lamp.areas.begin(), lamp.areas.end());
    areas.insert(areas.end(), camera.areas.begin(), camera.areas.end());
    const Accelerator accelerator = make_accelerator(scene_.mesh, areas);
    const Accelerator global = accelerator.with_local_trees({});
    const size_t count = any.set.rays.size();
    const auto measure = [&](const std::string& name, std::vector<const StructuredRays*> sets) {
      measure_sizes({mix(name, sets, count), accelerator, global});
    };
    measure("mixed_any", {&sun, &lamp, &any});
    measure("mixed_closest", {&first, &camera, &closest});
    measure("mixed_any_of_sun", {&sun});
    measure("mixed_any_of_lamp", {&lamp});
    measure("mixed_closest_of_sun", {&first});
    measure("mixed_closest_of_camera", {&camera});
    measure("mixed_any_foreign", {&any});
    measure("mixed_closest_foreign", {&closest});
  }

  void measure_sizes(const Sized& sized) {
    for (const unsigned threads : settings_.threads)
      for (const size_t size : settings_.sizes) measure(sized, size, threads);
  }

  /// Through the global tree, in arrays, and where they are there: one a call, in batches.
  static std::vector<Contestant> contestants(const Sized& sized, const StructuredRays& rays, size_t size,
                                             unsigned threads) {
    const size_t count = rays.set.rays.size();
    const auto in_calls = [&](size_t of, const auto& call) {
      return Contestant{[=](Answers& a) {
                          for (size_t i = 0; i < count; i += of) call(i, std::min(of, count - i), a);
                        },
                        std::make_unique<Answers>(count)};
    };
    std::vector<Contestant> all;
    all.push_back(in_calls(
        size, [&, threads](size_t i, size_t n, Answers& a) { call_array(sized.global, rays, i, n, a, threads); }));
    all.push_back(in_calls(
        size, [&, threads](size_t i, size_t n, Answers& a) { call_array(sized.accelerator, rays, i, n, a, threads); }));
    if (count <= kMostDistinctRays)  // more take memory and time, and are no other rays
      all.push_back(in_calls(
          count, [&, threads](size_t, size_t, Answers& a) { trace_singly(sized.accelerator, rays, a, threads); }));
    if (!rays.points.empty())
      all.push_back(in_calls(size, [&, threads](size_t i, size_t n, Answers& a) {
        call_batch(sized.accelerator, rays, i, n, a, threads);
      }));
    return all;
  }

  void measure(const Sized& sized, size_t size, unsigned threads) {
    StructuredRays rays = sized.rays;
    repeat(rays.set.rays, std::max(size, kLeastRays));
    repeat(rays.points, rays.points.empty() ? 0 : rays.set.rays.size());
    const size_t count = rays.set.rays.size();
    std::vector<Contestant> all = contestants(sized, rays, size, threads);
    race_whole(all, size > kMostDistinctRays ? 1 : kRounds, threads);
    for (const Contestant& c : all)
      if (c.answers->flags != all[0].answers->flags || c.answers->hits != all[0].answers->hits)
        throw std::logic_error("raygrain's interfaces disagree about rays of " + rays.set.name);

    const auto nanoseconds = [&](size_t i) { return all[i].seconds * 1e9 / static_cast<double>(count); };
    SizeRow row{scene_.name, scene_.mesh.triangle_count(), rays.set.name, size, threads};
    row.global = nanoseconds(0);
    row.array = nanoseconds(1);
    if (count <= kMostDistinctRays) row.single = nanoseconds(2);
    if (!rays.points.empty()) row.batch = nanoseconds(all.size() - 1);
    report(row, results_);
  }

  const BenchScene& scene_;
  const Settings& settings_;
  Results& results_;
  std::vector<StructuredRays> sets_;
};

}  // namespace

void run_sizes(const Settings& settings, Results& results) {
  for (const std::string& source : scene_sources(settings)) {
    const BenchScene scene = load_bench_scene(source);
    SizesSuite(scene, settings, results).run();
  }
}

}  // namespace raygrain::bench

// One accelerator, many threads: every kind of call at once, on threads that know nothing of each other. What
// ThreadSanitizer is asked about (make tsan-test).
#include <algorithm>
#include <atomic>
#include <thread>

#include <gtest/gtest.h>

#include "raygrain/accelerator.h"
#include "raygrain/error.h"
#include "raygrain/families.h"
#include "raygrain/rays.h"

#include "base/random.h"
#include "support/mesh_families.h"
#include "support/same_bits.h"
#include "verify/compare.h"
#include "verify/oracle.h"

namespace raygrain::test {
namespace {

using verification::Oracle;

constexpr Vec3 kLight{0.3f, -0.9f, 0.2f};
constexpr unsigned kThreads = 6;

TriangleMesh scene_mesh() {
  return closed_mesh_families(4)[10].mesh;
}

std::vector<InfluenceArea> scene_areas(const TriangleMesh& mesh) {
  const Bounds box = mesh_bounds(mesh);
  std::vector<InfluenceArea> areas = areas_around(mesh, 3);
  areas.push_back(directional_light_area("sun", kLight, box));
  for (const InfluenceArea& area : point_light_areas("lamp", box.hi, box)) areas.push_back(area);
  return areas;
}

/// The rays of the test with their right answers.
struct Questions {
  TriangleMesh mesh = scene_mesh();
  Vec3 lamp = mesh_bounds(mesh).hi;
  std::vector<Ray> mixed, sun, to_lamp, from_lamp;
  std::vector<Vec3> points, directions;
  std::vector<Hit> mixed_hits, sun_hits, to_lamp_hits, from_lamp_hits;

  explicit Questions(size_t count) {
    mixed = aimed_rays(mesh, count, 1);
    points = points_near(mesh, {}, count, 2);
    for (const Vec3 p : points) {
      directions.push_back(p - lamp);
      sun.push_back({p, -kLight, 0, kInf});
      to_lamp.push_back({p, lamp - p, 0, 1});
      from_lamp.push_back({lamp, p - lamp, 0, kInf});
    }
    const Oracle oracle(mesh);
    const auto answer = [&](const std::vector<Ray>& rays, std::vector<Hit>& hits) {
      for (const Ray& ray : rays) hits.push_back(oracle.nearest(ray));
    };
    answer(mixed, mixed_hits), answer(sun, sun_hits), answer(to_lamp, to_lamp_hits), answer(from_lamp, from_lamp_hits);
  }
};

size_t wrong_hits(const std::vector<Hit>& found, const std::vector<Hit>& expected) {
  size_t wrong = 0;
  for (size_t i = 0; i < found.size(); ++i) wrong += !same_bits(found[i], expected[i]);
  return wrong;
}
size_t wrong_flags(const std::vector<uint8_t>& found, const std::vector<Hit>& expected) {
  size_t wrong = 0;
  for (size_t i = 0; i < found.size(); ++i) wrong += (found[i] != 0) != is_hit(expected[i]);
  return wrong;
}

/// One call of one kind; how many answers were wrong.
size_t ask(const Accelerator& scene, const Questions& q, uint64_t kind, unsigned threads) {
  const size_t count = q.mixed.size();
  std::vector<Hit> hits(count);
  std::vector<uint8_t> flags(count);
  AcceleratorCounters counters;
  switch (kind) {
    case 0:
      for (size_t i = 0; i < count; ++i) hits[i] = scene.intersect(q.mixed[i], i % 2 ? &counters : nullptr);
      return wrong_hits(hits, q.mixed_hits);
    case 1:
      for (size_t i = 0; i < count; ++i) flags[i] = scene.occluded(q.mixed[i]);
      return wrong_flags(flags, q.mixed_hits);
    case 2:
      scene.intersect(q.mixed, hits, threads, &counters);
      return wrong_hits(hits, q.mixed_hits) + (counters.rays != count);
    case 3:
      scene.occluded(q.mixed, flags, threads);
      return wrong_flags(flags, q.mixed_hits);
    case 4:
      scene.occluded(q.points, -kLight, flags, threads, &counters);
      return wrong_flags(flags, q.sun_hits) + (counters.rays != count);
    case 5:
      scene.intersect(q.points, -kLight, hits, threads);
      return wrong_hits(hits, q.sun_hits);
    case 6:
      scene.occluded_towards(q.points, q.lamp, flags, threads);
      return wrong_flags(flags, q.to_lamp_hits);
    case 7:
      scene.intersect_from(q.lamp, q.directions, hits, threads, &counters);
      return wrong_hits(hits, q.from_lamp_hits) + (counters.rays != count);
    default:
      return scene.explain(counters, 16).areas.size() != scene.local_trees().size();
  }
}

/// work(thread) on several threads at once, all started before any is done.
template <class Work>
void on_threads(const Work& work) {
  std::atomic<unsigned> ready = 0;
  std::vector<std::jthread> threads;
  for (unsigned t = 0; t < kThreads; ++t)
    threads.emplace_back([&, t] {
      ++ready;
      while (ready < kThreads) std::this_thread::yield();
      work(t);
    });
}

TEST(Concurrency, OneAcceleratorAnswersManyThreadsAtOnce) {
  const Questions questions(seed_count(4) == 1 ? 100 : 400);
  for (const LocalSpace space : {LocalSpace::kWorld, LocalSpace::kRay})
    for (const Traversal traversal : {Traversal::kWide, Traversal::kBinary}) {
      AcceleratorOptions options;
      options.space = space;
      options.traversal = traversal;
      const Accelerator scene(questions.mesh, scene_areas(questions.mesh), options);
      std::atomic<size_t> wrong = 0;
      on_threads([&](unsigned thread) {
        const Accelerator copy = thread % 2 ? scene : Accelerator(scene);
        Random random(thread);
        for (uint64_t round = 0; round < 12; ++round)
          wrong += ask(thread % 3 ? copy : scene, questions, (round + thread) % 9,
                       static_cast<unsigned>(1 + random.below(2)));
      });
      EXPECT_EQ(wrong, 0u);
    }
}

// The last copy of an accelerator may go while others are still asked; its parts are shared.
TEST(Concurrency, CopiesComeAndGo) {
  const Questions questions(60);
  auto original = std::make_unique<Accelerator>(questions.mesh, scene_areas(questions.mesh));
  std::vector<Accelerator> copies(kThreads, *original);
  original.reset();
  std::atomic<size_t> wrong = 0;
  on_threads([&](unsigned thread) {
    Accelerator mine = std::move(copies[thread]);
    for (int round = 0; round < 5; ++round) {
      const Accelerator other = mine.with_local_trees({});
      wrong += ask(other, questions, 2, 1) + ask(mine, questions, 0, 1);
      mine = Accelerator(mine);
    }
  });
  EXPECT_EQ(wrong, 0u);
}

// Several builds at once share nothing but constants.
TEST(Concurrency, BuildsMayRunAtTheSameTime) {
  const Questions questions(60);
  const std::vector<InfluenceArea> areas = scene_areas(questions.mesh);
  std::atomic<size_t> wrong = 0;
  on_threads([&](unsigned thread) {
    AcceleratorOptions options;
    options.quality = thread % 2 ? Quality::kBest : Quality::kFast;
    options.reinsert = thread % 3 == 0;
    options.threads = 1 + thread % 2;
    wrong += ask(Accelerator(questions.mesh, areas, options), questions, 2, 1);
  });
  EXPECT_EQ(wrong, 0u);
}

TEST(Concurrency, BuildsOfAcceleratorsAreCancelledAtAnyMoment) {
  const TriangleMesh mesh = scene_mesh();
  const std::vector<InfluenceArea> areas = scene_areas(mesh);
  AcceleratorOptions options;
  options.space = LocalSpace::kRay;
  options.reinsert = true;
  size_t calls = 0;
  options.progress = [&calls](double) { return ++calls > 0; };
  Accelerator(mesh, areas, options);
  Random random(calls);
  for (uint64_t round = 0; round < seed_count(12); ++round) {
    options.threads = static_cast<unsigned>(1 + random.below(3));
    const size_t stop = 1 + random.below(calls / 2);
    std::atomic<size_t> told = 0;
    options.progress = [&told, stop](double) { return ++told < stop; };
    try {
      Accelerator(mesh, areas, options);
      ADD_FAILURE() << "not cancelled at " << stop << " of " << calls;
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kCancelled);
    }
    EXPECT_EQ(told, stop) << "called again after it said no";
  }
}

struct Mine : std::runtime_error {
  Mine() : std::runtime_error("mine") {}
};

TEST(Concurrency, WhatUserFunctionsThrowComesOutOfAccelerators) {
  const TriangleMesh mesh = scene_mesh();
  const std::vector<InfluenceArea> areas = scene_areas(mesh);
  for (const unsigned threads : {1u, 3u}) {
    AcceleratorOptions options;
    options.threads = threads;
    options.membership = [](const AreaGeometry&, Vec3, Vec3, Vec3) -> bool { throw Mine(); };
    EXPECT_THROW(Accelerator(mesh, areas, options), Mine);
    options.membership = nullptr;
    options.samples = [](const InfluenceArea*) -> std::vector<Ray> { throw Mine(); };
    EXPECT_THROW(Accelerator(mesh, areas, options), Mine);
    options.samples = nullptr;
    options.progress = [](double) -> bool { throw Mine(); };
    EXPECT_THROW(Accelerator(mesh, areas, options), Mine);
    options.progress = nullptr;
    const auto with_measure = [&](const char* name, RayMeasure measure) {
      options.registry.measures.push_back(
          {name, "", false, false, [measure](const HeuristicInput&) { return measure; }});
      options.local.measure = name;
    };
    with_measure("THROWS", [](const Bounds&) -> float { throw Mine(); });
    EXPECT_THROW(Accelerator(mesh, areas, options), Mine);
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), -1.0f, kInf}) {
      const std::string name = "BAD" + std::to_string(bad);
      with_measure(name.c_str(), [bad](const Bounds&) { return bad; });
      try {
        Accelerator(mesh, areas, options);
        ADD_FAILURE() << bad;
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ErrorCode::kBadHeuristic);
        EXPECT_EQ(error.where.find("node at level "), 0u) << error.where;
      }
    }
  }
}

// Trees under a measure without sense answer as all others do.
TEST(Concurrency, MeasuresWithoutSenseLeaveAnswersExact) {
  for (const char* name : {"wide tree=RANDOM+ALL@binned seed=5", "wide tree=RANDOM+ROBIN@spatial seed=6 leaf=1",
                           "binary tree=RANDOM+LSPH@paper seed=7", "accelerator tree=RANDOM+ALL@sweep seed=8",
                           "accelerator local=RANDOM+ALL@subset ray_space=1 seed=9 batch=16"}) {
    SCOPED_TRACE(name);
    Scene scene{name, scene_mesh(), scene_areas(scene_mesh()), {{"rays", aimed_rays(scene_mesh(), 500, 3)}}};
    const VerifyResult result = verify_scene(scene, std::vector{parse_structure(name)});
    EXPECT_TRUE(result.tally.is_good()) << to_text(result.tally);
    EXPECT_GE(result.tally.comparisons, 1000u);
  }
}

}  // namespace
}  // namespace raygrain::test

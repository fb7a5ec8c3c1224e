// Functions of users that misbehave, in every builder and on several threads: what they throw comes through untouched,
// what they return is refused with the node or used as it is, and nothing is ever undefined.
#include <array>
#include <atomic>
#include <bit>
#include <limits>
#include <stdexcept>

#include "raygrain/error.h"
#include "raygrain/refine.h"
#include "raygrain/registry.h"

#include "build/build_support.h"
#include "support/mesh_families.h"

namespace raygrain::test {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Mine : std::runtime_error {
  Mine() : std::runtime_error("mine") {}
};

/// More than one thread works on so many, and build_subset has a subset.
const Prims& prims() {
  static const Prims all = random_prims(12000, 3);
  return all;
}

struct Setting {
  BuilderEntry builder;
  unsigned threads;
};

std::vector<Setting> settings() {
  std::vector<Setting> all;
  for (const BuilderEntry& builder : default_registry().builders)
    for (const unsigned threads : {1u, 4u}) all.push_back({builder, threads});
  return all;
}

Bvh build(const Setting& setting, BuildOptions options, const Prims& of = prims()) {
  options.threads = setting.threads;
  if (!options.clip) options.clip = [&of](uint32_t i, const Bounds& box) { return intersected(of.bounds[i], box); };
  return setting.builder.build(of.bounds, of.centroids, options, nullptr);
}

/// The library's error, or nothing.
std::optional<Error> error_of(const Setting& setting, const BuildOptions& options) {
  try {
    build(setting, options);
  } catch (const Error& error) {
    return error;
  }
  return {};
}

template <class Body>
void for_settings(const Body& body) {
  for (const Setting& setting : settings()) {
    SCOPED_TRACE(setting.builder.name + ", " + std::to_string(setting.threads) + " threads");
    body(setting);
  }
}

/// Throws for small boxes: deep in the tree, in the middle of the work of all threads.
void throw_if_small(const Bounds& box) {
  if (length(extent(box)) < 2) throw Mine();
}

TEST(UserFunctions, ExceptionsOfMeasuresAndOrientationsComeThrough) {
  for_settings([](const Setting& setting) {
    BuildOptions options;
    options.strategy.measure = [](const Bounds& box) {
      throw_if_small(box);
      return length(extent(box));
    };
    EXPECT_THROW(build(setting, options), Mine);
    options = {};
    options.strategy.orientation = [](const NodeContext& node) {
      throw_if_small(node.bounds);
      return AxisOrder{{AxisChoice{0, 1}, {1, 1}, {2, 1}}, 3};
    };
    EXPECT_THROW(build(setting, options), Mine);
    options = {};
    options.progress = [](double) -> bool { throw Mine(); };
    EXPECT_THROW(build(setting, options), Mine);
  });
}

TEST(UserFunctions, ExceptionsOfTheOthersComeThrough) {
  const std::array<void (*)(BuildStrategy&), 4> kThrowers{
      [](BuildStrategy& s) { s.cost = [](float, uint32_t) -> float { throw Mine(); }; },
      [](BuildStrategy& s) { s.stop = [](const StopState&, const PaperParameters&) -> bool { throw Mine(); }; },
      [](BuildStrategy& s) {
        s.planes = [](const NodeContext&, const Bounds&, int, uint32_t, std::vector<float>&) { throw Mine(); };
      },
      [](BuildStrategy& s) { s.partition = [](const Bounds&, Vec3, int) -> float { throw Mine(); }; }};
  for_settings([&](const Setting& setting) {
    if (setting.builder.name == "spatial") return;  // refuses replaced functions
    for (size_t i = 0; i < kThrowers.size(); ++i) {
      if (setting.builder.name == "sweep" && i == 2) continue;  // has no planes
      BuildOptions options;
      kThrowers[i](options.strategy);
      EXPECT_THROW(build(setting, options), Mine) << i;
    }
    if (setting.builder.name != "paper") return;
    BuildOptions options;
    options.strategy.decision = [](const SplitState&, const PaperParameters&) -> SplitVerdict { throw Mine(); };
    EXPECT_THROW(build(setting, options), Mine);
    options = {};
    options.strategy.preference = [](const PlanePrice&, const PlanePrice&) -> bool { throw Mine(); };
    EXPECT_THROW(build(setting, options), Mine);
    options = {};
    options.strategy.hand_down = [](const SplitOutcome&) -> std::pair<float, float> { throw Mine(); };
    EXPECT_THROW(build(setting, options), Mine);
  });
}

TEST(UserFunctions, ExceptionsOfClipComeThrough) {
  for (const unsigned threads : {1u, 4u}) {
    BuildOptions options;
    options.spatial.overlap = 0;
    options.clip = [](uint32_t, const Bounds&) -> Bounds { throw Mine(); };
    EXPECT_THROW(build({default_registry().builders[3], threads}, options), Mine);
  }
}

// From the root on, and deep in the tree.
TEST(UserFunctions, BadMeasuresAreReportedWithTheNode) {
  for_settings([](const Setting& setting) {
    for (const float bad : {kNan, -1.0f, kInf, -kInf})
      for (const float from : {1000.0f, 2.0f}) {
        BuildOptions options;
        options.strategy.measure = [bad, from](const Bounds& box) {
          const float size = length(extent(box));
          return size < from ? bad : size;
        };
        const std::optional<Error> error = error_of(setting, options);
        ASSERT_TRUE(error.has_value()) << bad << " below " << from;
        EXPECT_EQ(error->code, ErrorCode::kBadHeuristic) << error->what();
        EXPECT_EQ(error->where.find("node at level "), 0u) << error->where;
        EXPECT_NE(error->where.find("primitive"), std::string::npos) << error->where;
      }
  });
}

/// Any numbers, as long as they are finite and not negative.
float scattered(const Bounds& box, uint64_t seed) {
  uint64_t bits = seed;
  for (const Vec3 p : {box.lo, box.hi})
    for (int k = 0; k < 3; ++k) bits = Random(bits ^ std::bit_cast<uint32_t>(p[k])).next();
  return static_cast<float>(Random(bits).uniform());
}

// A tree under a measure without sense is a bad one (often a chain: so few primitives), and sound.
TEST(UserFunctions, MeasuresThatAreNotMonotoneGiveSoundTrees) {
  const Prims few = random_prims(2000, 4);
  for_settings([&few](const Setting& setting) {
    const RayMeasure measures[] = {
        [](const Bounds& box) { return scattered(box, 1); },
        [](const Bounds& box) { return 1 / (length(extent(box)) + 1e-3f); },
        [](const Bounds&) { return 0.0f; },
        [](const Bounds&) { return std::numeric_limits<float>::max(); },
        [](const Bounds&) { return std::numeric_limits<float>::denorm_min(); },
        [](const Bounds& box) { return scattered(box, 2) < 0.5f ? 0.0f : std::numeric_limits<float>::max(); },
        RayMeasure([](const Bounds& box) { return scattered(box, 3); }, 0.0f)};
    for (const RayMeasure& measure : measures) {
      BuildOptions options;
      options.strategy.measure = measure;
      Bvh tree = build(setting, options, few);
      ASSERT_EQ(find_defect(tree, few.bounds), std::nullopt);
      reinsert(tree, measure, {.iterations = 1, .share = 0.02f, .threads = setting.threads});
      ASSERT_EQ(find_defect(tree, few.bounds), std::nullopt);
    }
  });
}

// The same box gets another number each time: not even a function.
TEST(UserFunctions, MeasuresThatChangeTheirMindGiveSoundTrees) {
  for_settings([](const Setting& setting) {
    std::atomic<uint64_t> calls = 0;
    BuildOptions options;
    options.strategy.measure = [&calls](const Bounds&) { return static_cast<float>(Random(calls++).uniform()); };
    ASSERT_EQ(find_defect(build(setting, options), prims().bounds), std::nullopt);
  });
}

TEST(UserFunctions, OrientationsMayRepeatAxesAndChangeTheirMind) {
  for_settings([](const Setting& setting) {
    std::atomic<uint64_t> calls = 0;
    BuildOptions options;
    options.strategy.orientation = [&calls](const NodeContext&) {
      Random random(calls++);
      AxisOrder order{{}, static_cast<int>(1 + random.below(3))};
      for (AxisChoice& choice : order.choices)
        choice = {static_cast<int>(random.below(3)), static_cast<float>(random.uniform(-5, 5))};
      return order;
    };
    ASSERT_EQ(find_defect(build(setting, options), prims().bounds), std::nullopt);
  });
}

// What a clip function returns is cut to the box that was asked about; nonsense must not spoil memory or end the
// program.
TEST(UserFunctions, ClipMayReturnNonsense) {
  const Bounds answers[] = {{},
                            {{kNan, 0, 0}, {1, 1, 1}},
                            {{-1e30f, -1e30f, -1e30f}, {1e30f, 1e30f, 1e30f}},
                            {{-kInf, -kInf, -kInf}, {kInf, kInf, kInf}},
                            {{5, 5, 5}, {4, 4, 4}}};
  for (const Bounds& answer : answers)
    for (const unsigned threads : {1u, 4u}) {
      BuildOptions options;
      options.spatial.overlap = 0;
      options.clip = [&answer](uint32_t, const Bounds&) { return answer; };
      try {
        const Bvh tree = build({default_registry().builders[3], threads}, options);
        EXPECT_GE(tree.prims.size(), 1u);
        for (const uint32_t prim : tree.prims) ASSERT_LT(prim, prims().bounds.size());
      } catch (const Error& error) {
        EXPECT_EQ(error.code, ErrorCode::kBadHeuristic) << error.what();
      }
    }
}

}  // namespace
}  // namespace raygrain::test

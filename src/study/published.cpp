// The 256 tests with the rules of the program that made the published numbers of "Ray Distribution Aware Heuristics for
// Bounding Volume Hierarchies Construction in Ray Tracing" (2024). Everything in which that program differs from the
// paper's text, or from what is right, stands in this file and uses public injection points only: it is also the proof
// that they reach far enough. The study `paper` runs the same tests as they should be. Beside public headers it
// includes the one that declares its only function.
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "raygrain/accelerator.h"
#include "raygrain/build.h"
#include "raygrain/error.h"
#include "raygrain/heuristics.h"
#include "raygrain/rays.h"
#include "raygrain/study.h"
#include "raygrain/top_level.h"

#include "study/presets.h"

namespace raygrain::study {
namespace {

constexpr float kTolerance = 0.01f;  // of everything in that program
constexpr uint32_t kOctreeLevel = 5;
/// A combination as published. The point tests that were printed as PAH+LSPH had been made with another recipe; both
/// are run.
struct Combo {
  const char* name;
  bool pah, spfh;
  float threshold;      // of a split plane's quality; the paper lists 0.4 only
  bool second_section;  // second of the two sections of its run: decides the rays
  bool mislabelled;
};
constexpr std::array<Combo, 5> kCombos{{{"PAH+SPFH", true, true, 0.4f, false, false},
                                        {"PAH+LSPH", true, false, 0.99f, false, false},
                                        {"SAH+SPFH", false, true, 0.4f, true, false},
                                        {"SAH+LSPH", false, false, 0.99f, true, false},
                                        {"PAH+LSPH-as-published", false, true, 0.99f, false, true}}};
constexpr Combo kGlobal{"", false, false, 0.4f, false, false};

const Combo& combo_of(const StudyRecipe& recipe) {
  for (const Combo& combo : kCombos)
    if (combo.name == recipe.combo) return combo;
  throw Error(ErrorCode::kUsage, recipe.combo, "is none of the published runs' recipes", "Add it to the grid of paper");
}

// --- Rays: the engine that made the random scenes went on to draw the rays, test by test. ---

constexpr uint64_t kSceneDraws = uint64_t{100 + 1000} * 9 * 2;  // two random scenes, nine doubles a triangle
constexpr uint64_t kPlaneDraws = 6, kPointDraws = 4;            // a ray: depth (unused), x, y; or yaw, pitch
constexpr uint64_t kTestsPerSection = 28;                       // Sponza had runs of its own

double draw(std::mt19937& engine, double half) {
  const double low = static_cast<double>(engine()), high = static_cast<double>(engine());
  return ((low + high * 0x1p32) * 0x1p-64 * 2 - 1) * half;
}

/// Where the rays of a test begin in the order of its run.
uint64_t draws_before(const StudyArea& area, const std::string& scene, bool second_section, size_t rays) {
  constexpr std::array kScenes{"Wood", "Suzanne", "Cottage", "CottageWalls", "Crowd", "Random100", "Random1000"};
  constexpr std::array kVariants{"parallel", "15deg", "45deg", "oblique"};
  const auto scene_index = std::find(kScenes.begin(), kScenes.end(), scene) - kScenes.begin();
  const auto variant = std::find(kVariants.begin(), kVariants.end(), area.variant) - kVariants.begin();
  const bool alone = scene == "Sponza";
  const uint64_t test = (alone ? 0 : static_cast<uint64_t>(scene_index) * 4) + static_cast<uint64_t>(variant) +
                        (second_section ? (alone ? 4 : kTestsPerSection) : 0);
  const bool is_plane = std::holds_alternative<PlaneArea>(area.area.shape);
  return kSceneDraws + test * rays * (is_plane ? kPlaneDraws : kPointDraws);
}

/// Not uniform on the near plane: uniform in yaw and pitch, so that up to a fifth leave the frustum.
Ray draw_ray(std::mt19937& engine, const PointArea& area, const Frame& frame) {
  constexpr double kRadians = 3.14159265358979323846 / 180;
  const double yaw = draw(engine, static_cast<double>(area.fov_x) / 2 * kRadians);
  const Vec3d direction = angular_direction(yaw, draw(engine, static_cast<double>(area.fov_y) / 2 * kRadians));
  const Vec3d origin = direction * (static_cast<double>(area.near_z) / direction.z);
  return {to_float(to_world(frame, origin)), to_float(to_world_direction(frame, direction))};
}

Ray draw_ray(std::mt19937& engine, const PlaneArea& area, const Frame& frame) {
  engine.discard(2);
  const double x = draw(engine, static_cast<double>(area.half_width));
  return {to_float(to_world(frame, {x, draw(engine, static_cast<double>(area.half_height)), 0})),
          to_float(frame.forward)};
}

std::vector<Ray> draw_rays(const StudyScene& scene, const StudyArea& area, const StudyRecipe& recipe,
                           const StudyRays& rays, uint64_t seed) {
  const AreaGeometry geometry(area.area);
  std::mt19937 engine(static_cast<uint32_t>(seed));
  engine.discard(draws_before(area, scene.name, combo_of(recipe).second_section, rays.count));
  std::vector<Ray> drawn;
  for (size_t i = 0; i < rays.count; ++i)
    drawn.push_back(
        std::visit([&](const auto& shape) { return draw_ray(engine, shape, geometry.frame()); }, area.area.shape));
  return drawn;
}

// --- Membership: by cells of the octree, with tolerance; by vertices alone. ---

class Octree {
 public:
  explicit Octree(const ConvexRegion& region) : cells_(std::array{region}, {TopLevelKind::kOctree, kOctreeLevel}) {}

  /// Is the point in a cell that lists the area, or within the tolerance of one?
  bool lists(Vec3 point) const {
    if (!cells_.regions_at(point).empty()) return true;
    for (int corner = 0; corner < 8; ++corner)
      if (!cells_.regions_at(moved(point, corner)).empty()) return true;
    return false;
  }

 private:
  /// The point moved towards a corner by the tolerance; onto the root's border where it lies that near outside.
  Vec3 moved(Vec3 point, int corner) const {
    const Bounds& root = cells_.nodes().front().bounds;
    for (int axis = 0; axis < 3; ++axis) {
      const float p = point[axis];
      point[axis] = (corner >> axis & 1) ? p + kTolerance : p - kTolerance;
      if (p < root.lo[axis] && p >= root.lo[axis] - kTolerance) point[axis] = root.lo[axis];
      if (p > root.hi[axis] && p <= root.hi[axis] + kTolerance) point[axis] = root.hi[axis];
    }
    return point;
  }

  TopLevel cells_;
};

// --- The builder. ---

float half_area(const Bounds& box) {
  const Vec3 e = extent(box);
  return e.x * e.y + e.y * e.z + e.z * e.x;
}

/// As probabilities, since those of the two measures meet in one ratio.
RayMeasure surface_probability(const Bounds& root) {
  return RayMeasure([whole = half_area(root)](const Bounds& box) { return std::min(half_area(box) / whole, 1.0f); },
                    1.0f);
}
RayMeasure projected_probability(const InfluenceArea& area) {
  const AreaGeometry geometry(area);
  return RayMeasure(
      [geometry](const Bounds& box) {
        return static_cast<float>(geometry.projected_area(box, Culling::kWindow) / geometry.window_area());
      },
      1.0f);
}

/// The main direction of rays at a node varies for points: from the eye to its middle, in its box or not.
SplitOrientation published_facing(const InfluenceArea& area) {
  return [area](const NodeContext& node) {
    const auto* plane = std::get_if<PlaneArea>(&area.shape);
    const Vec3 v = plane != nullptr ? to_float(normalized(to_double(plane->direction)))
                                    : center(node.bounds) - std::get<PointArea>(area.shape).eye;
    const float sum = std::abs(v.x) + std::abs(v.y) + std::abs(v.z);
    const auto quality = [sum](float part) {
      const float rest = 1 - std::abs(part) / sum;
      return rest * rest;
    };
    return sorted_axes({quality(v.x), quality(v.y), quality(v.z)});
  };
}

/// 38 planes, not 39.
void published_planes(const NodeContext& node, const Bounds&, int axis, uint32_t bins, std::vector<float>& planes) {
  const float lo = node.bounds.lo[axis], length = node.bounds.hi[axis] - lo;
  for (uint32_t i = 1; i + 1 < bins; ++i)
    planes.push_back(lo + length * static_cast<float>(i) / static_cast<float>(bins));
}

/// Figure 9, but the root stops after its first axis that splits, since its father's probability was infinite, and the
/// fallback's split always wins. No probability at all (0 / 0) passes for satisfactory.
SplitVerdict published_decision(const SplitState& state, const PaperParameters& parameters) {
  if (state.tried == 0) return SplitVerdict::kTry;
  if (state.node.level == 0 && state.has_split) return SplitVerdict::kSatisfied;
  const bool is_unknown = state.has_split && !(state.node_measure > 0);
  if (!is_unknown && state.has_split && state.ratio <= parameters.excellent_ratio) return SplitVerdict::kSatisfied;
  if (state.next.quality >= parameters.split_plane_quality_threshold) return SplitVerdict::kTry;
  if (is_unknown || (state.has_split && state.ratio <= parameters.acceptable_ratio)) return SplitVerdict::kSatisfied;
  return SplitVerdict::kFallBackReplacing;
}

/// The longest axis, or the second longest if the longest was tried last; no other.
SplitVerdict published_fallback_decision(const SplitState& state, const PaperParameters&) {
  if (state.tried > 0) return SplitVerdict::kSatisfied;
  return state.next.axis == state.last_axis ? SplitVerdict::kSkip : SplitVerdict::kTry;
}

BuildOptions published_options(const Combo& combo, const InfluenceArea* area, const Bounds& root) {
  const RayMeasure surface = surface_probability(root);
  BuildStrategy fallback;
  fallback.measure = surface;
  fallback.orientation = longest_axis_orientation();
  fallback.planes = published_planes;
  fallback.preference = [](const PlanePrice& a, const PlanePrice& best) { return a.cost < best.cost; };  // or the first
  fallback.decision = published_fallback_decision;

  BuildOptions options;
  options.strategy = fallback;
  if (combo.pah) options.strategy.measure = projected_probability(*area);
  if (combo.spfh) options.strategy.orientation = published_facing(*area);
  options.strategy.decision = published_decision;
  // After a fallback children were judged against probabilities of the fallback's measure; where it had found no split
  // and an older one stayed, against infinite ones.
  options.strategy.hand_down = [surface](const SplitOutcome& split) -> std::pair<float, float> {
    constexpr float kInfinite = std::numeric_limits<float>::max();
    if (!split.forced) return {split.left_measure, split.right_measure};
    if (!split.fallback) return {kInfinite, kInfinite};
    return {surface(split.left), surface(split.right)};
  };
  options.fallback = fallback;
  options.split_inseparable = false;
  options.parameters.split_plane_quality_threshold = combo.threshold;
  return options;
}

Bvh build_published(const TriangleMesh& mesh, std::span<const uint32_t> members, const BuildOptions& options,
                    BuildLog* log) {
  std::vector<Bounds> bounds;
  std::vector<Vec3> centroids;
  for (const uint32_t member : members) {
    bounds.push_back(triangle_bounds(mesh, member));
    centroids.push_back(triangle_centroid(mesh, member));
  }
  Bvh tree = build_paper(bounds, centroids, options, log);
  for (uint32_t& primitive : tree.prims) primitive = members[primitive];
  return tree;
}
Bounds box_of(const TriangleMesh& mesh, std::span<const uint32_t> members) {
  Bounds box;
  for (const uint32_t member : members) box.extend(triangle_bounds(mesh, member));
  return box;
}
Bvh build_published_global(const TriangleMesh& mesh) {
  std::vector<uint32_t> all(mesh.triangle_count());
  std::iota(all.begin(), all.end(), 0u);
  return build_published(mesh, all, published_options(kGlobal, nullptr, box_of(mesh, all)), nullptr);
}

LocalTree build_published_local(const TriangleMesh& mesh, const InfluenceArea& area, const StudyRecipe& recipe) {
  const AreaGeometry geometry(area);
  const Octree octree(geometry.region());
  const std::vector<uint32_t> members =
      area_members(mesh, geometry, [&octree](const AreaGeometry&, Vec3 a, Vec3 b, Vec3 c) {
        return octree.lists(a) || octree.lists(b) || octree.lists(c);
      });
  const BuildOptions options = published_options(combo_of(recipe), &area, box_of(mesh, members));
  LocalTree local;
  local.tree = std::make_shared<const Bvh>(build_published(mesh, members, options, &local.log));
  local.measure = options.strategy.measure;
  return local;
}

/// A slip of the published run.
InfluenceArea published_area(const StudyScene& scene, const StudyArea& area, const StudyRecipe& recipe) {
  InfluenceArea result = area.area;
  auto* plane = std::get_if<PlaneArea>(&result.shape);
  if (plane != nullptr && scene.name == "Suzanne" && area.variant == "oblique" && recipe.combo == "PAH+LSPH")
    plane->half_width = plane->half_height = 0.9f;
  return result;
}

StudyRules published_rules() {
  StudyRules rules;
  rules.area = published_area;
  rules.global_tree = build_published_global;
  rules.local_tree = build_published_local;
  rules.rays = draw_rays;
  rules.serves = [](const InfluenceArea& area) {
    const auto octree = std::make_shared<const Octree>(AreaGeometry(area).region());
    return [octree](const Ray& ray) { return octree->lists(ray.origin); };
  };
  rules.accepts = [](const InfluenceArea&, const Ray&, const Hit&) { return true; };  // any hit passed for the nearest
  return rules;
}

}  // namespace

StudyGrid published_grid(const StudySources& sources) {
  StudyGrid grid = preset_grid("paper", sources);
  grid.name = "published";
  grid.recipes.clear();
  for (const Combo& combo : kCombos) {
    grid.recipes.push_back({combo.name, "", {combo.pah ? "PAH" : "SAH", combo.spfh ? "SPFH" : "LSPH", "paper", {}}});
    grid.recipes.back().recipe.parameters.split_plane_quality_threshold = combo.threshold;
  }
  grid.rays = {{"published", PointSpread::kAngle, sources.rays}};
  grid.rules = published_rules();
  grid.leave_out = [](const StudyScene&, const StudyArea& area, const StudyRecipe& recipe, const StudyRays&) {
    return combo_of(recipe).mislabelled && std::holds_alternative<PlaneArea>(area.area.shape);
  };
  grid.source = "the rules of the published runs";
  return grid;
}

}  // namespace raygrain::study

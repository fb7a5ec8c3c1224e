#include "study/frame_row.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "raygrain/error.h"
#include "raygrain/frame_tree.h"
#include "raygrain/triangle.h"

#include "base/timer.h"
#include "build/estimate.h"

namespace raygrain::study {
namespace {

constexpr float kDepthTerm = 0.1f;  // as FrameBuildOptions::z_term

/// A tree over boxes of a frame, and what it predicts.
struct FrameLocal {
  RayFrame frame;
  LocalTree local;
  RayMeasure measure;
  double cost = kInf;
};

/// Area of the window's image in the frame: that of all rays.
float window_in(const RayFrame& frame, const AreaGeometry& geometry) {
  std::array<Vec3d, 3> q;
  for (size_t i = 0; i < 3; ++i) q[i] = to_frame(frame, geometry.region().corners[i]);
  const Vec3d u = q[1] - q[0], v = q[2] - q[0];
  return static_cast<float>(std::abs(u.x * v.y - u.y * v.x));
}

/// The xy area, and a little of the other faces: without it nothing splits along the rays.
RayMeasure frame_measure(const RayFrame& frame, const AreaGeometry& geometry, const Bounds& scene) {
  const Vec3 size = extent(scene);
  const float term = size.z > 0 ? kDepthTerm * std::sqrt(size.x * size.y) / size.z : 0;
  return face_weight_measure({term, term, 1}, window_in(frame, geometry));
}

const BuilderEntry& builder_of(const Recipe& recipe) {
  static const Registry registry = default_registry();
  for (const BuilderEntry& builder : registry.builders)
    if (builder.name == recipe.builder) return builder;
  throw Error(ErrorCode::kUsage, recipe.builder, "is no builder for ray space");
}

FrameLocal build_in(const RayFrame& frame, const SceneTrees& scene, const AreaGeometry& geometry, const Recipe& recipe,
                    const BuildOptions& given) {
  FrameLocal result{frame, {}, {}};
  std::vector<uint32_t> ids;
  std::vector<Bounds> bounds;
  std::vector<Vec3> centers;
  Bounds all;
  const auto box_of = [&](uint32_t i, const Bounds& within) {
    return frame_bounds(frame, scene.mesh.vertex(i, 0), scene.mesh.vertex(i, 1), scene.mesh.vertex(i, 2), within);
  };
  for (const uint32_t i : area_members(scene.mesh, geometry)) {
    const Bounds box = box_of(i, frame.domain);
    if (is_empty(box)) continue;
    ids.push_back(i);
    bounds.push_back(box);
    centers.push_back(center(box));
    all.extend(box.lo);
    all.extend(box.hi);
  }
  BuildOptions options = given;
  options.strategy.measure = result.measure = frame_measure(frame, geometry, is_empty(all) ? Bounds{{}, {}} : all);
  options.clip = [&](uint32_t i, const Bounds& box) { return box_of(ids[i], box); };
  Bvh tree = builder_of(recipe).build(bounds, centers, options, &result.local.log);
  for (uint32_t& primitive : tree.prims) primitive = ids[primitive];
  result.cost = estimated_cost(tree, result.measure, options.costs);
  result.local.tree = std::make_shared<const Bvh>(std::move(tree));
  result.local.area = geometry.area();
  return result;
}

/// One ray through the binary tree in its frame: boxes that meet the ray's column are met.
class ColumnSearch {
 public:
  ColumnSearch(const FrameLocal& tree, const TriangleMesh& mesh, const CostModel& costs)
      : tree_(tree), mesh_(mesh), costs_(costs) {}

  RaySearch operator()(const Ray& ray) const {
    RaySearch result;
    result.full = run(ray, false, result.hit);
    result.hit = {};
    result.pruned = run(ray, true, result.hit);
    return result;
  }

 private:
  bool set_column(const Ray& ray, FrameColumn& column) const {
    const Bounds& root = tree_.local.tree->nodes.front().bounds;
    FrameSegment segment;
    if (make_segment(tree_.frame, ray, {root.lo.z, root.hi.z}, segment) != FrameFit::kServed) return false;
    column = to_column(segment);
    return true;
  }

  static bool meets(const FrameColumn& column, const Bounds& box) { return !is_empty(intersected(column.box, box)); }

  double run(Ray ray, bool prunes, Hit& best) const {
    const std::vector<Bvh::Node>& nodes = tree_.local.tree->nodes;
    FrameColumn column;
    double cost = 0;
    if (nodes.empty() || !set_column(ray, column)) return cost;
    std::vector<uint32_t> open{0};
    while (!open.empty()) {
      const Bvh::Node& node = nodes[open.back()];
      open.pop_back();
      if (!meets(column, node.bounds)) continue;
      if (!node.is_leaf()) {
        cost += static_cast<double>(costs_.inner);
        push_children(node, column, open);
        continue;
      }
      cost += static_cast<double>(costs_.triangle) * node.count;
      if (!search_leaf(node, ray, best) || !prunes) continue;
      ray.tmax = std::min(ray.tmax, best.t);
      if (!set_column(ray, column)) break;
    }
    return cost;
  }

  /// The one that the ray enters first on top.
  void push_children(const Bvh::Node& node, const FrameColumn& column, std::vector<uint32_t>& open) const {
    const Bounds &left = tree_.local.tree->nodes[node.first].bounds,
                 &right = tree_.local.tree->nodes[node.first + 1].bounds;
    const bool right_first = column.ascending ? right.lo.z < left.lo.z : right.hi.z > left.hi.z;
    open.push_back(node.first + (right_first ? 0 : 1));
    open.push_back(node.first + (right_first ? 1 : 0));
  }

  bool search_leaf(const Bvh::Node& leaf, const Ray& ray, Hit& best) const {
    bool found = false;
    for (uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      const uint32_t id = tree_.local.tree->prims[i];
      Hit hit;
      if (!intersect_triangle(ray, mesh_.vertex(id, 0), mesh_.vertex(id, 1), mesh_.vertex(id, 2), hit)) continue;
      hit.triangle = id;
      if (!is_nearer(hit, best)) continue;
      best = hit;
      found = true;
    }
    return found;
  }

  const FrameLocal& tree_;
  const TriangleMesh& mesh_;
  CostModel costs_;
};

void set_frame_times(Cells& cells, const FrameLocal& best, const TreeTest& test, double build_seconds) {
  const auto corners = std::make_shared<const TriangleCorners>(test.scene.mesh);
  const FrameTree wide(best.frame, *best.local.tree, corners, {.measure = best.measure});
  const std::vector<Ray> served = served_rays(test);
  std::vector<Hit> hits(served.size());
  cells.set("single_ray_seconds", search_seconds(served, [&](std::span<const Ray> rays) {
              for (size_t i = 0; i < rays.size(); ++i) hits[i] = wide.intersect(rays[i]).value_or(Hit{});
            }));
  cells.set("global_ray_seconds",
            search_seconds(served, [&](std::span<const Ray> rays) { test.scene.wide_global.intersect(rays, hits); }));
  cells.set("build_seconds", build_seconds);  // of all frames
}

}  // namespace

void set_frame_cells(Cells& cells, const SceneTrees& scene, const AreaGeometry& geometry, const Recipe& recipe,
                     const BuildOptions& options, std::span<const Ray> rays) {
  const Timer timer;
  FrameLocal best;
  for (const FrameKind kind : frame_kinds(geometry)) {
    FrameLocal tree = build_in(*area_frame(kind, geometry), scene, geometry, recipe, options);
    if (tree.cost < best.cost || best.local.tree == nullptr) best = std::move(tree);
  }
  const double build_seconds = timer.seconds();
  if (best.local.tree == nullptr) throw Error(ErrorCode::kBadArea, geometry.area().name, "has no frame");
  TreeTest test = exact_test(scene, best.local, geometry, rays, options.costs);
  test.search = ColumnSearch(best, scene.mesh, options.costs);
  cells.set("frame", name(best.frame.kind));
  set_own_cells(cells, *best.local.tree, best.measure, options.costs);
  set_build_cells(cells, best.local);
  set_ray_cells(cells, test);
  set_frame_times(cells, best, test, build_seconds);
}

}  // namespace raygrain::study

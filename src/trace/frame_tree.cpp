#include "raygrain/frame_tree.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "raygrain/error.h"

#include "build/estimate.h"
#include "geometry/rounding.h"
#include "trace/frame_memory.h"
#include "trace/kernels/frame_kernels.h"

namespace raygrain {

struct FrameTree::Data {
  FrameMemory tree;
  Isa isa = Isa::kScalar;
  const FrameKernels* kernels = nullptr;
};

namespace {

/// Rays that leave their middle line by no more than this share of the tree's width are columns.
constexpr double kColumnDrift = 0x1p-14;
/// Rays that leave it by no more than this along the whole tree are cones.
constexpr double kConeDrift = 0.5;

constexpr double kLeastSlope = 0x1p-40;  // of the tree's width, over its depth

/// One coordinate of a cone: x = at + slope (z - z0), wrong by at most `error`.
struct ConeSide {
  float intercept, slope, inverse, near, far;
  double error;  // of intercept + slope z, evaluated in float
};

ConeSide cone_side(const FrameMemory& tree, const FrameSegment& s, double at, double slope, double error) {
  const double depth =
      std::max(std::abs(static_cast<double>(tree.depths[0])), std::abs(static_cast<double>(tree.depths[1])));
  const double whole = static_cast<double>(tree.depths[1]) - static_cast<double>(tree.depths[0]);
  const double steep = std::copysign(std::max(std::abs(slope), kLeastSlope * tree.width / whole), slope);
  ConeSide side{};
  side.inverse = static_cast<float>(1 / steep);
  const double inverse = side.inverse, used = 1 / inverse;
  error += (std::abs(used - slope) + s.slope_error) * whole;
  const double offset = s.z0 - at * inverse;
  const double slack = std::abs(inverse) * (error + 0x1p-22 * tree.width) + 0x1p-22 * depth;
  side.near = loosely_below(offset - slack);
  side.far = loosely_above(offset + slack);
  side.slope = static_cast<float>(used);
  side.intercept = static_cast<float>(at - used * s.z0);
  side.error = error + 0x1p-21 * (tree.reach + std::abs(used) * depth + std::abs(static_cast<double>(side.intercept)));
  return side;
}

void set_cone(const FrameMemory& tree, const FrameSegment& s, FrameQuery& query) {
  const ConeSide x = cone_side(tree, s, s.x0, s.slope_x, s.error), y = cone_side(tree, s, s.y0, s.slope_y, s.error);
  query.x0 = x.intercept;
  query.y0 = y.intercept;
  query.slope_x = x.slope;
  query.slope_y = y.slope;
  query.inverse_x = x.inverse;
  query.inverse_y = y.inverse;
  query.near_x = x.near;
  query.far_x = x.far;
  query.near_y = y.near;
  query.far_y = y.far;
  query.error = loosely_above(std::max(x.error, y.error));
}

const FrameKernels& kernels_of(Isa isa) {
  const FrameKernels* found = frame_kernels(isa);
  if (found == nullptr)
    throw Error(ErrorCode::kUsage, "WideOptions::isa", "this CPU does not offer '" + std::string(name(isa)) + "'");
  return *found;
}

bool can_hit(const FrameMemory& tree, const Ray& ray) {
  return !tree.is_empty() && is_valid(ray) && ray.tmin <= ray.tmax;
}

/// The part of the ray that matters.
Ray shortened(const Ray& ray, float from, float to) {
  return {ray.origin, ray.direction, std::max(ray.tmin, from), std::min(ray.tmax, to)};
}

}  // namespace

FrameUse prepare(const FrameMemory& tree, const Ray& ray, FrameQuery& query) {
  FrameSegment s;
  query.column.box = {};
  if (!(ray.tmin <= ray.tmax)) return FrameUse::kColumn;
  const FrameFit fit = make_segment(tree.frame, ray, tree.depths, s);
  if (fit == FrameFit::kUnfit) return FrameUse::kUnfit;
  if (fit == FrameFit::kNothing) return FrameUse::kColumn;
  query.tie_constant = loosely_above(s.tie_constant);
  query.tie_linear = loosely_above(s.tie_linear);
  query.tie_square = loosely_above(s.tie_square);
  query.column = to_column(s);
  if (drift(s) + s.error <= kColumnDrift * tree.width) {
    query.column.radius *= 1 + 0x1p-20f;
    return FrameUse::kColumn;
  }
  const double whole = static_cast<double>(tree.depths[1]) - static_cast<double>(tree.depths[0]);
  const double slope = std::max(std::abs(s.slope_x), std::abs(s.slope_y));
  if (!(slope * whole <= kConeDrift * tree.width && s.error <= kColumnDrift * tree.width)) return FrameUse::kUnfit;
  set_cone(tree, s, query);
  return FrameUse::kCone;
}

FrameTree::FrameTree() : data_(std::make_shared<const Data>()) {}

FrameTree::FrameTree(const RayFrame& frame, const Bvh& tree, std::shared_ptr<const TriangleMesh> mesh,
                     const WideOptions& options) {
  const Isa isa = options.isa ? *options.isa : default_isa();
  const FrameKernels& table = kernels_of(isa);
  if (mesh == nullptr) throw Error(ErrorCode::kUsage, "FrameTree", "has no mesh");
  data_ = std::make_shared<const Data>(Data{write_frame_tree(frame, tree, std::move(mesh), options), isa, &table});
}

FrameUse FrameTree::use_of(const Ray& ray) const {
  FrameQuery query;
  return can_hit(data_->tree, ray) ? prepare(data_->tree, ray, query) : FrameUse::kColumn;
}

std::optional<Hit> FrameTree::intersect(const Ray& ray, Hit known, const SearchOptions& options) const {
  const Data& data = *data_;
  if (!can_hit(data.tree, ray)) return known;
  FrameQuery query;
  const FrameUse use = prepare(data.tree, shortened(ray, options.skip_before, known.t), query);
  if (use == FrameUse::kUnfit) return {};
  if (is_empty(query.column.box)) return known;
  if (options.prune) return data.kernels->nearest(data.tree, query, use, ray, known);
  TraceCounters unwanted;
  return data.kernels->nearest_counted(data.tree, query, use, ray, known, false, unwanted);
}

std::optional<bool> FrameTree::occluded(const Ray& ray, const SearchOptions& options) const {
  const Data& data = *data_;
  if (!can_hit(data.tree, ray)) return false;
  FrameQuery query;
  const FrameUse use = prepare(data.tree, shortened(ray, options.skip_before, kInf), query);
  if (use == FrameUse::kUnfit) return {};
  if (is_empty(query.column.box)) return false;
  if (options.prune) return data.kernels->any(data.tree, query, use, ray);
  TraceCounters unwanted;
  return data.kernels->any_counted(data.tree, query, use, ray, false, unwanted);
}

std::optional<Hit> FrameTree::intersect_counted(const Ray& ray, TraceCounters& counters, Hit known,
                                                const SearchOptions& options) const {
  const Data& data = *data_;
  if (!can_hit(data.tree, ray)) return known;
  FrameQuery query;
  const FrameUse use = prepare(data.tree, shortened(ray, options.skip_before, options.prune ? known.t : kInf), query);
  if (use == FrameUse::kUnfit) return {};
  if (is_empty(query.column.box)) return known;
  return data.kernels->nearest_counted(data.tree, query, use, ray, known, options.prune, counters);
}

std::optional<bool> FrameTree::occluded_counted(const Ray& ray, TraceCounters& counters,
                                                const SearchOptions& options) const {
  const Data& data = *data_;
  if (!can_hit(data.tree, ray)) return false;
  FrameQuery query;
  const FrameUse use = prepare(data.tree, shortened(ray, options.skip_before, kInf), query);
  if (use == FrameUse::kUnfit) return {};
  if (is_empty(query.column.box)) return false;
  return data.kernels->any_counted(data.tree, query, use, ray, options.prune, counters);
}

const RayFrame& FrameTree::frame() const {
  return data_->tree.frame;
}
const Bounds& FrameTree::bounds() const {
  return data_->tree.bounds;
}
Isa FrameTree::isa() const {
  return data_->isa;
}
size_t FrameTree::node_count() const {
  return data_->tree.nodes;
}
size_t FrameTree::leaf_count() const {
  return data_->tree.leaves;
}
size_t FrameTree::memory_bytes() const {
  return data_->tree.memory.size();
}

}  // namespace raygrain

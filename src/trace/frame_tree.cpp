#include "raygrain/frame_tree.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "raygrain/error.h"

#include "base/sizes.h"
#include "trace/frame_memory.h"
#include "trace/kernels/frame_kernels.h"

namespace raygrain {

struct FrameTree::Data {
  FrameMemory tree;
  Isa isa = Isa::kScalar;
  const FrameKernels* kernels = nullptr;
};

namespace {

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

TriangleCorners::TriangleCorners(const TriangleMesh& mesh) {
  corners_.reserve(mesh.triangle_count());
  for (uint32_t i = 0; i < mesh.triangle_count(); ++i)
    corners_.push_back({mesh.vertex(i, 0), mesh.vertex(i, 1), mesh.vertex(i, 2)});
}

FrameTree::FrameTree() : data_(std::make_shared<const Data>()) {}

FrameTree::FrameTree(const RayFrame& frame, const Bvh& tree, std::shared_ptr<const TriangleCorners> corners,
                     const WideOptions& options) {
  const Isa isa = options.isa ? *options.isa : default_isa();
  const FrameKernels& table = kernels_of(isa);
  if (corners == nullptr) throw Error(ErrorCode::kUsage, "FrameTree", "has no corners");
  check_numbers("FrameTree", tree.prims, corners->size(), "triangles");
  data_ = std::make_shared<const Data>(Data{write_frame_tree(frame, tree, std::move(corners), options), isa, &table});
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
const std::shared_ptr<const TriangleCorners>& FrameTree::corners() const {
  return data_->tree.corners;
}

}  // namespace raygrain

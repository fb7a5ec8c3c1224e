// A tree as rays are sent through it: wide, or binary.
#pragma once

#include <memory>
#include <optional>

#include "raygrain/accelerator.h"

namespace raygrain {

class SearchTree {
 public:
  SearchTree(const TriangleMesh& mesh, std::shared_ptr<const Bvh> binary) : mesh_(&mesh), binary_(std::move(binary)) {}
  SearchTree(const TriangleMesh& mesh, std::shared_ptr<const Bvh> binary, WideBvh wide)
      : mesh_(&mesh), binary_(std::move(binary)), wide_(std::move(wide)) {}

  /// Rays that fit this tree take it.
  void add_ray_space(FrameTree tree) { frame_ = std::move(tree); }
  const std::optional<FrameTree>& in_ray_space() const { return frame_; }
  /// Leaves the binary tree alone.
  void drop_fast_forms() { wide_.reset(), frame_.reset(); }

  /// Null counters: nothing is counted.
  Hit intersect(const Ray& ray, const Hit& known, const SearchOptions& options, TraceCounters* counters) const {
    if (frame_) {
      const auto found = counters == nullptr ? frame_->intersect(ray, known, options)
                                             : frame_->intersect_counted(ray, *counters, known, options);
      if (found) return *found;
    }
    if (!wide_) return raygrain::intersect(*binary_, *mesh_, ray, known, options, counters);
    return counters == nullptr ? wide_->intersect(ray, known, options)
                               : wide_->intersect_counted(ray, *counters, known, options);
  }
  bool occluded(const Ray& ray, const SearchOptions& options, TraceCounters* counters) const {
    if (frame_) {
      const auto found =
          counters == nullptr ? frame_->occluded(ray, options) : frame_->occluded_counted(ray, *counters, options);
      if (found) return *found;
    }
    if (!wide_) return raygrain::occluded(*binary_, *mesh_, ray, options, counters);
    return counters == nullptr ? wide_->occluded(ray, options) : wide_->occluded_counted(ray, *counters, options);
  }

  const std::shared_ptr<const Bvh>& binary() const { return binary_; }
  const std::optional<WideBvh>& wide() const { return wide_; }
  size_t wide_bytes() const { return (wide_ ? wide_->memory_bytes() : 0) + (frame_ ? frame_->memory_bytes() : 0); }

 private:
  const TriangleMesh* mesh_;  // outlives this
  std::shared_ptr<const Bvh> binary_;
  std::optional<WideBvh> wide_;
  std::optional<FrameTree> frame_;
};

}  // namespace raygrain

#include "build/nearest_leaves.h"

#include "build/reference.h"

namespace raygrain::builder {

namespace {

/// 0 inside. In float: where it overflows or rounds, a point goes elsewhere, which is no error.
float distance(float lo, float hi, float x) {
  const float below = lo - x, above = x - hi;  // no more than one is greater than 0
  return (below > 0 ? below : 0) + (above > 0 ? above : 0);
}

double middle_distance(const Bounds& box, Vec3 p) {
  const Vec3d d = to_double(center(box)) - to_double(p);
  return dot(d, d);
}

}  // namespace

void NearestLeaves::Points::resize(size_t size) {
  x.resize(size);
  y.resize(size);
  z.resize(size);
  number.resize(size);
}

void NearestLeaves::find(const Bvh& tree, std::span<const Vec3> points, std::span<uint32_t> leaves) {
  points_.resize(points.size());
  right_.resize(points.size());
  to_left_.resize(points.size());
  to_right_.resize(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    points_.x[i] = points[i].x;
    points_.y[i] = points[i].y;
    points_.z[i] = points[i].z;
    points_.number[i] = static_cast<uint32_t>(i);
  }
  struct Range {
    uint32_t node;
    size_t begin, end;
  };
  std::vector<Range> open{{0, 0, points.size()}};
  while (!open.empty()) {
    const auto [node, begin, end] = open.back();
    open.pop_back();
    const Bvh::Node& parent = tree.nodes[node];
    if (parent.is_leaf()) {
      for (size_t i = begin; i < end; ++i) leaves[points_.number[i]] = node;
      continue;
    }
    const size_t middle = part(tree.nodes[parent.first].bounds, tree.nodes[parent.first + 1].bounds, begin, end);
    if (middle < end) open.push_back({parent.first + 1, middle, end});
    if (begin < middle) open.push_back({parent.first, begin, middle});
  }
}

/// Points that go left first; where the others begin.
size_t NearestLeaves::part(const Bounds& left, const Bounds& right, size_t begin, size_t end) {
  measure(left, begin, end, to_left_);
  measure(right, begin, end, to_right_);
  size_t lefts = begin, rights = 0;
  for (size_t i = begin; i < end; ++i) {
    size_t is_right = to_right_[i] < to_left_[i] ? 1 : 0;
    if (to_right_[i] == to_left_[i]) {
      const Vec3 p{points_.x[i], points_.y[i], points_.z[i]};
      is_right = middle_distance(right, p) < middle_distance(left, p) ? 1 : 0;
    }
    right_.copy(rights, points_, i);
    points_.copy(lefts, points_, i);
    rights += is_right;
    lefts += 1 - is_right;
  }
  for (size_t i = 0; i < rights; ++i) points_.copy(lefts + i, right_, i);
  return lefts;
}

void NearestLeaves::measure(Bounds box, size_t begin, size_t end, std::vector<float>& distances) const {
  const float *const xs = points_.x.data(), *const ys = points_.y.data(), *const zs = points_.z.data();
  float* const out = distances.data();
  RAYGRAIN_LANES
  for (size_t i = begin; i < end; ++i) {
    const float x = distance(box.lo.x, box.hi.x, xs[i]), y = distance(box.lo.y, box.hi.y, ys[i]),
                z = distance(box.lo.z, box.hi.z, zs[i]);
    out[i] = x * x + y * y + z * z;
  }
}

}  // namespace raygrain::builder

// The way of one ray through influence areas: the exit rule.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "raygrain/accelerator.h"

namespace raygrain {

/// Can an area's direction suit a ray? Sure to say yes where is_direction_affine does, and cheap.
class AxisTest {
 public:
  explicit AxisTest(const AreaGeometry& area);
  bool operator()(const Ray& ray) const {
    const Vec3d d = to_double(ray.direction), axis = is_plane_ ? axis_ : to_double(ray.origin) - axis_;
    const double along = dot(d, axis);
    return along * along >= least_ * dot(d, d) * dot(axis, axis);
  }

 private:
  Vec3d axis_;  // the direction, or the eye
  double least_;
  bool is_plane_;
};

/// What the walk reads, parallel by area.
struct AreaTable {
  std::vector<AreaGeometry> geometries;
  std::vector<uint32_t> ranks;  // place in the order of predicted cost, ties by index
  TopLevel top_level;
  std::vector<AxisTest> axes;
};

/// Chooses the areas whose trees a ray searches, one after the other.
///
/// The rule, and why its answers are right. "Hit" means every triangle that the ray meets, with its rounded t.
///  1. An area's tree holds all hits with t in an interval that its region certifies: [0, exit_distance] for an area
///     where the ray starts, else inside_interval (computed from the ray's own origin, not from a rounded point on the
///     way). So if the hits with t <= `from` are known, then after an area whose interval holds `from` and ends at
///     `exit` the hits with t <= exit are known. At the start `from` = 0, and no hit is below it: t >= tmin >= 0.
///  2. What is nearest among the known hits is nearest of all once its t <= exit, and a ray that ends at tmax <= exit
///     has no others. So the search may stop exactly then.
///  3. A search that goes on has nothing left to find at t <= from, and may skip boxes that the ray leaves before.
/// Which areas are asked does not matter for the answer, only for the time: candidates come from the top level at the
/// point where the ray enters, rounded to float, and must serve the ray there.
class AreaWalk {
 public:
  struct Stage {
    uint32_t area;
    float exit;  // hits with t <= exit are known after this area
  };

  /// Among the areas that `allowed` says (one for each). Null counters: nothing is counted.
  AreaWalk(const AreaTable& areas, const Ray& ray, std::span<const uint8_t> allowed, AcceleratorCounters* counters);

  /// The next area to search, or nothing: the global tree must answer.
  std::optional<Stage> next();

  /// Valid for the stage that `next` returned, and for the global tree after the last one.
  const SearchOptions& search_options() const { return search_; }

 private:
  /// More areas than this along one ray are not worth their while; the global tree answers then.
  static constexpr size_t kMaxStages = 16;

  void count(uint64_t AcceleratorCounters::*what) {
    if (counters_ != nullptr) ++(counters_->*what);
  }
  bool was_tried(uint32_t area) const;
  bool may_be_served() const;
  std::optional<uint32_t> cheapest_serving(const Ray& from_here);
  float certain_exit(uint32_t area) const;

  const AreaTable& areas_;
  const Ray& ray_;
  std::span<const uint8_t> allowed_;
  AcceleratorCounters* counters_;
  SearchOptions search_;
  float from_ = 0;  // hits with t <= from_ are known; 0: none needs to be
  bool started_ = false;
  std::array<uint32_t, kMaxStages> tried_{};
  size_t tried_count_ = 0;
};

}  // namespace raygrain

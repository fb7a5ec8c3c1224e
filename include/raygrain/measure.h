// Ray measures: how many rays of a distribution meet a box, up to a constant. The one question every builder asks.
#pragma once

#include <concepts>
#include <functional>
#include <optional>
#include <span>

#include "raygrain/bounds.h"

namespace raygrain {

/// A function from boxes to non-negative finite numbers, asked for many boxes in one indirect call.
///
/// `total` is the measure of all rays of the distribution, so that measure / total is an absolute probability. Without
/// one (surface area) the root's measure stands in. Must be safe to call from several threads. Never asked about empty
/// boxes.
class RayMeasure {
 public:
  using Batch = std::function<void(std::span<const Bounds>, std::span<float>)>;

  /// Surface area: face weights 1/2, 1/2, 1/2.
  RayMeasure();

  /// From any function of one box, e.g. a lambda; it is inlined into the loop over boxes.
  template <class PerBox>
  requires std::is_invocable_r_v<float, const PerBox&, const Bounds&> RayMeasure(
      PerBox per_box, std::optional<float> total = std::nullopt)  // NOLINT: implicit on purpose
      : batch_([per_box = std::move(per_box)](std::span<const Bounds> boxes, std::span<float> out) {
          for (size_t i = 0; i < boxes.size(); ++i) out[i] = static_cast<float>(per_box(boxes[i]));
        }),
        total_(total) {}

  /// From a function that answers for many boxes at once; `out` has the size of `boxes`.
  static RayMeasure from_batch(Batch batch, std::optional<float> total = std::nullopt);

  void operator()(std::span<const Bounds> boxes, std::span<float> out) const { batch_(boxes, out); }
  float operator()(const Bounds& box) const {
    float result = 0;
    batch_({&box, 1}, {&result, 1});
    return result;
  }

  /// The measure of all rays: the given total, or that of `root`.
  float total(const Bounds& root) const { return total_ ? *total_ : (*this)(root); }
  /// The total, where there is one: for measures made of another one.
  std::optional<float> given_total() const { return total_; }

 private:
  Batch batch_;
  std::optional<float> total_;
};

/// w . (A_yz, A_zx, A_xy) with A the face areas: exact for every distribution whose directions are equally dense per
/// unit area perpendicular to them and independent of position; w = (E|v_x|, E|v_y|, E|v_z|). Uniform: 1/2 each
/// (surface area / 4).
RayMeasure face_weight_measure(Vec3 weights = {0.5f, 0.5f, 0.5f}, std::optional<float> total = std::nullopt);

/// min(child / parent, 1): the probability that a ray that meets the parent meets the child. 0 when the parent is 0.
constexpr float conditional_probability(float child, float parent) {
  return parent > 0 ? (child < parent ? child / parent : 1.0f) : 0.0f;
}

}  // namespace raygrain

// Rays of arrays that a batch call could have: found again, so that coverage answers them together.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "accel/batch_coverages.h"

namespace raygrain {

/// Of the rays of an array: those that are bit for bit rays of the same batch call, and those that are of none.
class Bundles {
 public:
  static constexpr size_t kMost = 6;  // bundles
  /// Of fewer rays only those are told that are one bundle as a whole. Measured: docs/performance-rays.md, "How many
  /// rays a call".
  static constexpr size_t kLeastMixed = 256;

  /// Any hits or nearest ones.
  Bundles(const BatchCoverages& coverages, bool any, std::span<const Ray> rays);

  size_t size() const { return size_; }
  const Shared& shared(size_t bundle) const { return shared_[bundle]; }
  /// Numbers of its rays, ascending; none where they would be too few.
  std::span<const uint32_t> rays(size_t bundle) const { return numbers_[bundle]; }
  /// Those in no bundle, in any order, where there are bundles.
  std::span<const uint32_t> others() const { return others_; }
  /// By number of the ray: what a batch call takes of it. Of others: anything.
  std::span<const Vec3> points() const { return points_; }

 private:
  void find(const BatchCoverages& coverages, const Ray& ray);
  void divide(std::span<const Ray> rays);
  void dissolve_small(const BatchCoverages& coverages);

  bool any_;
  size_t size_ = 0;
  std::array<Shared, kMost> shared_;
  std::array<std::vector<uint32_t>, kMost> numbers_;
  std::vector<uint32_t> others_;
  std::vector<Vec3> points_;
};

}  // namespace raygrain

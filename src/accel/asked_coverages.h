// The coverages that a kind of question goes to, the likeliest first.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/coverage.h"
#include "raygrain/ray.h"

namespace raygrain {

/// Where the rays of point areas go that coverages answer.
enum class EyeEnd : uint8_t {
  kTowards,  // to the eye: any hits
  kFrom,     // from it: nearest hits
};

/// Whom a ray asks first decides about time alone: whoever answers, answers the same.
class AskedCoverages {
 public:
  AskedCoverages() = default;
  /// Those of `coverages` for which `covers` says so; all are parallel.
  AskedCoverages(std::span<const Coverage> coverages, std::span<const AreaGeometry> areas,
                 std::span<const uint8_t> covers, EyeEnd end);

  /// The first answer of ask(coverage, number of its area), an optional; an empty one if nobody answers.
  template <class Ask>
  auto first_answer(const Ray& ray, const Ask& ask) const {
    for (const Asked& asked : alone_)
      if (auto answer = ask(asked.coverage, asked.area)) return answer;
    for (const Lamp& lamp : lamps_) {
      if (lamps_.size() > 1 && is_elsewhere(lamp, ray)) continue;
      const size_t likely = lamp.likely[face_of(ray.direction)];
      if (auto answer = ask(lamp.frusta[likely].coverage, lamp.frusta[likely].area)) return answer;
      for (size_t i = 0; i < lamp.frusta.size(); ++i)
        if (i != likely)
          if (auto answer = ask(lamp.frusta[i].coverage, lamp.frusta[i].area)) return answer;
    }
    return decltype(ask(alone_[0].coverage, 0u)){};
  }

  /// Of the lists; coverages are counted where they are kept.
  bool is_empty() const { return alone_.empty() && lamps_.empty(); }
  size_t memory_bytes() const;

  /// Of a cube around the origin, the face that the direction points at: 2 * axis, + 1 where that is negative.
  static size_t face_of(Vec3 direction) {
    // As integers, and without jumps: nobody can guess these comparisons.
    const auto bits = [](float a) { return std::bit_cast<uint32_t>(a); };
    const uint32_t x = bits(direction.x), y = bits(direction.y), z = bits(direction.z);
    const bool y_over_x = y << 1 > x << 1;
    const uint32_t xy = y_over_x ? y : x;
    const bool z_over_xy = z << 1 > xy << 1;
    const uint32_t largest = z_over_xy ? z : xy, axis = z_over_xy ? 2 : (y_over_x ? 1 : 0);
    return 2 * axis + (largest >> 31);
  }

 private:
  struct Asked {
    Coverage coverage;
    uint32_t area;
  };
  /// Several areas about one point.
  struct Lamp {
    Vec3 eye;
    std::vector<Asked> frusta;
    std::array<uint32_t, 6> likely{};  // by face: the frustum of most rays that point at it
  };

  /// Surely not on a line through the eye.
  static bool is_elsewhere(const Lamp& lamp, const Ray& ray);

  std::vector<Asked> alone_;  // of plane areas, and of points that have one area
  std::vector<Lamp> lamps_;
};

}  // namespace raygrain

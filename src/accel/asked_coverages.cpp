#include "accel/asked_coverages.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <variant>

#include "accel/foreign.h"

namespace raygrain {
namespace {

constexpr std::array<Vec3d, 6> kFaces{{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}};

std::optional<Vec3> eye_of(const AreaGeometry& area) {
  if (area.is_plane()) return {};
  return std::get<PointArea>(area.area().shape).eye;
}

/// The one of a lamp's areas whose rays go along `direction` most.
uint32_t most_aligned(std::span<const Vec3d> forwards, Vec3d direction) {
  uint32_t best = 0;
  for (uint32_t i = 1; i < forwards.size(); ++i)
    if (dot(forwards[i], direction) > dot(forwards[best], direction)) best = i;
  return best;
}

}  // namespace

AskedCoverages::AskedCoverages(std::span<const Coverage> coverages, std::span<const AreaGeometry> areas,
                               std::span<const uint8_t> covers, EyeEnd end) {
  std::vector<bool> is_taken(covers.size());
  for (size_t first = 0; first < covers.size(); ++first) {
    if (covers[first] == 0 || is_taken[first]) continue;
    const std::optional<Vec3> eye = eye_of(areas[first]);
    Lamp lamp;
    std::vector<Vec3d> forwards;
    for (size_t i = first; i < covers.size() && (eye || i == first); ++i) {
      if (covers[i] == 0 || eye_of(areas[i]) != eye) continue;
      is_taken[i] = true;
      lamp.frusta.push_back({coverages[i], static_cast<uint32_t>(i)});
      forwards.push_back(end == EyeEnd::kFrom ? areas[i].frame().forward : -areas[i].frame().forward);
    }
    if (lamp.frusta.size() == 1) {
      alone_.push_back(lamp.frusta[0]);
      continue;
    }
    lamp.eye = *eye;
    for (size_t face = 0; face < kFaces.size(); ++face) lamp.likely[face] = most_aligned(forwards, kFaces[face]);
    lamps_.push_back(std::move(lamp));
  }
}

size_t AskedCoverages::memory_bytes() const {
  size_t bytes = alone_.capacity() * sizeof(Asked) + lamps_.capacity() * sizeof(Lamp);
  for (const Lamp& lamp : lamps_) bytes += lamp.frusta.capacity() * sizeof(Asked);
  return bytes;
}

bool AskedCoverages::is_elsewhere(const Lamp& lamp, const Ray& ray) {
  return passes_by(ray, lamp.eye, kAxisSquare);
}

}  // namespace raygrain

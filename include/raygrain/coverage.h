// Coverage: what the rays of an influence area see first, as a grid of cells across the rays. Most questions about
// rays along them are answered by one cell, without a triangle.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/ray.h"
#include "raygrain/wide.h"

namespace raygrain {

/// In which order the rays of a batch are answered. The answers do not depend on it.
enum class CoverageOrder : uint8_t {
  kChosen,      // for each batch what was measured to pay for as many rays
  kAsGiven,     // one by one
  kRuns,        // as given, but neighbours in one cell together
  kOpenByTile,  // what cells do not tell is sorted by tile
  kByTile,      // sorted by tile first
  kByCell,      // sorted by cell first, those of a cell together
};
inline constexpr CoverageOrder kCoverageOrders[] = {CoverageOrder::kChosen, CoverageOrder::kAsGiven,
                                                    CoverageOrder::kRuns,   CoverageOrder::kOpenByTile,
                                                    CoverageOrder::kByTile, CoverageOrder::kByCell};
/// "chosen", "as-given", "runs", "open-by-tile", "by-tile" or "by-cell".
std::string_view name(CoverageOrder order);

struct CoverageOptions {
  float cells_per_triangle = 0.25f;       // of each tile; > 0
  uint32_t triangles_per_tile = 256;      // on average; >= 1
  std::optional<Isa> isa = std::nullopt;  // default_isa() without one
  CoverageOrder order = CoverageOrder::kChosen;
  unsigned threads = 0;  // of the build; 0 = all
};

/// Counts of what was done (sums).
struct CoverageCounters {
  uint64_t rays = 0;
  uint64_t covered = 0;         // hits told by their cell alone
  uint64_t free = 0;            // misses told by their cell alone
  uint64_t triangle_tests = 0;  // of the float filter
  uint64_t confirmations = 0;   // triangles decided by more than floats

  void add(const CoverageCounters& other);
};

/// An immutable structure over the triangles that an area's rays can meet. The light (or eye) looks at a grid of cells;
/// each cell knows the depth up to which the scene certainly hides everything behind it, the depth before which nothing
/// lies, and the triangles in between. Rays towards the light ask for any hit; rays from outside that travel with the
/// light ask for the first. Answers equal the oracle's, bit for bit. Cheap to copy, safe to use from many threads.
///
/// After the shadow map of Williams, "Casting curved shadows on curved surfaces" (1978), and its exact form by Wyman
/// et al., "Frustum-traced irregular z-buffers" (2016); the cover by several triangles is told by the parity of how
/// often they cover a point (docs/theory-coverage.md).
class Coverage {
 public:
  Coverage();  // serves no ray

  /// Throws Error: kBadArea for a bad area, kUsage for options out of range or an instruction set that this CPU lacks.
  Coverage(std::shared_ptr<const TriangleMesh> mesh, const InfluenceArea& area, const CoverageOptions& options = {});

  /// One for each area, over the same mesh, built side by side: what they share is found once. Same errors.
  static std::vector<Coverage> of_areas(std::shared_ptr<const TriangleMesh> mesh, std::span<const InfluenceArea> areas,
                                        const CoverageOptions& options = {});

  /// False where the area cannot be covered (triangles between the eye and the near plane, large triangles in many
  /// layers, or none at all): no ray is answered then.
  bool is_useful() const;

  /// 1 for rays of this direction against the light's (towards it), -1 for the light's own, 0 for others and for eyes.
  int sense(Vec3 direction) const;
  /// Is it about rays to and from this point?
  bool has_eye(Vec3 point) const;

  /// One ray: nothing if it is not this structure's to answer. Rays to a light have tmin = 0 and end at it, up to
  /// rounding; rays against a direction end nowhere or beyond all triangles.
  std::optional<bool> occluded(const Ray& ray) const;
  std::optional<Hit> intersect(const Ray& ray) const;

  /// Answers what it can of the rays (origins[i], direction), tmin 0, tmax infinite, against the light's direction;
  /// appends the numbers of the others to `rest`, ascending. `subset` (ascending numbers; empty: all) chooses rays.
  /// 0 threads = all. Throws Error: kUsage unless there is an answer's room for each origin and `subset` names origins
  /// alone, kLimit for 2^32 rays or more.
  void occluded(std::span<const Vec3> origins, Vec3 direction, std::span<uint8_t> flags, std::vector<uint32_t>& rest,
                std::span<const uint32_t> subset = {}, unsigned threads = 1,
                CoverageCounters* counters = nullptr) const;

  /// The same for rays from the origins to the area's eye: direction float32(point - origin), tmin 0, tmax 1. Same
  /// errors, here and below.
  void occluded_towards(std::span<const Vec3> origins, Vec3 point, std::span<uint8_t> flags,
                        std::vector<uint32_t>& rest, std::span<const uint32_t> subset = {}, unsigned threads = 1,
                        CoverageCounters* counters = nullptr) const;

  /// Nearest hits of rays with the light's direction that start before all triangles of their cell.
  void intersect(std::span<const Vec3> origins, Vec3 direction, std::span<Hit> hits, std::vector<uint32_t>& rest,
                 std::span<const uint32_t> subset = {}, unsigned threads = 1,
                 CoverageCounters* counters = nullptr) const;

  /// Nearest hits of rays from the area's eye.
  void intersect_from(Vec3 eye, std::span<const Vec3> directions, std::span<Hit> hits, std::vector<uint32_t>& rest,
                      std::span<const uint32_t> subset = {}, unsigned threads = 1,
                      CoverageCounters* counters = nullptr) const;

  /// Of several coverages with the same eye, lists for each the points (or directions) that are in its window, every
  /// one in one list at most, ascending; appends the numbers of the others to `rest`. 0 threads = all. Throws Error:
  /// kUsage unless there are 1 ... 254 coverages, kLimit for 2^32 points or more.
  static std::vector<std::vector<uint32_t>> divide(std::span<const Coverage* const> coverages,
                                                   std::span<const Vec3> points, bool are_directions,
                                                   std::vector<uint32_t>& rest, unsigned threads = 1);

  size_t cell_count() const;
  size_t memory_bytes() const;  // cells, tiles, triangles as they are tested, and references to them; not the mesh
  /// By the clock, on the threads that built it; of one of of_areas beside others', with an equal part of what they
  /// share.
  double build_seconds() const;

 private:
  struct Data;
  struct Shared;
  Coverage(std::shared_ptr<const TriangleMesh> mesh, const InfluenceArea& area, const CoverageOptions& options,
           const Shared* shared);
  std::shared_ptr<const Data> data_;
};

}  // namespace raygrain

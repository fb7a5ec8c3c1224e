#include "raygrain/coverage.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/sizes.h"
#include "base/timer.h"
#include "trace/coverage_columns.h"
#include "trace/coverage_divide.h"
#include "trace/coverage_grid.h"
#include "trace/kernels/coverage_kernels.h"
#include "trace/kernels/kernels.h"

namespace raygrain {

struct Coverage::Data {
  CoverageGrid grid;
  Isa isa = Isa::kScalar;
  const CoverageKernels* kernels = &coverage_kernels(Isa::kScalar);
  CoverageOrder order = CoverageOrder::kChosen;
  double seconds = 0;
};

namespace {

/// Sorting by cell pays where so many rays meet each cell, on average. The more, the better, up to what caches hold.
constexpr size_t kRaysPerCell = 2;
constexpr size_t kMostRaysPerTaskByCell = size_t{1} << 19;
/// Sorting by tile pays where so many rays meet each tile ...
constexpr size_t kRaysPerTile = 4;
/// ... and the grid does not fit the caches anyway.
constexpr size_t kSmallGrid = size_t{1} << 20;
constexpr size_t kMostRaysPerTask = size_t{1} << 17;  // so many fit a cache with their answers
constexpr size_t kLeastRaysPerTask = 4096;

size_t bytes_of(const CoverageGrid& grid) {
  return grid.memory.size() + grid.tiles.capacity() * sizeof(CoverageTile) +
         grid.near_triangles.capacity() * sizeof(uint32_t);
}

void check_call(size_t rays, size_t answers, std::span<const uint32_t> subset) {
  check_sizes("Coverage", rays, answers);
  if (rays > 0xffffffffu) throw Error(ErrorCode::kLimit, "Coverage", "2^32 rays or more in one call");
  check_numbers("Coverage", subset, rays, "rays");
}

void pass_on(size_t count, std::span<const uint32_t> subset, std::vector<uint32_t>& rest) {
  if (!subset.empty()) return void(rest.insert(rest.end(), subset.begin(), subset.end()));
  for (size_t i = 0; i < count; ++i) rest.push_back(static_cast<uint32_t>(i));
}

/// How many rays of a batch each task takes, and in which order.
struct BatchPlan {
  size_t grain = 0;
  ColumnBatch batch;
};

BatchPlan plan_batch(const CoverageGrid& grid, CoverageOrder order, size_t count, unsigned threads) {
  const bool is_shared = count > kLeastRaysPerTask && threads != 1;  // asking the system costs more than a small batch
  const size_t most_threads = is_shared ? default_threads() : 1;
  const size_t workers = threads == 0 ? most_threads : std::min<size_t>(threads, most_threads);
  const auto grain_of = [&](size_t most) {
    const size_t turns = (count + workers * most - 1) / (workers * most);
    return std::max((count + workers * turns - 1) / (workers * turns), kLeastRaysPerTask);
  };
  BatchPlan plan;
  const size_t large = grain_of(kMostRaysPerTaskByCell);
  plan.batch.order = order;
  plan.batch.count = static_cast<uint32_t>(count);
  plan.batch.by_cell = std::min(count, large) >= kRaysPerCell * grid.cells.size();
  plan.batch.by_tile = count >= kRaysPerTile * grid.tiles.size() && bytes_of(grid) > kSmallGrid;
  const bool is_by_cell = order == CoverageOrder::kByCell || (order == CoverageOrder::kChosen && plan.batch.by_cell);
  plan.grain = is_by_cell ? large : grain_of(kMostRaysPerTask);
  return plan;
}

/// Runs ask(batch, rest, counters) over parts of the rays.
template <class Ask>
void in_parts(const CoverageGrid& grid, CoverageOrder order, const ColumnRays& rays, size_t points,
              std::span<const uint32_t> subset, std::vector<uint32_t>& rest, unsigned threads,
              CoverageCounters* counters, const Ask& ask) {
  const size_t count = subset.empty() ? points : subset.size();
  if (count == 0) return;
  BatchPlan plan = plan_batch(grid, order, count, threads);
  plan.batch.rays = rays;
  plan.batch.subset = subset.empty() ? nullptr : subset.data();
  CoverageCounters unwanted;
  CoverageCounters& sum = counters != nullptr ? *counters : unwanted;
  if (count <= plan.grain) return ask(plan.batch, rest, sum);
  const size_t parts = (count + plan.grain - 1) / plan.grain;
  std::vector<std::vector<uint32_t>> rests(parts);
  std::vector<CoverageCounters> counts(parts);
  parallel_for(count, plan.grain, threads, [&](size_t begin, size_t end) {
    const size_t part = begin / plan.grain;
    ask(plan.batch.part(begin, end), rests[part], counts[part]);
  });
  for (size_t i = 0; i < parts; ++i) {
    rest.insert(rest.end(), rests[i].begin(), rests[i].end());
    sum.add(counts[i]);
  }
}

}  // namespace

std::string_view name(CoverageOrder order) {
  switch (order) {
    case CoverageOrder::kChosen:
      return "chosen";
    case CoverageOrder::kAsGiven:
      return "as-given";
    case CoverageOrder::kRuns:
      return "runs";
    case CoverageOrder::kOpenByTile:
      return "open-by-tile";
    case CoverageOrder::kByTile:
      return "by-tile";
    case CoverageOrder::kByCell:
      return "by-cell";
  }
  return {};
}

void CoverageCounters::add(const CoverageCounters& other) {
  rays += other.rays;
  covered += other.covered;
  free += other.free;
  triangle_tests += other.triangle_tests;
  confirmations += other.confirmations;
}

Coverage::Coverage() : data_(std::make_shared<const Data>()) {}

struct Coverage::Shared {
  MeshNeighbours neighbours;
  double seconds;  // each area's part of the time that they took
};

Coverage::Coverage(std::shared_ptr<const TriangleMesh> mesh, const InfluenceArea& area, const CoverageOptions& options)
    : Coverage(std::move(mesh), area, options, nullptr) {}

Coverage::Coverage(std::shared_ptr<const TriangleMesh> mesh, const InfluenceArea& area, const CoverageOptions& options,
                   const Shared* shared) {
  if (mesh == nullptr) throw Error(ErrorCode::kUsage, "mesh", "is missing");
  if (!(options.cells_per_triangle > 0) || options.triangles_per_tile == 0)
    throw Error(ErrorCode::kUsage, "CoverageOptions", "densities must be positive");
  const Isa isa = options.isa ? *options.isa : default_isa();
  if (kernels(isa) == nullptr)
    throw Error(ErrorCode::kUsage, "CoverageOptions::isa", "this CPU does not offer '" + std::string(name(isa)) + "'");
  const Timer timer;
  const CoverageDensity density{options.cells_per_triangle, static_cast<double>(options.triangles_per_tile)};
  Data data{build_coverage(std::move(mesh), AreaGeometry(area), density,
                           shared != nullptr ? &shared->neighbours : nullptr, options.threads),
            isa, &coverage_kernels(isa), options.order, 0};
  data.seconds = timer.seconds() + (shared != nullptr ? shared->seconds : 0);
  data_ = std::make_shared<const Data>(std::move(data));
}

std::vector<Coverage> Coverage::of_areas(std::shared_ptr<const TriangleMesh> mesh, std::span<const InfluenceArea> areas,
                                         const CoverageOptions& options) {
  if (mesh == nullptr) throw Error(ErrorCode::kUsage, "mesh", "is missing");
  std::vector<Coverage> coverages(areas.size());
  if (areas.empty()) return coverages;
  const Timer timer;
  Shared shared{find_neighbours(*mesh), 0};
  shared.seconds = timer.seconds() / static_cast<double>(areas.size());
  parallel_for(areas.size(), 1, options.threads, [&](size_t begin, size_t end) {
    for (size_t i = begin; i < end; ++i) coverages[i] = Coverage(mesh, areas[i], options, &shared);
  });
  return coverages;
}

int Coverage::sense(Vec3 direction) const {
  return is_useful() && !data_->grid.map.is_eye ? sense_of(data_->grid, direction) : 0;
}

bool Coverage::has_eye(Vec3 point) const {
  return is_useful() && data_->grid.map.is_eye && point == data_->grid.map.center;
}

std::optional<bool> Coverage::occluded(const Ray& ray) const {
  const CoverageGrid& grid = data_->grid;
  SingleColumn column{};
  if (!is_useful() || ray.tmin != 0 || !(ray.tmax >= 0)) return {};
  if (!(grid.map.is_eye ? column_to_eye(grid, ray, column) : column_along(grid, ray, 1, column))) return {};
  return data_->kernels->any_of_one(grid, column, ray);
}

std::optional<Hit> Coverage::intersect(const Ray& ray) const {
  const CoverageGrid& grid = data_->grid;
  SingleColumn column{};
  if (!is_useful() || ray.tmin != 0 || ray.tmax != kInf) return {};
  if (!(grid.map.is_eye ? column_from_eye(grid, ray, column) : column_along(grid, ray, -1, column))) return {};
  return data_->kernels->nearest_of_one(grid, column, ray);
}

bool Coverage::is_useful() const {
  return data_->grid.is_useful();
}

void Coverage::occluded(std::span<const Vec3> origins, Vec3 direction, std::span<uint8_t> flags,
                        std::vector<uint32_t>& rest, std::span<const uint32_t> subset, unsigned threads,
                        CoverageCounters* counters) const {
  check_call(origins.size(), flags.size(), subset);
  const CoverageGrid& grid = data_->grid;
  if (!is_useful() || grid.map.is_eye || sense_of(grid, direction) != 1) return pass_on(origins.size(), subset, rest);
  in_parts(grid, data_->order, {ColumnRays::Kind::kAlong, direction, origins.data()}, origins.size(), subset, rest,
           threads, counters, [&](const ColumnBatch& batch, std::vector<uint32_t>& others, CoverageCounters& counts) {
             data_->kernels->any(grid, batch, flags.data(), others, counts);
           });
}

void Coverage::occluded_towards(std::span<const Vec3> origins, Vec3 point, std::span<uint8_t> flags,
                                std::vector<uint32_t>& rest, std::span<const uint32_t> subset, unsigned threads,
                                CoverageCounters* counters) const {
  check_call(origins.size(), flags.size(), subset);
  const CoverageGrid& grid = data_->grid;
  if (!is_useful() || !grid.map.is_eye || point != grid.map.center) return pass_on(origins.size(), subset, rest);
  in_parts(grid, data_->order, {ColumnRays::Kind::kTowards, point, origins.data()}, origins.size(), subset, rest,
           threads, counters, [&](const ColumnBatch& batch, std::vector<uint32_t>& others, CoverageCounters& counts) {
             data_->kernels->any(grid, batch, flags.data(), others, counts);
           });
}

void Coverage::intersect(std::span<const Vec3> origins, Vec3 direction, std::span<Hit> hits,
                         std::vector<uint32_t>& rest, std::span<const uint32_t> subset, unsigned threads,
                         CoverageCounters* counters) const {
  check_call(origins.size(), hits.size(), subset);
  const CoverageGrid& grid = data_->grid;
  if (!is_useful() || grid.map.is_eye || sense_of(grid, direction) != -1) return pass_on(origins.size(), subset, rest);
  in_parts(grid, data_->order, {ColumnRays::Kind::kAlong, direction, origins.data()}, origins.size(), subset, rest,
           threads, counters, [&](const ColumnBatch& batch, std::vector<uint32_t>& others, CoverageCounters& counts) {
             data_->kernels->nearest(grid, batch, hits.data(), others, counts);
           });
}

void Coverage::intersect_from(Vec3 eye, std::span<const Vec3> directions, std::span<Hit> hits,
                              std::vector<uint32_t>& rest, std::span<const uint32_t> subset, unsigned threads,
                              CoverageCounters* counters) const {
  check_call(directions.size(), hits.size(), subset);
  const CoverageGrid& grid = data_->grid;
  if (!is_useful() || !grid.map.is_eye || eye != grid.map.center) return pass_on(directions.size(), subset, rest);
  in_parts(grid, data_->order, {ColumnRays::Kind::kFrom, eye, directions.data()}, directions.size(), subset, rest,
           threads, counters, [&](const ColumnBatch& batch, std::vector<uint32_t>& others, CoverageCounters& counts) {
             data_->kernels->nearest(grid, batch, hits.data(), others, counts);
           });
}

std::vector<std::vector<uint32_t>> Coverage::divide(std::span<const Coverage* const> coverages,
                                                    std::span<const Vec3> points, bool are_directions,
                                                    std::vector<uint32_t>& rest, unsigned threads) {
  if (coverages.empty() || coverages.size() >= kNoGrid)
    throw Error(ErrorCode::kUsage, "Coverage::divide", "takes 1 ... 254 coverages");
  if (points.size() > 0xffffffffu)
    throw Error(ErrorCode::kLimit, "Coverage::divide", "2^32 points or more in one call");
  std::vector<const CoverageGrid*> grids;
  for (const Coverage* coverage : coverages) grids.push_back(&coverage->data_->grid);
  const EyeGrids eye{grids.data(), static_cast<uint32_t>(grids.size())};
  return divide_points(eye, *coverages[0]->data_->kernels, points, are_directions, rest, threads);
}

size_t Coverage::cell_count() const {
  return data_->grid.cells.size();
}

size_t Coverage::memory_bytes() const {
  return bytes_of(data_->grid);
}

double Coverage::build_seconds() const {
  return data_->seconds;
}

}  // namespace raygrain

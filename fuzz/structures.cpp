// Boxes and options from bytes: builders refuse them, or their trees are sound, and stay so when they are improved.
#include <algorithm>
#include <array>

#include "raygrain/build.h"
#include "raygrain/refine.h"

#include "reader.h"

namespace raygrain::fuzz {

namespace {

constexpr uint32_t kMostBoxes = 200, kMany = 9000;  // build_subset is another builder from 8192 on
using Build = Bvh (*)(std::span<const Bounds>, std::span<const Vec3>, const BuildOptions&, BuildLog*);
constexpr std::array<Build, 5> kBuilders{build_paper, build_binned, build_sweep, build_spatial, build_subset};

/// Sound ones, or of any kind: inverted, infinite, NaN, denormal.
std::vector<Bounds> read_boxes(Reader& reader) {
  const uint8_t kind = reader.byte();
  const bool sound = kind % 4 != 0, same = kind % 16 == 1;
  const uint32_t count = reader.byte() % kMostBoxes;
  std::vector<Bounds> boxes;
  for (uint32_t i = 0; i < count; ++i) {
    Bounds box{reader.any_point(), reader.any_point()};
    if (sound) {
      box = {};
      box.extend(reader.finite_point());
      box.extend(reader.finite_point());
    }
    boxes.push_back(same && i > 0 ? boxes.front() : box);
  }
  if (kind >= 250 && count > 0)
    while (boxes.size() < kMany) boxes.push_back(Bounds(boxes[boxes.size() - count]));
  return boxes;
}

BuildOptions read_options(Reader& reader) {
  BuildOptions options;
  PaperParameters& p = options.parameters;
  options.threads = 1;
  if (reader.flag()) return options;
  p.max_levels = reader.byte() % 258;
  p.bins = reader.flag() ? reader.byte() : 40;
  p.max_triangles_per_leaf = reader.byte() % 12;
  p.max_non_fallback_levels = reader.byte() % 100;
  p.max_leaf_cost = reader.flag() ? reader.any() : 0;
  p.max_leaf_area = reader.flag() ? reader.any() : 0;
  p.split_plane_quality_threshold = static_cast<float>(reader.byte()) / 250;
  p.acceptable_ratio = reader.any();
  p.excellent_ratio = reader.any();
  options.costs = {reader.any(), reader.any()};
  options.split_inseparable = reader.flag();
  options.merge_leaves = reader.flag();
  options.leaf_size = reader.byte() % 20;
  options.rare_leaf_size = reader.byte() % 20;
  options.rare_share = reader.any();
  options.seed = reader.word();
  options.spatial = {reader.any(), reader.any()};
  if (reader.flag()) options.fallback = BuildStrategy{};
  return options;
}

std::vector<Vec3> read_centroids(Reader& reader, std::span<const Bounds> boxes) {
  std::vector<Vec3> centroids;
  if (reader.flag()) return centroids;
  const bool anywhere = reader.flag();
  for (const Bounds& box : boxes) centroids.push_back(anywhere ? reader.any_point() : center(box));
  return centroids;
}

void check_sound(const Bvh& tree, std::span<const Bounds> boxes, const std::string& what) {
  const auto defect = find_defect(tree, boxes);
  require(!defect, what + ": " + defect.value_or(""));
}

void check_refinements(Bvh tree, std::span<const Bounds> boxes, const std::string& what) {
  accepts([&] { reinsert(tree, {}, {.threads = 1}); });
  check_sound(tree, boxes, what + ", reinserted");
  std::vector<Bounds> moved(boxes.begin(), boxes.end());
  std::reverse(moved.begin(), moved.end());
  if (accepts([&] { refit(tree, moved); })) check_sound(tree, moved, what + ", refitted");
}

}  // namespace

void structure(Bytes bytes) {
  Reader reader(bytes);
  BuildOptions options = read_options(reader);
  const std::vector<Bounds> boxes = read_boxes(reader);
  const std::vector<Vec3> centroids = read_centroids(reader, boxes);
  options.clip = [&](uint32_t i, const Bounds& box) { return intersected(boxes[i], box); };
  const bool all_finite = std::all_of(boxes.begin(), boxes.end(), [](const Bounds& box) {
    return is_finite(box.lo) && is_finite(box.hi) && !is_empty(box);
  });
  for (size_t i = 0; i < kBuilders.size(); ++i) {
    if (boxes.size() >= kMany && kBuilders[i] != build_subset) continue;  // the others are slow, and know it all
    const std::string what = "builder " + std::to_string(i);
    Bvh tree;
    if (!accepts([&] { tree = kBuilders[i](boxes, centroids, options, nullptr); })) continue;
    require(all_finite, what + " accepts boxes that are empty or not finite");
    check_sound(tree, boxes, what);
    check_refinements(std::move(tree), boxes, what);
  }
}

}  // namespace raygrain::fuzz

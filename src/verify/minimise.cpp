#include "verify/minimise.h"

#include <algorithm>
#include <exception>
#include <functional>
#include <map>
#include <numeric>

#include "verify/oracle.h"

namespace raygrain::verification {
namespace {

constexpr size_t kMostWork = 400'000;  // triangles, rays or areas, summed over all tries

TriangleMesh part_of(const TriangleMesh& mesh, const std::vector<uint32_t>& triangles) {
  TriangleMesh part;
  std::map<uint32_t, uint32_t> number_of;
  for (const uint32_t t : triangles) {
    std::array<uint32_t, 3> corners{};
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t old = mesh.triangles[t][k];
      const auto [found, is_new] = number_of.try_emplace(old, static_cast<uint32_t>(part.vertices.size()));
      if (is_new) part.vertices.push_back(mesh.vertices[old]);
      corners[k] = found->second;
    }
    part.triangles.push_back(corners);
  }
  return part;
}

std::vector<uint32_t> numbers(size_t count) {
  std::vector<uint32_t> result(count);
  std::iota(result.begin(), result.end(), 0u);
  return result;
}

/// Leaves items out, in smaller and smaller pieces, as long as what is left still fails.
std::vector<uint32_t> smallest(std::vector<uint32_t> items, size_t least, size_t& work,
                               const std::function<bool(const std::vector<uint32_t>&)>& fails) {
  for (size_t piece = std::max<size_t>(items.size() / 2, 1);; piece = std::max<size_t>(piece / 2, 1)) {
    bool was_cut = false;
    for (size_t begin = 0; begin < items.size() && work < kMostWork;) {
      const size_t end = std::min(items.size(), begin + piece);
      std::vector<uint32_t> rest(items.begin(), items.begin() + static_cast<ptrdiff_t>(begin));
      rest.insert(rest.end(), items.begin() + static_cast<ptrdiff_t>(end), items.end());
      work += rest.size() + 20;
      if (rest.size() >= least && fails(rest)) {
        items = std::move(rest);
        was_cut = true;
      } else {
        begin = end;
      }
    }
    if ((piece == 1 && !was_cut) || work >= kMostWork) return items;
  }
}

/// A scene and rays of which one fails; made smaller step by step.
class Case {
 public:
  Case(const RayStructure& structure, const Round& round, const Difference& difference)
      : structure_(structure),
        is_about_making_(difference.is_about_making),
        scene_(round.scene),
        group_(round.groups.at(difference.group)),
        target_(difference.ray) {}

  void shrink() {
    shrink_rays();
    shrink_triangles();
    shrink_areas();
    shrink_triangles();
  }

  VerifyFailure result(const std::string& what) const {
    VerifyFailure failure{structure_.name, what, {}, {}};
    failure.scene.name = structure_.name;
    failure.scene.mesh = *scene_.mesh;
    failure.scene.areas = scene_.areas;
    failure.scene.ray_sets.push_back({"rays", group_.rays});
    return failure;
  }

 private:
  bool fails(const VerifyScene& scene, const RayGroup& group, size_t target) const {
    try {
      const Hit expected = Oracle(*scene.mesh).nearest(group.rays[target]);
      return difference_about(structure_, scene, group, target, expected).has_value();
    } catch (const std::exception&) {
      return is_about_making_;
    }
  }

  /// Most often the ray fails alone; else among some of the others, in their order.
  void shrink_rays() {
    RayGroup alone = group_;
    alone.rays = {group_.rays[target_]};
    if (fails(scene_, alone, 0)) {
      group_ = alone;
      target_ = 0;
      return;
    }
    const RayGroup whole = group_;
    const auto target = static_cast<uint32_t>(target_);
    std::vector<uint32_t> others = numbers(whole.rays.size());
    others.erase(others.begin() + target);
    const auto with = [&](std::vector<uint32_t> chosen) {
      chosen.insert(std::ranges::lower_bound(chosen, target), target);
      RayGroup group = whole;
      group.rays.clear();
      for (const uint32_t i : chosen) group.rays.push_back(whole.rays[i]);
      return group;
    };
    const auto place = [&](const std::vector<uint32_t>& chosen) {
      return static_cast<size_t>(std::ranges::lower_bound(chosen, target) - chosen.begin());
    };
    others = smallest(others, 0, work_,
                      [&](const std::vector<uint32_t>& chosen) { return fails(scene_, with(chosen), place(chosen)); });
    group_ = with(others);
    target_ = place(others);
  }

  void shrink_triangles() {
    const VerifyScene whole = scene_;
    const auto with = [&](const std::vector<uint32_t>& triangles) {
      VerifyScene scene = whole;
      scene.mesh = std::make_shared<const TriangleMesh>(part_of(*whole.mesh, triangles));
      return scene;
    };
    scene_ =
        with(smallest(numbers(whole.mesh->triangle_count()), 1, work_,
                      [&](const std::vector<uint32_t>& triangles) { return fails(with(triangles), group_, target_); }));
  }

  void shrink_areas() {
    const VerifyScene whole = scene_;
    const auto with = [&](const std::vector<uint32_t>& areas) {
      VerifyScene scene = whole;
      scene.areas.clear();
      for (const uint32_t i : areas) scene.areas.push_back(whole.areas[i]);
      return scene;
    };
    scene_ = with(smallest(numbers(whole.areas.size()), 0, work_,
                           [&](const std::vector<uint32_t>& areas) { return fails(with(areas), group_, target_); }));
  }

  const RayStructure& structure_;
  bool is_about_making_;
  VerifyScene scene_;
  RayGroup group_;
  size_t target_;
  size_t work_ = 0;
};

}  // namespace

VerifyFailure minimise(const RayStructure& structure, const Round& round, const Difference& difference) {
  Case failing(structure, round, difference);
  failing.shrink();
  return failing.result(difference.what);
}

}  // namespace raygrain::verification

#include "verify/round.h"

#include <algorithm>
#include <string>
#include <utility>

#include "raygrain/error.h"
#include "raygrain/families.h"
#include "raygrain/rays.h"
#include "raygrain/trace.h"

#include "base/random.h"
#include "verify/spec.h"

namespace raygrain::verification {
namespace {

uint64_t mixed(uint64_t seed, uint64_t number) {
  return Random(Random(seed).next() ^ (number * 0x9e3779b97f4a7c15u)).next();
}

/// Mostly small: brute force is cheap there, and every box edge and leaf is met.
size_t random_size(Random& random) {
  const uint64_t kind = random.below(40);
  if (kind < 22) return 1 + random.below(30);
  if (kind < 36) return 30 + random.below(120);
  if (kind < 39) return 150 + random.below(400);
  return random.below(4) ? 500 + random.below(1500) : 3000 + random.below(9000);
}

/// So many that brute force takes about as long for every scene.
size_t rays_for(uint64_t tests, size_t triangles, bool is_brute_force, const std::string& name) {
  // Nearly every triangle of these takes exact arithmetic.
  if (name == "mixed_exponents") tests /= 25;
  if (!is_brute_force) triangles = 300;
  return static_cast<size_t>(std::clamp<uint64_t>(tests / (triangles + 50), 100, 50'000));
}

Vec3 unit_vector(Random& random) {
  Vec3d v{random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1) + 1e-3};
  if (random.below(4) == 0) {
    v = {};
    v[static_cast<int>(random.below(3))] = random.below(2) ? 1 : -1;
  }
  return to_float(normalized(v));
}

/// Answers rays by brute force, or by a binary tree.
class RightAnswers {
 public:
  RightAnswers(const VerifyScene& scene, bool is_brute_force)
      : mesh_(*scene.mesh), oracle_(is_brute_force ? mesh_ : TriangleMesh{}), is_brute_force_(is_brute_force) {
    StructureSpec usual;
    if (!is_brute_force) tree_ = make_tree(usual, scene);
  }
  std::vector<Hit> of(const std::vector<Ray>& rays) const {
    std::vector<Hit> hits(rays.size());
    for (size_t i = 0; i < rays.size(); ++i)
      hits[i] = is_brute_force_ ? oracle_.nearest(rays[i]) : intersect(tree_, mesh_, rays[i]);
    return hits;
  }

 private:
  const TriangleMesh& mesh_;
  Oracle oracle_;
  Bvh tree_;
  bool is_brute_force_;
};

/// Rays of one scene, group by group.
class RayMaker {
 public:
  RayMaker(Round& round, uint64_t seed, bool is_brute_force)
      : round_(round), random_(seed), mesh_(*round.scene.mesh), right_(round.scene, is_brute_force) {}

  void add(RayGroup group) {
    round_.expected.push_back(right_.of(group.rays));
    round_.groups.push_back(std::move(group));
  }

  /// Mixed, and once more with intervals that end at what they hit.
  void add_mixed(size_t count) {
    std::vector<Ray> rays = aimed_rays(mesh_, count * 4 / 10, random_.next());
    append(rays, extreme_rays(mesh_, count * 25 / 100, random_.next()));
    append(rays, rays_of_areas(mesh_, round_.scene.areas, count * 15 / 100, random_.next()));
    std::vector<Ray> windows = window_rays(rays, right_.of(rays), random_.next());
    for (size_t i = windows.size(); i > 1; --i) std::swap(windows[i - 1], windows[random_.below(i)]);
    windows.resize(std::min(windows.size(), count - rays.size()));
    add({RayGroupKind::kMixed, {}, std::move(rays)});
    add({RayGroupKind::kMixed, {}, std::move(windows)});
  }

  void add_direction(Vec3 direction, size_t count) {
    RayGroup group{RayGroupKind::kDirection, direction, {}};
    for (const Vec3 p : points_near(mesh_, direction, count, random_.next()))
      group.rays.push_back({p, direction, 0, kInf});
    add(std::move(group));
  }

  void add_eye(Vec3 eye, size_t count) {
    RayGroup from{RayGroupKind::kFrom, eye, {}}, towards{RayGroupKind::kTowards, eye, {}};
    for (const Vec3 p : points_near(mesh_, {}, count, random_.next())) {
      from.rays.push_back({eye, p - eye, 0, kInf});
      towards.rays.push_back({p, eye - p, 0, 1});
    }
    add(std::move(from));
    add(std::move(towards));
  }

  /// From inside a closed mesh.
  void add_inside(Vec3 inside, size_t count) {
    RayGroup group{RayGroupKind::kFrom, inside, rays_from(inside, mesh_, count, random_.next()), true};
    add(std::move(group));
  }

  /// Along an area's light, against it, and near it: a coverage or a tree in ray space answers few others.
  void add_of_area(const InfluenceArea& area, size_t count) {
    if (const auto* point = std::get_if<PointArea>(&area.shape)) {
      add_eye(point->eye, count / 3);
    } else {
      const Vec3 direction = std::get<PlaneArea>(area.shape).direction;
      add_direction(-direction, count / 3);
      add_direction(direction, count / 3);
    }
    add({RayGroupKind::kMixed, {}, rays_of_areas(mesh_, {area}, count / 3, random_.next())});
  }

  /// Of every area some, of either sense.
  void add_shared(size_t count) {
    const auto& areas = round_.scene.areas;
    for (size_t i = 0; i < 4; ++i) {
      if (areas.empty() || random_.below(6) == 0) {
        add_direction(unit_vector(random_), count / 4);
        continue;
      }
      const InfluenceArea& area = areas[random_.below(areas.size())];
      if (const auto* point = std::get_if<PointArea>(&area.shape)) {
        add_eye(point->eye, count / 8);
      } else {
        const Vec3 direction = std::get<PlaneArea>(area.shape).direction;
        const bool towards = random_.below(3) != 0;
        add_direction(towards ? -direction : direction, count / 4);
      }
    }
  }

 private:
  static void append(std::vector<Ray>& rays, const std::vector<Ray>& more) {
    rays.insert(rays.end(), more.begin(), more.end());
  }

  Round& round_;
  Random random_;
  const TriangleMesh& mesh_;
  RightAnswers right_;
};

/// Areas that cover everything, as coverages need them, where the mesh is of a size that allows finite ones.
void add_covering_areas(VerifyScene& scene, Random& random) {
  const Bounds box = mesh_bounds(*scene.mesh);
  if (is_empty(box)) return;
  for (const Vec3 p : {box.lo, box.hi})
    for (int k = 0; k < 3; ++k)
      if (!(std::abs(p[k]) < 0x1p60f)) return;
  scene.areas.push_back(directional_light_area("sun", unit_vector(random), box));
  const Vec3d lo = to_double(box.lo), size = to_double(extent(box));
  const double around = random.below(2) ? 0 : 1;
  const Vec3d eye =
      lo + Vec3d{size.x * random.uniform(-around, 1 + around), size.y * random.uniform(-around, 1 + around),
                 size.z * random.uniform(-around, 1 + around)};
  const std::vector<InfluenceArea> lamp = point_light_areas("bulb", to_float(eye), box);
  const size_t count = random.below(2) ? 6 : 1;
  scene.areas.insert(scene.areas.end(), lamp.begin(), lamp.begin() + static_cast<ptrdiff_t>(count));
}

void draw_structures(Round& round, const VerifyOptions& options, Random& random) {
  if (options.structures_per_scene > 0)
    round.structures.push_back("exact seed=" + std::to_string(random.below(100'000)));
  for (uint32_t i = 0; i < options.structures_per_scene; ++i) {
    Random own(random.next());
    StructureSpec spec = random_spec(own);
    // Coverages of areas that do not cover the scene answer little; those that do are the last.
    if (spec.kind == "coverage" && !round.scene.areas.empty() && random.below(4))
      spec.area = static_cast<uint32_t>(round.scene.areas.size() - 1 - random.below(2) % round.scene.areas.size());
    round.structures.push_back(to_text(spec));
  }
}

/// Its own rays: all of lists, others drawn anew each time.
void add_own_rays(RayMaker& maker, const Scene& scene, uint64_t visit, size_t most) {
  for (RaySet set : scene.ray_sets) {
    set.count = std::min(set.count, most);
    set.seed += visit;
    for (RayGroup& group : groups_of(make_rays(set, scene.mesh), scene.areas)) maker.add(std::move(group));
  }
}

struct Chosen {
  const Scene* file = nullptr;
  uint64_t visit = 0;  // how often it came before
};

/// Given scenes and random ones in turns.
Chosen choose(const VerifyOptions& options, uint64_t number) {
  if (options.scenes.empty() || number % 2 != 0) return {};
  const uint64_t turn = number / 2;
  return {&options.scenes[turn % options.scenes.size()], turn / options.scenes.size()};
}

bool is_structure(const std::string& name) {
  try {
    return parse_structure(name).make != nullptr;
  } catch (const Error&) {
    return false;
  }
}

}  // namespace

size_t Round::ray_count() const {
  size_t count = 0;
  for (const RayGroup& group : groups) count += group.rays.size();
  return count;
}

Round make_round(const VerifyOptions& options, uint64_t number) {
  Random random(mixed(options.seed, number));
  const Chosen chosen = choose(options, number);
  if (chosen.file != nullptr && chosen.visit == 0 && is_structure(chosen.file->name)) {  // of a saved failure
    Round round = make_round_of(*chosen.file);
    round.structures.push_back(chosen.file->name);
    draw_structures(round, options, random);
    return round;
  }
  Round round;
  Vec3 inside{};
  if (chosen.file != nullptr) {
    round.scene = {chosen.file->name, std::make_shared<const TriangleMesh>(chosen.file->mesh), chosen.file->areas};
  } else {
    const uint64_t seed = random.next();
    NamedMesh mesh = random_family_mesh(random_size(random), seed);
    round.scene = {mesh.name, std::make_shared<const TriangleMesh>(std::move(mesh.mesh)), {}};
    round.closed = mesh.closed;
    inside = mesh.inside;
  }
  const size_t triangles = round.scene.mesh->triangle_count();
  round.is_brute_force = triangles <= options.most_triangles;
  for (InfluenceArea& area : areas_around(*round.scene.mesh, random.next()))
    round.scene.areas.push_back(std::move(area));
  add_covering_areas(round.scene, random);
  draw_structures(round, options, random);

  const size_t count = rays_for(options.tests_per_scene, triangles, round.is_brute_force, round.scene.name);
  RayMaker maker(round, random.next(), round.is_brute_force);
  if (chosen.file != nullptr) add_own_rays(maker, *chosen.file, chosen.visit, 20'000);
  maker.add_mixed(count * 5 / 10);
  maker.add_shared(count * 25 / 100);
  for (const std::string& name : round.structures) {
    const StructureSpec spec = parse_spec(name);
    const InfluenceArea* area = area_of(spec, round.scene);
    if (area != nullptr && (spec.kind == "coverage" || spec.kind == "frame")) maker.add_of_area(*area, count / 4);
  }
  if (round.closed) maker.add_inside(inside, count * 5 / 100);
  return round;
}

Round make_round_of(const Scene& scene) {
  Round round;
  round.scene = {scene.name, std::make_shared<const TriangleMesh>(scene.mesh), scene.areas};
  RayMaker maker(round, 1, true);
  add_own_rays(maker, scene, 0, SIZE_MAX);
  return round;
}

}  // namespace raygrain::verification

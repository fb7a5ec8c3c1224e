// A mesh and rays from bytes: every structure on every instruction set must give the oracle's answer, bit by bit.
#include <bit>

#include "raygrain/accelerator.h"
#include "raygrain/area.h"
#include "raygrain/build.h"
#include "raygrain/rays.h"
#include "raygrain/trace.h"
#include "raygrain/wide.h"

#include "reader.h"

namespace raygrain::fuzz {

namespace {

constexpr uint32_t kMostVertices = 24, kMostTriangles = 40;
constexpr size_t kMostRays = 24;

TriangleMesh read_mesh(Reader& reader) {
  TriangleMesh mesh;
  const uint32_t vertices = 3 + reader.byte() % (kMostVertices - 2), triangles = 1 + reader.byte() % kMostTriangles;
  const bool shared = reader.flag();
  for (uint32_t i = 0; i < vertices; ++i) mesh.vertices.push_back(reader.finite_point());
  for (uint32_t i = 0; i < triangles; ++i) {
    const uint32_t a = reader.byte() % vertices;
    const uint32_t b = shared ? (a + 1) % vertices : reader.byte() % vertices;
    mesh.triangles.push_back({a, b, reader.byte() % vertices});
  }
  return mesh;
}

/// Of any kind; or at a point of a triangle, which random rays seldom meet.
Ray read_ray(Reader& reader, const TriangleMesh& mesh) {
  Ray ray{reader.any_point(), {}};
  const uint8_t kind = reader.byte();
  if (kind < 100) {
    const size_t triangle = reader.byte() % mesh.triangle_count();
    const Vec3 a = mesh.vertex(triangle, 0), b = mesh.vertex(triangle, 1), c = mesh.vertex(triangle, 2);
    const float u = static_cast<float>(reader.byte() % 9) / 8, v = static_cast<float>(reader.byte() % 9) / 8;
    ray.direction = a + (b - a) * u + (c - a) * (v * (1 - u)) - ray.origin;
  } else if (kind < 150) {
    ray.direction[kind % 3] = kind % 2 ? 1.0f : -1.0f;
  } else {
    ray.direction = reader.any_point();
  }
  if (reader.byte() < 64) {
    ray.tmin = reader.any();
    ray.tmax = reader.any();
  }
  return ray;
}

struct Answers {
  std::vector<Hit> hits;
  std::vector<uint8_t> occluded;
};

Answers answers_of_the_oracle(const TriangleMesh& mesh, std::span<const Ray> rays) {
  Answers answers;
  for (const Ray& ray : rays) {
    answers.hits.push_back(intersect_reference(mesh, ray));
    answers.occluded.push_back(occluded_reference(mesh, ray) ? 1 : 0);
  }
  return answers;
}

bool same_bits(const Hit& a, const Hit& b) {
  const auto bits = [](float value) { return std::bit_cast<uint32_t>(value); };
  return bits(a.t) == bits(b.t) && bits(a.u) == bits(b.u) && bits(a.v) == bits(b.v) && a.triangle == b.triangle;
}

/// A structure's answers one by one and as a batch.
template <class Structure>
void compare(const std::string& name, const Structure& structure, std::span<const Ray> rays, const Answers& expected) {
  Answers batch{std::vector<Hit>(rays.size()), std::vector<uint8_t>(rays.size())};
  structure.intersect(rays, batch.hits, 1);
  structure.occluded(rays, batch.occluded, 1);
  for (size_t i = 0; i < rays.size(); ++i) {
    const std::string where = name + ", ray " + std::to_string(i);
    require(same_bits(structure.intersect(rays[i]), expected.hits[i]), where + ": another hit");
    require(same_bits(batch.hits[i], expected.hits[i]), where + ": another hit in the batch");
    require(structure.occluded(rays[i]) == (expected.occluded[i] != 0), where + ": wrongly occluded or not");
    require(batch.occluded[i] == expected.occluded[i], where + ": wrongly occluded or not in the batch");
  }
}

Bvh build(const TriangleMesh& mesh, uint8_t choice) {
  constexpr BuildFunction kBuilders[] = {build_paper, build_binned, build_sweep, build_spatial};
  BuildOptions options;
  options.threads = 1;
  options.leaf_size = 1 + choice % 8;
  options.merge_leaves = choice & 64;
  options.clip = [&](uint32_t triangle, const Bounds& box) { return clip_triangle_bounds(mesh, triangle, box); };
  return kBuilders[choice / 8 % 4](triangle_bounds(mesh), triangle_centroids(mesh), options, nullptr);
}

std::vector<InfluenceArea> read_areas(Reader& reader, const TriangleMesh& mesh) {
  std::vector<InfluenceArea> areas;
  const uint8_t kind = reader.byte() % 4;
  const Vec3 point = reader.finite_point();
  accepts([&] {
    if (kind == 1) areas.push_back(directional_light_area("sun", point, mesh_bounds(mesh)));
    if (kind == 2) areas = point_light_areas("light", point, mesh_bounds(mesh));
    if (kind == 3) areas.push_back({"plane", PlaneArea{point, reader.finite_point(), {0, 1, 0}, 1, 2, 3}});
    for (const InfluenceArea& area : areas) validate(area, "fuzzed");
  });
  return areas;
}

/// Adds rays that the areas serve.
void add_area_rays(std::vector<Ray>& rays, std::span<const InfluenceArea> areas) {
  for (const InfluenceArea& area : areas) {
    const std::vector<Ray> more = cast_rays(AreaRays{area}, 4, 1);
    rays.insert(rays.end(), more.begin(), more.end());
  }
}

void compare_accelerators(Reader& reader, const TriangleMesh& mesh, const std::vector<InfluenceArea>& areas,
                          std::span<const Ray> rays, const Answers& expected) {
  AcceleratorOptions options;
  options.threads = 1;
  options.space = reader.flag() ? LocalSpace::kRay : LocalSpace::kWorld;
  if (reader.flag()) options.coverage.reset();
  options.top_level = {reader.flag() ? TopLevelKind::kList : TopLevelKind::kOctree, 2};  // deep octrees take long
  const std::vector<Isa> isas = supported_isas();  // one of them: a build takes long
  options.isa = isas[reader.byte() % isas.size()];
  compare(std::string("accelerator, ") + name(*options.isa), Accelerator(mesh, areas, options), rays, expected);
}

}  // namespace

void traversal(Bytes bytes) {
  Reader reader(bytes);
  const uint8_t choice = reader.byte();
  const TriangleMesh mesh = read_mesh(reader);
  std::vector<InfluenceArea> areas = read_areas(reader, mesh);
  std::vector<Ray> rays;
  while (!reader.empty() && rays.size() < kMostRays) rays.push_back(read_ray(reader, mesh));
  if (!accepts([&] { add_area_rays(rays, areas); })) areas.clear();
  const Answers expected = answers_of_the_oracle(mesh, rays);

  const Bvh tree = build(mesh, choice);
  const auto defect = find_defect(tree, triangle_bounds(mesh));
  require(!defect, defect.value_or(""));
  for (size_t i = 0; i < rays.size(); ++i)
    require(same_bits(intersect(tree, mesh, rays[i]), expected.hits[i]), "binary tree, ray " + std::to_string(i));
  for (const Isa isa : supported_isas()) {
    WideOptions options;
    options.isa = isa;
    options.max_leaf_size = 1 + choice % 8;
    compare(std::string("wide tree, ") + name(isa), WideBvh(tree, mesh, options), rays, expected);
  }
  Reader settings(bytes);
  accepts([&] { compare_accelerators(settings, mesh, areas, rays, expected); });
}

}  // namespace raygrain::fuzz

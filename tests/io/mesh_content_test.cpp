// What files may hold besides plain triangles: groups, polygons, lines, points, transforms, odd but right writing.
#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "io/mesh_polygons.h"
#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;

TriangleMesh load_bytes(const std::string& ending, const std::string& bytes, LoadReport* report = nullptr) {
  const test::TemporaryFolder folder;
  test::put_file(folder.file("a" + ending), bytes);
  return load_mesh(folder.file("a" + ending), {}, report);
}

const std::string kObjVertices = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\n";

TEST(ObjContent, FacesKeepTheirOrderAcrossObjectsGroupsAndMaterials) {
  const TriangleMesh mesh =
      load_bytes(".obj", "mtllib none.mtl\no one\n" + kObjVertices +
                             "usemtl red\nf 1 2 3\ng left right\nusemtl blue\nf 3 4 1\ns 1\nusemtl red\n"
                             "f 1 2 5\no two\nusemtl blue\ng\nf 2 3 5\ns off\nusemtl red\nf 3 4 5\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 3, 0}, {0, 1, 4}, {1, 2, 4}, {2, 3, 4}}));
}

TEST(ObjContent, CornersInAllNotations) {
  const TriangleMesh mesh =
      load_bytes(".obj", "vt 0 0\nvn 0 0 1\n" + kObjVertices +
                             "f 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 2/1/1 3/1/1\nf -5 -4/-1 -3/-1/-1\n"
                             "f\t1  2 \\\n 3\nf 6 1 2 # below\nv 7 7 7\nf -1 1 2\n");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {0, 1, 2}, {5, 0, 1}, {5, 0, 1}}));
}

TEST(ObjContent, PolygonsLinesAndPoints) {
  LoadReport report;
  const TriangleMesh mesh =
      load_bytes(".obj", kObjVertices + "f 1 2 3 4\nl 1 2 3\np 1 2\nf 1 2\nf 3\nf 1 5 2\n", &report);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 4, 1}}));
  EXPECT_EQ(report.dropped_lines, 3u);
  EXPECT_EQ(report.dropped_points, 3u);
}

TEST(ObjContent, WindowsLinesColoursAndWeights) {
  const TriangleMesh mesh = load_bytes(
      ".obj", "\xef\xbb\xbf# text\r\nv 0 0 0 1.0\r\nv 1 0 0 0.5 0.5 0.5\r\nv 0 1e0 +0\r\n\r\nf 1 2 3\r\nf 3 2 1");
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {2, 1, 0}}));
  EXPECT_EQ(mesh.vertices[2], (Vec3{0, 1, 0}));
}

TEST(PlyContent, OtherElementsTypesAndOrders) {
  LoadReport report;
  const TriangleMesh mesh = load_bytes(".ply",
                                       "ply\r\nformat ascii 1.0\r\nobj_info nothing\r\nelement camera 1\r\n"
                                       "property list uchar float view\r\nproperty int id\r\nelement face 4\r\n"
                                       "property uchar red\r\nproperty list uint8 uint16 vertex_index\r\n"
                                       "property list uchar float texcoord\r\nelement vertex 4\r\n"
                                       "property double z\r\nproperty uchar red\r\nproperty int16 y\r\n"
                                       "property float32 x\r\nelement edge 1\r\nproperty int vertex1\r\n"
                                       "property int vertex2\r\nelement nothing 5\r\nend_header\r\n"
                                       "2 0.5 0.5 7\r\n9 4 0 1 2 3 0\r\n9 2 0 1 0\r\n9 1 0 1 0.5\r\n9 3 3 2 1 0\r\n"
                                       "0.1 255 0 0\r\n0 255 0 1\r\n0 255 1 1\r\n0 255 1 0\r\n0 1\r\n",
                                       &report);
  EXPECT_EQ(mesh.triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
  EXPECT_TRUE(test::same_bits(mesh.vertices, {{0, 0, 0.1f}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
  EXPECT_EQ(report.dropped_lines, 2u);
  EXPECT_EQ(report.dropped_points, 1u);
}

TEST(PlyContent, DoublesAreRoundedOnce) {
  // Halfway between two floats, and a little more: through float twice both would go to the even one.
  const TriangleMesh mesh = load_bytes(".ply",
                                       "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
                                       "property double z\nelement face 1\nproperty list uchar int vertex_indices\n"
                                       "end_header\n1.000000059604644775390625 1.0000000596046447753906251 0\n1 0 0\n"
                                       "0 1 0\n3 0 1 2\n");
  EXPECT_EQ(mesh.vertices[0].x, 1.0f);
  EXPECT_EQ(mesh.vertices[0].y, 1.0f + 0x1p-23f);
}

TEST(StlContent, SeveralSolidsFollowEachOther) {
  const auto solid = [](const std::string& name, int x) {
    const std::string at = std::to_string(x);
    return "SOLID " + name + "\nFacet Normal nan 0 0\nouter loop\nvertex " + at + " 0 0\nvertex " + at +
           " 1 0\n vertex " + at + " 0 1\nendloop\nendfacet\nendsolid " + name + "\n";
  };
  const TriangleMesh mesh =
      load_bytes(".stl", solid("b c", 3) + solid("", 1) + "solid empty\nendsolid\n" + solid("a", 2));
  ASSERT_EQ(mesh.triangle_count(), 3u);
  EXPECT_EQ(mesh.vertex(0, 0).x, 3);
  EXPECT_EQ(mesh.vertex(1, 0).x, 1);
  EXPECT_EQ(mesh.vertex(2, 0).x, 2);
}

TEST(StlContent, RepeatedCornersAreOneVertex) {
  const TriangleMesh quad{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
  for (const test::MeshFile& file : test::mesh_files(quad)) {
    SCOPED_TRACE(file.name);
    const TriangleMesh mesh = load_bytes(file.ending, file.bytes);
    EXPECT_EQ(mesh.vertices.size(), 4u);
    EXPECT_EQ(mesh.triangles, quad.triangles);
  }
}

TEST(GltfContent, NodeTransformsAreApplied) {
  const TriangleMesh mesh = test::small_mesh();
  // A node that moves and scales, with a child that turns by 90 degrees around z; then the mesh as it is.
  const TriangleMesh loaded = load_bytes(
      ".gltf", test::gltf_bytes(mesh, R"("nodes":[{"translation":[10,20,30],"scale":[2,2,2],"children":[1]},)"
                                      R"({"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,0,0,0,1]},{"mesh":0}],)"
                                      R"("scenes":[{"nodes":[0,2]}])"));
  ASSERT_EQ(loaded.triangle_count(), 2 * mesh.triangle_count());
  const std::vector<Vec3> before = test::corner_positions(mesh), after = test::corner_positions(loaded);
  std::vector<Vec3> expected;
  for (const Vec3& p : before)
    expected.push_back(to_float(
        {10 - 2 * static_cast<double>(p.y), 20 + 2 * static_cast<double>(p.x), 30 + 2 * static_cast<double>(p.z)}));
  expected.insert(expected.end(), before.begin(), before.end());
  EXPECT_TRUE(test::same_bits(after, expected));
}

TEST(GltfContent, PrimitivesAndNodesKeepTheFilesOrder) {
  const TriangleMesh mesh = test::small_mesh();
  std::string bytes = test::gltf_bytes(mesh, test::kPlainNode);
  const std::string one = R"({"attributes":{"POSITION":1},"indices":0})";
  const std::string several = one + R"(,{"attributes":{"POSITION":1},"indices":0,"mode":0},)" +
                              R"({"attributes":{"POSITION":1},"indices":0,"mode":5,"material":1},)" +
                              R"({"attributes":{"POSITION":1},"mode":1},)" + one;
  bytes.replace(bytes.find(one), one.size(), several);
  bytes.insert(bytes.size() - 1, R"(,"materials":[{"name":"a"},{"name":"b"}])");
  LoadReport report;
  const TriangleMesh loaded = load_bytes(".gltf", bytes, &report);
  const std::vector<Vec3> once = test::corner_positions(mesh), all = test::corner_positions(loaded);
  ASSERT_EQ(loaded.triangle_count(), 3u + 7u + 3u);  // a strip of nine corners between two lists
  EXPECT_TRUE(test::same_bits({all.begin(), all.begin() + 9}, once));
  EXPECT_TRUE(test::same_bits({all.end() - 9, all.end()}, once));
  EXPECT_EQ(report.dropped_points, 9u);
  EXPECT_EQ(report.dropped_lines, 2u);
}

TEST(OtherFormats, GoThroughAssimp) {
  const TriangleMesh mesh = load_bytes(".off", "OFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n");
  EXPECT_EQ(mesh.triangle_count(), 3u);
  EXPECT_TRUE(assimp_knows("fbx"));
  EXPECT_FALSE(assimp_knows("csv"));
  EXPECT_NE(assimp_endings().find("gltf, "), std::string::npos);
}

// Assimp as an oracle: another reader of the same files must see the same triangles in the same order.
TEST(OtherReaders, AssimpAgreesOnOurFormats) {
  const test::TemporaryFolder folder;
  TriangleMesh mesh;
  for (int i = 0; i < 60; ++i)
    mesh.vertices.push_back(
        {static_cast<float>(i % 7) * 0.37f, static_cast<float>(i % 11) * -1.13f, static_cast<float>(i)});
  for (uint32_t i = 0; i + 2 < 60; ++i) mesh.triangles.push_back({i, i + 1, i + 2});
  for (const test::MeshFile& file : test::mesh_files(mesh)) {
    if (!file.is_read_here) continue;
    SCOPED_TRACE(file.name);
    const std::string path = folder.file(file.name + file.ending);
    test::put_file(path, file.bytes);
    const TriangleMesh ours = load_mesh(path), theirs = triangulated(import_with_assimp(path), path);
    ASSERT_EQ(ours.triangle_count(), theirs.triangle_count());
    const std::vector<Vec3> a = test::corner_positions(ours), b = test::corner_positions(theirs);
    for (size_t i = 0; i < a.size(); ++i)
      EXPECT_LE(length(to_double(a[i]) - to_double(b[i])), 1e-6 * length(to_double(a[i])) + 1e-6) << "corner " << i;
  }
}

}  // namespace
}  // namespace raygrain

// What is written is what is read, bit by bit, in every format and in both kinds of import.
#include <gtest/gtest.h>

#include "raygrain/io.h"

#include "mesh_files.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using test::corner_positions;
using test::same_bits;

LoadOptions isolated() {
  LoadOptions options;
  options.isolation = Isolation::kChildProcess;
  return options;
}

TEST(MeshRoundTrip, ForeignFilesOfEveryFormat) {
  const test::TemporaryFolder folder;
  for (uint64_t seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    const TriangleMesh mesh = test::random_mesh(seed * 10, seed);
    for (const test::MeshFile& file : test::mesh_files(mesh)) {
      SCOPED_TRACE(file.name);
      const std::string path = folder.file(file.name + file.ending);
      test::put_file(path, file.bytes);
      const TriangleMesh here = load_mesh(path), apart = load_mesh(path, isolated());
      EXPECT_TRUE(same_bits(corner_positions(here), corner_positions(mesh)));
      EXPECT_TRUE(same_bits(here.vertices, apart.vertices));
      EXPECT_EQ(here.triangles, apart.triangles);
      if (file.ending == ".obj" || file.ending == ".ply") {
        EXPECT_TRUE(same_bits(here.vertices, mesh.vertices));
        EXPECT_EQ(here.triangles, mesh.triangles);
      }
    }
  }
}

TEST(MeshRoundTrip, OwnFiles) {
  const test::TemporaryFolder folder;
  std::vector<TriangleMesh> meshes;
  for (const test::NamedMesh& named : test::mesh_families(1)) meshes.push_back(named.mesh);
  for (uint64_t seed = 1; seed <= 5; ++seed) meshes.push_back(test::random_mesh(2000, seed));
  for (size_t i = 0; i < meshes.size(); ++i) {
    if (meshes[i].triangles.empty()) continue;
    SCOPED_TRACE("mesh " + std::to_string(i));
    for (const std::string name : {"a.obj", "a.ply"}) {
      save_mesh(meshes[i], folder.file(name));
      const TriangleMesh loaded = load_mesh(folder.file(name));
      EXPECT_TRUE(same_bits(loaded.vertices, meshes[i].vertices)) << name;
      EXPECT_EQ(loaded.triangles, meshes[i].triangles) << name;
    }
  }
  EXPECT_EQ(test::file_names(folder.path()), (std::vector<std::string>{"a.obj", "a.ply"}));
}

TEST(MeshRoundTrip, SavingRefusesWhatItCannotKeep) {
  const test::TemporaryFolder folder;
  const auto code = [&](const TriangleMesh& mesh, const std::string& path) {
    return test::error_of([&] { save_mesh(mesh, path); }).code;
  };
  TriangleMesh mesh = test::small_mesh();
  EXPECT_EQ(code(mesh, folder.file("a.stl")), ErrorCode::kUnsupported);
  EXPECT_EQ(code(mesh, folder.file("a")), ErrorCode::kUnsupported);
  EXPECT_EQ(code(mesh, folder.file("none/a.ply")), ErrorCode::kUnwritable);
  mesh.triangles[0][1] = 99;
  EXPECT_EQ(code(mesh, folder.file("a.ply")), ErrorCode::kBadMesh);
  EXPECT_TRUE(test::file_names(folder.path()).empty());
}

TEST(MeshRoundTrip, EndingsInAnyCase) {
  const test::TemporaryFolder folder;
  for (const test::MeshFile& file : test::mesh_files(test::small_mesh())) {
    std::string ending = file.ending;
    for (char& symbol : ending) symbol = static_cast<char>(symbol == '.' ? symbol : symbol - 32);
    test::put_file(folder.file("A" + ending), file.bytes);
    EXPECT_EQ(load_mesh(folder.file("A" + ending)).triangle_count(), 3u) << ending;
  }
}

}  // namespace
}  // namespace raygrain

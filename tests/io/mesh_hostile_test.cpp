// Bad files end as an Error that names the file, or as a valid mesh; never as a crash, a hang or a silent loss.
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "raygrain/io.h"

#include "base/random.h"
#include "io/isolation.h"
#include "mesh_files.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain {
namespace {

enum class Outcome { kMesh, kError };

class HostileMesh : public testing::Test {
 protected:
  /// Files that Assimp reads go to the child; our own readers must stand in this very process.
  Outcome load(const test::MeshFile& file, const std::string& bytes) {
    const std::string path = folder_.file("hostile" + file.ending);
    test::put_file(path, bytes);
    LoadOptions options;
    options.isolation = file.is_read_here ? Isolation::kNone : Isolation::kChildProcess;
    options.memory_limit = uint64_t{1} << 30;
    options.time_limit = 10;
    try {
      const TriangleMesh mesh = load_mesh(path, options);
      EXPECT_GT(mesh.triangle_count(), 0u);
      EXPECT_NO_THROW(validate(mesh, path));
      return Outcome::kMesh;
    } catch (const Error& error) {
      EXPECT_EQ(error.where.find(path), 0u) << error.what();
      EXPECT_FALSE(error.message.empty());
      return Outcome::kError;
    }
  }

  /// All beginnings of a file that is not read here, in one child: how many were taken for a mesh. A crash would hide
  /// the others, so then each gets its own.
  size_t count_accepted_beginnings(const test::MeshFile& file) {
    const std::string path = folder_.file("hostile" + file.ending);
    LoadReport counts;
    try {
      import_in_child(path, {}, counts, [&](LoadReport& report) {
        for (size_t size = 0; size < file.bytes.size(); ++size) {
          test::put_file(path, file.bytes.substr(0, size));
          try {
            validate(load_mesh(path), path);
            ++report.dropped_points;
          } catch (const Error&) {
          }
        }
        return TriangleMesh();
      });
    } catch (const Error&) {
      for (size_t size = 0; size < file.bytes.size(); ++size)
        counts.dropped_points += load(file, file.bytes.substr(0, size)) == Outcome::kMesh;
    }
    return counts.dropped_points;
  }

  test::TemporaryFolder folder_;
};

TEST_F(HostileMesh, TruncatedAtEveryByte) {
  for (const test::MeshFile& file : test::mesh_files(test::small_mesh())) {
    SCOPED_TRACE(file.name);
    ASSERT_EQ(load(file, file.bytes), Outcome::kMesh);
    if (!file.is_read_here) {
      EXPECT_EQ(count_accepted_beginnings(file), 0u);
      continue;
    }
    const size_t newline = file.bytes.back() == '\n' && file.name.find("text") != std::string::npos ? 1 : 0;
    for (size_t size = 0; size < file.bytes.size() - newline; ++size) {
      const Outcome outcome = load(file, file.bytes.substr(0, size));
      const bool can_tell = file.name != "obj";  // OBJ has no end that could be missing
      EXPECT_TRUE(outcome == Outcome::kError || !can_tell) << size << " of " << file.bytes.size() << " bytes";
    }
  }
}

TEST_F(HostileMesh, FlippedBytes) {
  for (const test::MeshFile& file : test::mesh_files(test::small_mesh())) {
    SCOPED_TRACE(file.name);
    for (uint64_t seed = 0; seed < (file.is_read_here ? test::seed_count(1000) : 40); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      std::string bytes = file.bytes;
      for (uint64_t i = 0; i <= seed % 4; ++i) bytes[random.below(bytes.size())] = static_cast<char>(random.next());
      load(file, bytes);
    }
  }
}

TEST_F(HostileMesh, RandomBytesAndRandomTails) {
  for (const test::MeshFile& file : test::mesh_files(test::small_mesh())) {
    SCOPED_TRACE(file.name);
    for (uint64_t seed = 0; seed < (file.is_read_here ? 300u : 15u); ++seed) {
      SCOPED_TRACE("seed " + std::to_string(seed));
      Random random(seed);
      std::string bytes = file.bytes.substr(0, seed % 2 * random.below(file.bytes.size()));
      for (uint64_t i = random.below(500); i > 0; --i) bytes += static_cast<char>(random.next());
      load(file, bytes);
    }
  }
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

struct Row {
  const char* name;
  const char* ending;
  std::string bytes;
  ErrorCode code;
  const char* part;  // of the message
};

const std::string kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
const std::string kPly =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
    "property list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
const std::string kStl =
    "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";
const std::string kBinaryPly = replaced(kPly, "ascii", "binary_little_endian");

std::vector<Row> obj_rows() {
  using enum ErrorCode;
  return {{"empty", ".obj", "", kMalformed, "empty"},
          {"no faces", ".obj", kObj, kBadMesh, "no triangles"},
          {"garbage", ".obj", "this is not a mesh\n", kBadMesh, "no triangles"},
          {"binary", ".obj", std::string("v 0 0 0\n\0\1\2\3", 12), kMalformed, "not a text file"},
          {"only lines", ".obj", kObj + "l 1 2 3\np 1\n", kBadMesh, "only 2 lines and 1 point"},
          {"index too large", ".obj", kObj + "f 1 2 4\n", kBadMesh, "vertex 4 of 3"},
          {"index zero", ".obj", kObj + "f 0 1 2\n", kBadMesh, "vertex 0 of 3"},
          {"index too negative", ".obj", kObj + "f -4 1 2\n", kBadMesh, "vertex -4 of 3"},
          {"huge index", ".obj", kObj + "f 1 2 99999999999999999999\n", kBadMesh, "vertex 99999999999999999999"},
          {"32-bit wrap", ".obj", kObj + "f 1 2 4294967297\n", kBadMesh, "vertex 4294967297"},
          {"bad corner", ".obj", kObj + "f 1 2 x\n", kMalformed, "\"x\" is not a corner"},
          {"bad separator", ".obj", kObj + "f 1 2 3;4\n", kMalformed, "is not a corner"},
          {"no corners", ".obj", kObj + "f\n", kMalformed, "no corners"},
          {"nan", ".obj", kObj + "v 0 nan 0\nf 1 2 3\n", kBadMesh, "vertex 3 is not finite"},
          {"infinite", ".obj", kObj + "v 0 -inf 0\nf 1 2 3\n", kBadMesh, "vertex 3 is not finite"},
          {"too large for float", ".obj", "v 0 1e39 0\n" + kObj + "f 1 2 3\n", kMalformed, "\"1e39\""},
          {"bad number", ".obj", "v 0 1,5 0\n" + kObj + "f 1 2 3\n", kMalformed, "\"1,5\""},
          {"short vertex", ".obj", "v 0 1\n" + kObj + "f 1 2 3\n", kMalformed, "fewer than three"}};
}

std::vector<Row> ply_rows() {
  using enum ErrorCode;
  return {
      {"empty", ".ply", "", kMalformed, "empty"},
      {"not ply", ".ply", "plain\n", kMalformed, "begin with \"ply\""},
      {"no header end", ".ply", "ply\nformat ascii 1.0\n", kMalformed, "no end"},
      {"no format", ".ply", "ply\nelement vertex 0\nend_header\n", kMalformed, "no format"},
      {"new version", ".ply", replaced(kPly, "1.0", "2.0"), kUnsupported, "version"},
      {"new format", ".ply", replaced(kPly, "ascii", "zipped"), kUnsupported, "format"},
      {"unknown type", ".ply", replaced(kPly, "float x", "half x"), kUnsupported, "type"},
      {"bad count", ".ply", replaced(kPly, "vertex 3", "vertex -3"), kMalformed, "number of elements"},
      {"count beyond 64 bits", ".ply", replaced(kPly, "vertex 3", "vertex 99999999999999999999"), kMalformed,
       "number of elements"},
      {"huge vertex count", ".ply", replaced(kPly, "vertex 3", "vertex 18446744073709551615"), kMalformed, ""},
      {"huge face count", ".ply", replaced(kPly, "face 1", "face 9223372036854775807"), kMalformed, "ends before"},
      {"huge binary counts", ".ply", replaced(kBinaryPly, "vertex 3", "vertex 4000000000"), kMalformed, "ends before"},
      {"no x", ".ply", replaced(kPly, "float x", "float w"), kMalformed, "\"x\""},
      {"two y", ".ply", replaced(kPly, "float x", "float y"), kMalformed, "\"x\""},
      {"no list", ".ply", replaced(kPly, "vertex_indices", "corners"), kMalformed, "vertex_indices"},
      {"float length", ".ply", replaced(kPly, "uchar", "float"), kMalformed, "length"},
      {"float index", ".ply", replaced(kPly, "list uchar int", "list uchar float"), kMalformed, "integers"},
      {"property before element", ".ply", "ply\nformat ascii 1.0\nproperty int a\nend_header\n", kMalformed,
       "before the first element"},
      {"fewer faces", ".ply", replaced(kPly, "face 1", "face 2"), kMalformed, "ends before"},
      {"more faces", ".ply", kPly + "3 0 1 2\n", kMalformed, "more data"},
      {"index too large", ".ply", replaced(kPly, "3 0 1 2", "3 0 1 3"), kBadMesh, "face 0 uses vertex 3 of 3"},
      {"negative index", ".ply", replaced(kPly, "3 0 1 2", "3 0 1 -1"), kBadMesh, "vertex -1 of 3"},
      {"negative length", ".ply", replaced(replaced(kPly, "uchar", "char"), "3 0 1 2", "-3 0 1 2"), kMalformed,
       "negative length"},
      {"huge length", ".ply", replaced(replaced(kPly, "uchar", "uint"), "3 0 1 2", "4294967295 0 1 2"), kMalformed,
       "ends before"},
      {"nan", ".ply", replaced(kPly, "1 0 0", "1 nan 0"), kBadMesh, "vertex 1 is not finite"},
      {"word", ".ply", replaced(kPly, "1 0 0", "1 one 0"), kMalformed, "\"one\""},
      {"no faces", ".ply",
       "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
       "property float z\nend_header\n",
       kBadMesh, "no triangles"},
      {"strips", ".ply", replaced(kPly, "element face", "element tristrips"), kUnsupported, "strips"}};
}

std::vector<Row> other_rows() {
  using enum ErrorCode;
  const std::string gltf = test::gltf_bytes(test::small_mesh(), test::kPlainNode);
  TriangleMesh out_of_range = test::small_mesh();
  out_of_range.triangles[1][2] = 7;
  const std::string deep = std::string(3000000, '[');
  std::string binary_stl(84, ' ');
  return {{"stl empty", ".stl", "", kMalformed, "empty"},
          {"stl garbage", ".stl", "garbage", kMalformed, "neither"},
          {"stl long garbage", ".stl", std::string(500, 'g'), kMalformed, "triangles need"},
          {"stl no facets", ".stl", "solid a\nendsolid a\n", kBadMesh, "no triangles"},
          {"stl huge count", ".stl", replaced(binary_stl, "    ", "\xff\xff\xff\xff"), kMalformed, "triangles need"},
          {"stl two corners", ".stl", replaced(kStl, "vertex 0 1 0\n", ""), kMalformed, "fewer than three"},
          {"stl nan", ".stl", replaced(kStl, "vertex 1 0", "vertex 1 nan"), kBadMesh, "vertex 1 is not finite"},
          {"stl word", ".stl", replaced(kStl, "vertex 1 0", "vertex 1 one"), kMalformed, "\"one\""},
          {"stl keyword", ".stl", replaced(kStl, "outer", "inner"), kMalformed, "expected \"outer\""},
          {"stl cut", ".stl", replaced(kStl, "endsolid\n", ""), kMalformed, "ends where \"facet\""},
          {"gltf empty", ".gltf", "", kMalformed, "empty"},
          {"gltf garbage", ".gltf", "{\"asset\": 7", kMalformed, ""},
          {"gltf deep", ".gltf", R"({"asset":{"version":"2.0"},"extras":)" + deep, kMalformed, ""},
          {"gltf index", ".gltf", test::gltf_bytes(out_of_range, test::kPlainNode), kBadMesh, "1 faces use vertices"},
          {"gltf no index in range", ".gltf", replaced(gltf, "\"count\":4", "\"count\":2"), kMalformed, "no faces"},
          {"gltf huge count", ".gltf", replaced(gltf, "\"count\":9", "\"count\":4000000000"), kMalformed, ""},
          {"gltf missing buffer", ".gltf", replaced(gltf, "data:application", "none:"), kMalformed, ""},
          {"gltf recursion", ".gltf", replaced(gltf, "{\"mesh\":0}", "{\"mesh\":0,\"children\":[0]}"), kMalformed, ""},
          {"gltf mesh number", ".gltf", replaced(gltf, "{\"mesh\":0}", "{\"mesh\":5}"), kMalformed, ""},
          {"gltf nan matrix", ".gltf", replaced(gltf, "{\"mesh\":0}", "{\"mesh\":0,\"scale\":[1e38,1e38,1e38]}"),
           kBadMesh, "not finite"},
          {"glb garbage", ".glb", "glTF\2garbage", kMalformed, ""},
          {"unknown ending", ".mesh3d", "text", kUnsupported, "unknown mesh format \".mesh3d\""},
          {"no ending", "", "text", kUnsupported, "no ending"}};
}

TEST(HostileMeshTable, EachRowIsTheRightError) {
  const test::TemporaryFolder folder;
  std::vector<Row> rows = obj_rows();
  for (const Row& row : ply_rows()) rows.push_back(row);
  for (const Row& row : other_rows()) rows.push_back(row);
  for (const Row& row : rows) {
    SCOPED_TRACE(std::string(row.ending) + ": " + row.name);
    const std::string path = folder.file(std::string("a") + row.ending);
    test::put_file(path, row.bytes);
    LoadOptions options;
    options.isolation = Isolation::kChildProcess;
    options.memory_limit = uint64_t{1} << 30;
    options.time_limit = 10;
    const Error error = test::error_of([&] { load_mesh(path, options); });
    EXPECT_STREQ(name(error.code), name(row.code)) << error.what();
    EXPECT_EQ(error.where.find(path), 0u) << error.what();
    EXPECT_NE(error.message.find(row.part), std::string::npos) << error.what();
  }
}

TEST(HostileMeshTable, TextErrorsNameTheLine) {
  const test::TemporaryFolder folder;
  const auto where = [&](const std::string& name, const std::string& bytes) {
    test::put_file(folder.file(name), bytes);
    return test::error_of([&] { load_mesh(folder.file(name)); }).where;
  };
  EXPECT_EQ(where("a.obj", kObj + "\nf 1 \\\n 2 x\n"), folder.file("a.obj:5"));
  EXPECT_EQ(where("a.obj", kObj + "f 1 2 9\nf 1 2 3\n"), folder.file("a.obj:4"));
  EXPECT_EQ(where("a.ply", replaced(kPly, "1 0 0", "1 0 z")), folder.file("a.ply:11"));
  EXPECT_EQ(where("a.ply", replaced(kPly, "element face", "elephant face")), folder.file("a.ply:7"));
  EXPECT_EQ(where("a.stl", replaced(kStl, "1 0 0", "1 0 z")), folder.file("a.stl:5"));
}

TEST(HostileMeshTable, WhatIsNoFile) {
  const test::TemporaryFolder folder;
  test::put_file(folder.file("file"), "");
  std::filesystem::create_directory(folder.file("folder.obj"));
  std::filesystem::create_symlink("nowhere", folder.file("dangling.obj"));
  std::filesystem::create_symlink("loop.obj", folder.file("loop.obj"));
  ASSERT_EQ(mkfifo(folder.file("pipe.obj").c_str(), 0600), 0);
  const auto code = [&](const std::string& name) { return test::error_of([&] { load_mesh(folder.file(name)); }).code; };
  EXPECT_EQ(code("none.obj"), ErrorCode::kNotFound);
  EXPECT_EQ(code("none/none.glb"), ErrorCode::kNotFound);
  EXPECT_EQ(code("file/none.obj"), ErrorCode::kNotFound);
  EXPECT_EQ(code("dangling.obj"), ErrorCode::kNotFound);
  EXPECT_EQ(code("loop.obj"), ErrorCode::kUnreadable);
  EXPECT_EQ(code("folder.obj"), ErrorCode::kUnreadable);
  EXPECT_EQ(code("pipe.obj"), ErrorCode::kUnreadable);
  if (geteuid() == 0) return;  // root may read everything
  test::put_file(folder.file("locked.obj"), kObj);
  chmod(folder.file("locked.obj").c_str(), 0);
  EXPECT_EQ(code("locked.obj"), ErrorCode::kUnreadable);
}

}  // namespace
}  // namespace raygrain

// Everything that a user can get wrong: one line that says where, what, and how to mend it; the right exit code;
// nothing half-written.
#include "cli/bad_input.h"

#include <cstdint>
#include <cstring>
#include <functional>

#include <gtest/gtest.h>

namespace raygrain::test {
namespace {

constexpr int kData = 1, kUsage = 2;

template <class... Values>
std::string bytes_of(Values... values) {
  std::string bytes;
  (bytes.append(reinterpret_cast<const char*>(&values), sizeof values), ...);
  return bytes;
}

std::string ply_header(const std::string& vertices, const std::string& faces) {
  return "ply\nformat binary_little_endian 1.0\nelement vertex " + vertices +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nend_header\n";
}

std::string plane_area(const std::string& fields) {
  return R"({"format": "raygrain-areas", "version": 1, "areas": [{"name": "bad", "plane": {)" + fields + "}}]}";
}

std::string point_area(const std::string& fields) {
  return R"({"format": "raygrain-areas", "version": 1, "areas": [{"name": "bad", "point": {)" + fields + "}}]}";
}

const char kGoodPlane[] =
    R"("center": [0, 0, 0], "direction": [0, 0, 1], "half_width": 1, "half_height": 1, "depth": 9)";

std::vector<std::string> compare_with(std::vector<std::string> more) {
  std::vector<std::string> arguments{"compare", "SCENE", "--rays", "50", "--out", "OUT"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

BadInput bad_scene(const std::string& name, const std::string& file_name, const std::string& content,
                   const std::string& expected) {
  return {name, compare_with({"--sun", "0,0,1"}), kData, expected, file_name, content};
}

BadInput bad_areas(const std::string& name, const std::string& areas, const std::string& expected) {
  BadInput row{name, compare_with({"--areas", "AREAS"}), kData, expected};
  row.areas = areas;
  return row;
}

BadInput bad_rays(const std::string& name, const std::string& rays, const std::string& expected) {
  BadInput row{name, {"trace", "SCENE", "--rays", "RAYS", "-o", "OUT"}, kData, expected};
  row.rays = rays;
  return row;
}

BadInput limited(BadInput row, RunOptions options) {
  row.options = std::move(options);
  return row;
}

std::vector<BadInput> bad_scenes() {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const std::string triangle = bytes_of(uint8_t{3}, 0, 1, 2), wrong_triangle = bytes_of(uint8_t{3}, 0, 1, 99);
  const std::string vertices = bytes_of(0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f);
  std::string noise;
  for (unsigned i = 0; i < 2000; ++i) noise += static_cast<char>((i * 2654435761u) >> 13);
  return {
      {"missing file", {"compare", "/no/such.obj", "--sun", "0,0,1", "--out", "OUT"}, kData, "/no/such.obj"},
      {"folder as scene", {"scene", "info", "/"}, kData, "/"},
      bad_scene("empty file", "scene.obj", "", "SCENE"),
      bad_scene("empty ply", "scene.ply", "", "SCENE"),
      bad_scene("no triangles", "scene.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\n", "SCENE"),
      bad_scene("only lines", "scene.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "SCENE"),
      bad_scene("text garbage", "scene.obj", "\nthis is no mesh at all\n\x01\x02\n",
                "SCENE:2: \"this is no mesh at all\""),
      bad_scene("one line", "scene.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n", "only 1 line and 0 points"),
      bad_scene("garbage ply", "scene.ply", "this is no mesh at all\n", "SCENE"),
      bad_scene("binary noise", "scene.glb", noise, "SCENE"),
      bad_scene("truncated ply", "scene.ply", ply_header("1000", "500") + vertices, "SCENE"),
      bad_scene("hostile ply", "scene.ply", ply_header("4294967295", "4294967295") + vertices, "SCENE"),
      bad_scene("hostile stl", "scene.stl", std::string(80, ' ') + bytes_of(0xffffffffu) + "xx", "SCENE"),
      bad_scene("hostile glb", "scene.glb", bytes_of(0x46546c67u, 2u, 0xffffffffu, 0xfffffff0u, 0x4e4f534au) + "{",
                "SCENE"),
      bad_scene("index out of range", "scene.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 99\n", "SCENE"),
      bad_scene("index out of range ply", "scene.ply", ply_header("3", "1") + vertices + wrong_triangle, "SCENE"),
      bad_scene("nan vertex", "scene.obj", "v 0 nan 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n", "SCENE"),
      bad_scene("nan vertex ply", "scene.ply",
                ply_header("3", "1") + bytes_of(nan) + vertices.substr(sizeof nan) + triangle, "SCENE"),
      bad_scene("unknown format", "scene.xyz", "1 2 3\n", "SCENE"),
      bad_scene("json that ends early", "scene.json", R"({"format": "raygrain-scene", "version": 1, )",
                "scene.json:1:"),
      bad_scene("json of another kind", "scene.json", "[1, 2, 3]", "scene.json"),
      bad_scene("json of a later version", "scene.json", R"({"format": "raygrain-scene", "version": 99})", "version"),
      {"unknown procedural kind", {"compare", "procedural:castle", "--out", "OUT"}, kUsage, "castle"},
      {"bad procedural size", {"compare", "procedural:city?size=big", "--out", "OUT"}, kUsage, "big"},
      {"unknown procedural parameter", {"compare", "procedural:city?height=3", "--out", "OUT"}, kUsage, "height"},
  };
}

std::vector<BadInput> bad_areas_and_rays() {
  const std::string eye = R"("eye": [0, 0, 0], "forward": [0, 0, 1], )";
  return {
      bad_areas("areas file garbage", "no json", "AREAS"),
      bad_areas("areas file without areas", R"({"format": "raygrain-areas", "version": 1})", "AREAS"),
      bad_areas(
          "zero size",
          plane_area(R"("center": [0, 0, 0], "direction": [0, 0, 1], "half_width": 0, "half_height": 1, "depth": 9)"),
          ". half_width must"),
      bad_areas(
          "zero direction",
          plane_area(R"("center": [0, 0, 0], "direction": [0, 0, 0], "half_width": 1, "half_height": 1, "depth": 9)"),
          "direction"),
      bad_areas("near beyond far", point_area(eye + R"("fov_x": 60, "fov_y": 60, "near_z": 5, "far_z": 1)"), "near"),
      bad_areas("near equal to far", point_area(eye + R"("fov_x": 60, "fov_y": 60, "near_z": 5, "far_z": 5)"), "near"),
      bad_areas("field of view of 180 degrees",
                point_area(eye + R"("fov_x": 60, "fov_y": 180, "near_z": 1, "far_z": 5)"), "fov_y"),
      bad_areas("unknown key", plane_area(std::string(kGoodPlane) + R"(, "widht": 1)"), "widht"),
      {"missing areas file", compare_with({"--areas", "/no/such.json"}), kData, "/no/such.json"},
      {"missing rays file", {"trace", "SCENE", "--rays", "/no/such.csv", "-o", "OUT"}, kData, "/no/such.csv"},
      bad_rays("empty rays file", "", "RAYS"),
      {"endless device as rays", {"trace", "SCENE", "--rays", "/dev/zero", "-o", "OUT"}, kData, "is a device"},
      {"endless device as areas", compare_with({"--areas", "/dev/urandom"}), kData, "is a device"},
      bad_rays("rays without a header", "0,0,0,0,0,1\n", "RAYS"),
      bad_rays("rays with a bad number", "ox,oy,oz,dx,dy,dz\n0,0,0,0,zero,1\n", "RAYS:2:"),
      bad_rays("rays beyond float", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0,1e60\n", "\"1e60\" is beyond float32 (3.4e38)"),
      bad_rays("rays with a missing number", "ox,oy,oz,dx,dy,dz\n0,0,0,0,0\n", "RAYS:2"),
  };
}

std::vector<BadInput> bad_usage() {
  return {
      {"no command", {}, kUsage, "command"},
      {"empty command", {""}, kUsage, "'': is no command"},
      {"empty command before others", {"", "--raycompare", "SCENE"}, kUsage, "'': is no command"},
      {"unknown command", {"compair", "SCENE"}, kUsage, "Did you mean compare"},
      {"unknown scene command", {"scene", "inform", "SCENE"}, kUsage, "Did you mean info"},
      {"unknown option", compare_with({"--recipe", "SAH+ALL"}), kUsage, "Did you mean --recipes"},
      {"option like none", compare_with({"--bogus"}), kUsage,
       "--bogus: is no option here. See raygrain compare --help"},
      {"option with one dash", compare_with({"-reices", "SAH+ALL"}), kUsage, "Did you mean --recipes"},
      {"missing operand", {"compare"}, kUsage, "SCENE is required"},
      {"empty operand", {"scene", "info", ""}, kUsage, "SCENE: is empty"},
      {"tree to a file named -",
       {"build", "SCENE", "--recipe", "SAH+ALL", "-o", "-"},
       kUsage,
       "--output: needs a file"},
      {"nodes to a file named -",
       {"analyze", "SCENE", "--recipe", "SAH+ALL", "--nodes", "-"},
       kUsage,
       "--nodes: needs a file"},
      {"folder named -", {"compare", "SCENE", "--sun", "0,0,1", "--out", "-"}, kUsage, "--out: needs a file"},
      {"operand too many", {"scene", "info", "SCENE", "SCENE"}, kUsage, "operand too many"},
      {"missing value", {"compare", "SCENE", "--rays"}, kUsage, "--rays"},
      {"bad number", compare_with({"--seed", "1.5"}), kUsage, "--seed"},
      {"negative number", compare_with({"--threads", "-3"}), kUsage, "e.g. --threads 4"},
      {"port too large", {"view", "SCENE", "--port", "70000"}, kUsage, "e.g. --port 8080"},
      {"size given twice", {"scene", "info", "procedural:city?size=3&size=4"}, kUsage, "size is there twice"},
      {"size given twice, once as an option",
       {"scene", "generate", "procedural:city?size=3", "--size", "4", "-o", "OUT.ply"},
       kUsage,
       "--size: is there twice"},
      {"huge number", compare_with({"--seed", "99999999999999999999"}), kUsage, "--seed"},
      {"no rays", {"compare", "SCENE", "--sun", "0,0,1", "--rays", "0", "--out", "OUT"}, kUsage, "--rays"},
      {"no areas", compare_with({}), kUsage, "--sun X,Y,Z"},
      {"zero sun", compare_with({"--sun", "0,0,0"}), kUsage, "--sun"},
      {"two numbers for three", compare_with({"--sun", "1,2"}), kUsage, "--sun"},
      {"four numbers for three", compare_with({"--sun", "1,2,3,4"}), kUsage, "--sun"},
      {"nan sun", compare_with({"--sun", "nan,0,1"}), kUsage, "--sun"},
      {"infinite light", compare_with({"--light", "0,inf,1"}), kUsage, "e.g. --light 0,30,0"},
      {"sun beyond float", compare_with({"--sun", "1e60,0,0"}), kUsage, "--sun: '1e60' is beyond float32 (3.4e38)"},
      {"field of view beyond float", compare_with({"--camera", "0,0,1", "0,0,0", "--fov", "-1e60"}), kUsage,
       "'-1e60' is beyond float32"},
      {"camera of words", compare_with({"--camera", "here", "there"}), kUsage, "e.g. --camera 9,5,9 0,0,0"},
      {"sun and light", compare_with({"--sun", "0,0,1", "--light", "0,0,1"}), kUsage, "--light"},
      {"camera without target", {"compare", "SCENE", "--camera", "0,0,1"}, kUsage, "--camera"},
      {"camera at its target", compare_with({"--camera", "0,0,1", "0,0,1"}), kUsage, "--camera"},
      {"wide camera", compare_with({"--camera", "0,0,1", "0,0,0", "--fov", "180"}), kUsage, "--fov"},
      {"field of view without camera", compare_with({"--sun", "0,0,1", "--fov", "60"}), kUsage, "--fov"},
      {"unknown measure", compare_with({"--sun", "0,0,1", "--recipes", "SEH+ALL"}), kUsage, "SAH"},
      {"unknown orientation", compare_with({"--sun", "0,0,1", "--recipes", "SAH+ALLL"}), kUsage, "ALL"},
      {"unknown builder", compare_with({"--sun", "0,0,1", "--recipes", "SAH+ALL@papers"}), kUsage, "paper"},
      {"recipe for no area", {"build", "SCENE", "--recipe", "PAH+ALL", "-o", "OUT"}, kUsage, "--sun X,Y,Z"},
      {"foreign tree",
       {"analyze", "SCENE", "--recipe", "SAH+ALL", "--whole", "--tree", "SCENE"},
       kData,
       "no raygrain tree"},
      {"missing tree", {"refit", "SCENE", "--tree", "/no/such.rgt", "-o", "OUT.rgt"}, kData, "/no/such.rgt"},
      {"foreign tree to refit", {"refit", "SCENE", "--tree", "SCENE", "-o", "OUT.rgt"}, kData, "no raygrain tree"},
      {"refit to JSON", {"refit", "SCENE", "--tree", "SCENE", "-o", "OUT"}, kUsage, ".rgt"},
      {"tree and quality",
       {"analyze", "SCENE", "--recipe", "SAH+ALL", "--tree", "SCENE", "--quality", "best"},
       kUsage,
       "--tree"},
      {"tree and global recipe",
       {"trace", "SCENE", "--set", "x", "-o", "OUT", "--tree", "SCENE", "--global", "SAH+LSPH"},
       kUsage,
       "--tree"},
      {"unknown traversal", {"trace", "SCENE", "--set", "x", "-o", "OUT", "--traversal", "deep"}, kUsage, "binary"},
      {"recipe missing", {"build", "SCENE", "-o", "OUT"}, kUsage, "--recipe"},
      {"unknown area",
       {"build", "SCENE", "--sun", "0,0,1", "--area", "son", "--recipe", "PAH+ALL", "-o", "OUT"},
       kUsage,
       "sun"},
      {"many areas, none named",
       {"build", "SCENE", "--light", "0.5,0.5,0.5", "--recipe", "PAH+ALL", "-o", "OUT"},
       kUsage,
       "--area"},
      {"trace without rays", {"trace", "SCENE", "-o", "OUT"}, kUsage, "--rays"},
      {"trace with unknown ray set", {"trace", "SCENE", "--set", "sun", "-o", "OUT"}, kUsage, "--set"},
      {"trace with two kinds of rays",
       {"trace", "SCENE", "--rays", "SCENE", "--set", "sun", "-o", "OUT"},
       kUsage,
       "combined with --set"},
      {"format that cannot be written", {"scene", "convert", "SCENE", "-o", "OUT.gltf"}, kUsage, ".gltf"},
  };
}

std::vector<BadInput> bad_outputs() {
  const std::vector<std::string> city{"compare", kSmallScene, "--rays", "50"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> arguments = city;
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  RunOptions small_files, full_output, little_memory, believed_memory;
  small_files.file_size = 1000;
  full_output.standard_output = "/dev/full";
  little_memory.memory = rlim_t{1} << 30;
  believed_memory.memory_left = "60";
  const std::string kMiddleScene = "procedural:terrain?size=450";
  return {
      {"output folder below a file", with({"--out", "SCENE/folder"}), kData, "SCENE/folder"},
      {"output folder where none can be", with({"--out", "/proc/raygrain"}), kData, "/proc/raygrain"},
      {"output folder is a file", with({"--out", "SCENE"}), kData, "SCENE"},
      {"failures where none can be", {"verify", "--rays", "10", "--out", "/proc/raygrain"}, kData, "/proc/raygrain"},
      {"json in no folder", with({"--json", "/no/such/folder/a.json"}), kData, "/no/such/folder/a.json"},
      {"json is a folder", with({"--json", "/"}), kData, "folder"},
      {"tree in no folder",
       {"build", kSmallScene, "--recipe", "SAH+ALL", "-o", "/no/such/folder/a.json"},
       kData,
       "/no/such"},
      {"disk full, files", with({"--out", "OUT"}), kData, "OUT", "scene.obj", kQuad, "", "", small_files},
      {"disk full, json", with({"--json", "/dev/full"}), kData, "/dev/full"},
      {"disk full, table", with({}), kData, "standard output", "scene.obj", kQuad, "", "", full_output},
      {"disk full, help", {"compare", "--help"}, kData, "standard output", "scene.obj", kQuad, "", "", full_output},
      {"disk full, mesh",
       {"scene", "generate", "city", "-o", "OUT.ply"},
       kData,
       "OUT.ply",
       "scene.obj",
       kQuad,
       "",
       "",
       small_files},
      limited({"out of memory", {"compare", kSmallScene, "--rays", "1000000000"}, kData, "memory"}, little_memory),
      limited({"too many rays", {"compare", kSmallScene, "--rays", "1000000000"}, kData, "59.6 GiB"}, believed_memory),
      limited({"too many samples", {"explain", kSmallScene, "--samples", "1000000"}, kData, "--samples"},
              believed_memory),
      limited({"too large to trace", {"trace", kMiddleScene, "--set", "sun", "-o", "OUT"}, kData, "--quality fast"},
              believed_memory),
      limited(
          {"too large to build", {"build", kMiddleScene, "--recipe", "SAH+ALL", "-o", "OUT"}, kData, "GiB are left"},
          believed_memory),
      limited(
          {"too large to view", {"view", kMiddleScene, "--template", "SCENE", "--out", "OUT"}, kData, "GiB are left"},
          believed_memory),
      {"nested folder where none can be", with({"--out", "SCENE/a/b/c"}), kData, "SCENE/a/b/c"},
  };
}

TEST(BadInput, Scenes) {
  for (const BadInput& row : bad_scenes()) check(row);
}

TEST(BadInput, AreasAndRays) {
  for (const BadInput& row : bad_areas_and_rays()) check(row);
}

TEST(BadInput, Usage) {
  for (const BadInput& row : bad_usage()) check(row);
}

TEST(BadInput, Outputs) {
  for (const BadInput& row : bad_outputs()) check(row);
}

}  // namespace
}  // namespace raygrain::test

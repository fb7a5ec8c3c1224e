// A damaged scene.json is an error at most, never a crash.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "base/random.h"
#include "support/shared.h"

namespace raygrain {
namespace {

// Into a fresh file: overwriting one makes some file systems wait for the disk.
void write_fresh(const std::string& path, const std::string& text) {
  std::filesystem::remove(path);
  std::ofstream(path, std::ios::binary) << text;
}

const char* const kWholeScene = R"({"format": "raygrain-scene", "version": 1, "name": "all",
  "meshes": [{"file": "one.ply", "scale": 2, "rotate": {"axis": [0, 1, 0], "degrees": 30}, "translate": [1, 2, 3]}],
  "areas": [{"name": "s", "sun": {"direction": [0.35, -0.8, 0.48]}, "tolerance": 0.01},
            {"name": "p", "plane": {"center": [0, 9, 0], "direction": [0, -1, 0], "up": [0, 0, 1], "half_width": 2, "half_height": 3, "depth": 20}},
            {"name": "e", "point": {"eye": [0, 1, 20], "forward": [0, 0, -1], "fov_x": 90, "fov_y": 60, "near_z": 0.1, "far_z": 50}}],
  "rays": [{"name": "a", "area": "s", "count": 10, "seed": 3, "start": "near", "spread": "angle", "cone_degrees": 2, "jitter_radius": 0.5},
           {"name": "b", "surface": {"rectangle": {"center": [0, 9, 0], "half_u": [1, 0, 0], "half_v": [0, 0, 1]}}, "count": 5},
           {"name": "c", "camera": {"eye": [0, 1, 20], "target": [0, 1, 0], "fov_y": 40, "width": 4, "height": 3}},
           {"name": "d", "rays": [[0, 0, 9, 0, 0, -1], [0, 0, 9, 0, 0, -1, 0.5, null]]}]})";

bool loads_or_throws_error(const std::string& path) {
  try {
    load_scene(path);
    return true;
  } catch (const Error&) {
    return false;
  }
}

class BrokenScene : public testing::Test {
 protected:
  BrokenScene() {
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 20, 40}};
    mesh.triangles = {{0, 1, 2}};
    save_mesh(mesh, folder_.file("one.ply"));
  }

  test::TemporaryFolder folder_;
};

TEST_F(BrokenScene, ChangedBytesAreNeverMoreThanAnError) {
  const std::string good = kWholeScene, path = folder_.file("scene.json");
  write_fresh(path, good);
  ASSERT_NO_THROW(load_scene(path));
  size_t loaded = 0, refused = 0;
  for (uint64_t seed = 1; seed <= 1500; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed);
    std::string text = good;
    if (random.below(4) == 0) text.resize(random.below(text.size()));
    const uint64_t changes = random.below(4);
    for (uint64_t i = 0; i < changes && !text.empty(); ++i) {
      const size_t at = random.below(text.size());
      switch (random.below(4)) {
        case 0:
          text[at] = static_cast<char>(random.below(256));
          break;
        case 1:
          text[at] = "{}[]\",:0-9e."[random.below(12)];
          break;
        case 2:
          text.erase(at, 1 + random.below(9));
          break;
        default:
          text.insert(at, text.substr(random.below(text.size()), 1 + random.below(30)));
      }
    }
    write_fresh(path, text);
    ++(loads_or_throws_error(path) ? loaded : refused);
  }
  EXPECT_GT(loaded, 50u);  // unchanged, or changed where it does not matter
  EXPECT_GT(refused, 500u);
}

TEST_F(BrokenScene, EveryTruncationIsRefused) {
  const std::string good = kWholeScene, path = folder_.file("scene.json");
  for (size_t length = 0; length < good.size(); length += 3) {
    write_fresh(path, good.substr(0, length));
    ASSERT_FALSE(loads_or_throws_error(path)) << length;
  }
}

}  // namespace
}  // namespace raygrain

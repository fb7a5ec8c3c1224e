// Trees in ray space are the same whoever writes them.
#include <cstring>
#include <memory>

#include <gtest/gtest.h>

#include "raygrain/build.h"

#include "support/triangle_soup.h"
#include "trace/frame_memory.h"

namespace raygrain {
namespace {

TEST(FrameTree, ThreadsDecideNoByte) {
  const TriangleMesh mesh = test::triangle_soup(40000, 4);
  const auto corners = std::make_shared<const TriangleCorners>(mesh);
  const RayFrame frame = *parallel_frame(FrameKind::kRotation, {0.3f, -1, 0.2f}, {50, 50, 50});
  std::vector<Bounds> boxes;
  for (const auto& t : mesh.triangles)
    boxes.push_back(frame_bounds(frame, mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]));
  const Bvh binary = build_binned(boxes, {}, {});
  const FrameMemory one = write_frame_tree(frame, binary, corners, {.threads = 1});
  ASSERT_GT(one.leaves, 4000u) << "several threads must share the work";
  for (const unsigned threads : {0u, 2u, 8u}) {
    const FrameMemory several = write_frame_tree(frame, binary, corners, {.threads = threads});
    ASSERT_EQ(several.memory.size(), one.memory.size());
    EXPECT_EQ(std::memcmp(several.memory.data(), one.memory.data(), one.memory.size()), 0) << threads << " threads";
  }
}

}  // namespace
}  // namespace raygrain

// A signal every millisecond, whose handler does not restart system calls: reads, writes and imports go on.
#include <csignal>
#include <filesystem>

#include <gtest/gtest.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "raygrain/build.h"
#include "raygrain/io.h"
#include "raygrain/study.h"

#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain::test {
namespace {

volatile std::sig_atomic_t interruptions = 0;

/// While it lives.
class Interruptions {
 public:
  Interruptions() {
    struct sigaction action {};
    action.sa_handler = [](int) { interruptions = interruptions + 1; };
    ::sigaction(SIGALRM, &action, &before_);
    const itimerval millisecond{{0, 1000}, {0, 1000}};
    ::setitimer(ITIMER_REAL, &millisecond, nullptr);
  }
  ~Interruptions() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    ::sigaction(SIGALRM, &before_, nullptr);
  }
  Interruptions(const Interruptions&) = delete;
  Interruptions& operator=(const Interruptions&) = delete;

 private:
  struct sigaction before_ {};
};

TriangleMesh large_mesh() {
  return generate_scene({.kind = "terrain", .size = 200}).mesh;
}

TEST(Interruption, FilesAreWhole) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = large_mesh();
  const Bvh tree = build_binned(triangle_bounds(mesh), {}, {});
  const Interruptions alarm;
  for (int i = 0; i < 5; ++i) {
    save_mesh(mesh, folder.file("a.ply"));
    save_tree(tree, folder.file("a.rgt"));
    EXPECT_EQ(load_mesh(folder.file("a.ply")).triangles, mesh.triangles);
    EXPECT_EQ(load_tree(folder.file("a.rgt")).prims, tree.prims);
  }
  EXPECT_GT(interruptions, 10);
}

TEST(Interruption, ImportsInAChildComeOver) {
  const TemporaryFolder folder;
  const TriangleMesh mesh = large_mesh();
  save_mesh(mesh, folder.file("a.obj"));
  const Interruptions alarm;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(load_mesh(folder.file("a.obj"), {.isolation = Isolation::kChildProcess}).triangles, mesh.triangles);
}

TEST(Interruption, StudiesKeepEveryRow) {
  const TemporaryFolder folder;
  Study study{"interrupted", {{"value"}}, {}, "", {}};
  for (uint64_t seed = 0; seed < 40; ++seed)
    study.add({"scene", "", "", "SAH+ALL", "", "", seed}, [seed] { return std::vector{std::to_string(seed)}; });
  const Interruptions alarm;
  EXPECT_EQ(run_study(study, {.folder = folder.file("out"), .jobs = 2}).rows.size(), 40u);
}

/// A pipe gives what it has, again and again.
TEST(Interruption, PipesAreReadToTheirEnd) {
  int ends[2];
  ASSERT_EQ(::pipe(ends), 0);
  std::string text = "ox,oy,oz,dx,dy,dz\n";
  for (int i = 0; i < 20000; ++i) text += "0,0,0,0,0,1\n";
  const pid_t writer = ::fork();
  ASSERT_GE(writer, 0);
  if (writer == 0) {
    for (size_t done = 0; done < text.size();) {
      const ssize_t count = ::write(ends[1], text.data() + done, std::min<size_t>(10000, text.size() - done));
      if (count < 0) ::_exit(1);
      done += static_cast<size_t>(count);
      ::usleep(1000);
    }
    ::_exit(0);
  }
  ::close(ends[1]);
  {
    const Interruptions alarm;
    EXPECT_EQ(load_rays("/dev/fd/" + std::to_string(ends[0])).size(), 20000u);
  }
  ::close(ends[0]);
  int status = 0;
  EXPECT_EQ(::waitpid(writer, &status, 0), writer);
}

}  // namespace
}  // namespace raygrain::test

#include "io/isolation.h"

#include <array>
#include <atomic>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <memory>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/random.h"
#include "io/isolation_message.h"
#include "mesh_files.h"
#include "support/shared.h"

#if defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define RAYGRAIN_TEST_SHADOW_MEMORY
#endif
#endif
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define RAYGRAIN_TEST_SHADOW_MEMORY
#endif

namespace raygrain {
namespace {

using test::error_of;

LoadOptions limits() {
  return {Isolation::kChildProcess, uint64_t{256} << 20, 60};
}

Error error_in_child(const std::function<void()>& action, const LoadOptions& options = limits()) {
  LoadReport report;
  const Error error = error_of([&] {
    import_in_child("hostile.obj", options, report, [&](LoadReport&) {
      action();
      return TriangleMesh();
    });
  });
  EXPECT_EQ(error.where, "hostile.obj");
  return error;
}

size_t open_descriptors() {
  return test::file_names("/proc/self/fd").size();
}

void expect_no_children() {
  EXPECT_EQ(waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST(Isolation, MeshAndReportComeOver) {
  for (const size_t triangles : {size_t{0}, size_t{1}, size_t{300000}}) {
    SCOPED_TRACE(triangles);
    const TriangleMesh mesh = test::random_mesh(triangles, 7);
    LoadReport report;
    const TriangleMesh copy = import_in_child("a", limits(), report, [&](LoadReport& inner) {
      inner = {11, 13};
      return mesh;
    });
    EXPECT_TRUE(test::same_bits(copy.vertices, mesh.vertices));
    EXPECT_EQ(copy.triangles, mesh.triangles);
    EXPECT_EQ(report.dropped_lines, 11u);
    EXPECT_EQ(report.dropped_points, 13u);
  }
  expect_no_children();
}

TEST(Isolation, ErrorsComeOver) {
  const Error error =
      error_in_child([] { throw Error(ErrorCode::kUnsupported, "hostile.obj", "has wings", "clip them"); });
  EXPECT_EQ(error.code, ErrorCode::kUnsupported);
  EXPECT_EQ(error.message, "has wings");
  EXPECT_EQ(error.hint, "clip them");
  EXPECT_EQ(error_in_child([] { throw std::runtime_error("ouch"); }).message, "the importer failed: ouch");
  EXPECT_EQ(error_in_child([] { throw 7; }).code, ErrorCode::kMalformed);
  EXPECT_EQ(error_in_child([] { throw std::bad_alloc(); }).code, ErrorCode::kLimit);
}

TEST(Isolation, CrashesAreErrors) {
  const size_t descriptors = open_descriptors();
  for (const int number : {SIGSEGV, SIGABRT, SIGFPE, SIGILL, SIGBUS}) {
    const Error error = error_in_child([&] { std::raise(number); });
    EXPECT_EQ(error.code, ErrorCode::kMalformed);
    EXPECT_EQ(error.message, "the importer crashed (signal " + std::to_string(number) + ")");
  }
  EXPECT_EQ(error_in_child([] { std::raise(SIGKILL); }).code, ErrorCode::kLimit);
  EXPECT_EQ(error_in_child([] { std::raise(SIGTERM); }).code, ErrorCode::kCancelled);
  EXPECT_EQ(error_in_child([] { _exit(0); }).code, ErrorCode::kMalformed);
  EXPECT_EQ(error_in_child([] { _exit(9); }).message, "the importer gave up (exit status 9)");
  EXPECT_EQ(open_descriptors(), descriptors);
  expect_no_children();
}

TEST(Isolation, EndlessLoopsAreEnded) {
  LoadOptions options = limits();
  options.time_limit = 1;
  const Error error = error_in_child(
      [] {
        for (std::atomic<uint64_t> steps = 0;;) ++steps;
      },
      options);
  EXPECT_EQ(error.code, ErrorCode::kLimit);
  EXPECT_EQ(error.message, "importing takes more than 1 s");
  expect_no_children();
}

TEST(Isolation, EndlessMemoryIsRefused) {
#ifdef RAYGRAIN_TEST_SHADOW_MEMORY
  GTEST_SKIP() << "a sanitizer's shadow memory rules out a memory limit";
#else
  const Error error = error_in_child([] {
    std::vector<std::unique_ptr<char[]> > blocks;
    for (;;) blocks.push_back(std::make_unique<char[]>(1 << 20));
  });
  EXPECT_EQ(error.code, ErrorCode::kLimit);
  EXPECT_EQ(error.message, "importing needs more than 256 MiB of memory");
#endif
}

TEST(Isolation, MemoryOfTheParentDoesNotCount) {
  const std::vector<char> large(size_t{512} << 20);
  LoadReport report;
  EXPECT_EQ(import_in_child("a", limits(), report, [](LoadReport&) { return test::small_mesh(); }).triangle_count(),
            test::small_mesh().triangle_count());
}

TEST(Isolation, TooLongAMessageIsRefused) {
  LoadOptions options = limits();
  options.memory_limit = 1 << 20;
  LoadReport report;
  const auto endless = [](LoadReport&) -> TriangleMesh {
    const std::string block(1 << 16, 'x');
    while (write(3, block.data(), block.size()) > 0) {
    }
    _exit(0);
  };
  EXPECT_EQ(error_of([&] { import_in_child("a", options, report, endless); }).code, ErrorCode::kLimit);
  expect_no_children();
}

TEST(Isolation, ForeignBytesInThePipeAreRefused) {
  const Error error = error_in_child([] {
    if (write(3, "garbage!garbage!garbage!", 24) == 24) _exit(0);
  });
  EXPECT_EQ(error.code, ErrorCode::kMalformed);
}

TEST(Isolation, TheChildIsSilentAndRunsNoHandlersOfTheParent) {
  const test::TemporaryFolder folder;
  static std::string flag;
  static const pid_t parent = getpid();
  flag = folder.file("flag");
  std::atexit([] {
    if (getpid() != parent) close(open(flag.c_str(), O_CREAT | O_WRONLY, 0600));
  });
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  std::printf("parent ");  // unflushed: must be written once
  LoadReport report;
  import_in_child("a", limits(), report, [](LoadReport&) {
    std::cout << "out" << std::endl;
    std::cerr << "err" << std::endl;
    std::printf("printf");
    std::fflush(stdout);
    return TriangleMesh();
  });
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "parent ");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_FALSE(std::filesystem::exists(flag));
}

TEST(Isolation, WorksBesideOtherThreads) {
#ifdef __SANITIZE_ADDRESS__
  // Its allocator, unlike the C library's, may stay locked in a child that is forked while another thread allocates.
  GTEST_SKIP() << "AddressSanitizer's allocator does not survive a fork beside busy threads";
#endif
  const size_t descriptors = open_descriptors();
  std::atomic<bool> stop{false};
  std::atomic<int> wrong{0};
  std::thread allocating([&] {
    while (!stop) std::make_unique<std::string>(1000, 'x')->append("y");
  });
  std::vector<std::thread> loading;
  for (uint64_t seed = 1; seed <= 3; ++seed)
    loading.emplace_back([&, seed] {
      const TriangleMesh mesh = test::random_mesh(1000, seed);
      for (int i = 0; i < 10; ++i) {
        LoadReport report;
        LoadOptions options = limits();
        options.time_limit = 30;
        const TriangleMesh copy =
            import_in_child("a", options, report, [&](LoadReport&) { return TriangleMesh(mesh); });
        if (!test::same_bits(copy.vertices, mesh.vertices) || copy.triangles != mesh.triangles) ++wrong;
      }
    });
  for (std::thread& thread : loading) thread.join();
  stop = true;
  allocating.join();
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(open_descriptors(), descriptors);
  expect_no_children();
}

TEST(Isolation, MessagesAreCheckedByteByByte) {
  const TriangleMesh mesh = test::small_mesh();
  const Error error(ErrorCode::kBadMesh, "where", "message", "hint");
  for (const std::string& message : {encode_mesh(mesh, {1, 2}), encode_error(error)}) {
    LoadReport report;
    for (size_t size = 0; size < message.size(); ++size)
      EXPECT_EQ(error_of([&] { decode_message(message.substr(0, size), "a", report); }).code, ErrorCode::kMalformed);
    EXPECT_EQ(error_of([&] { decode_message(message + "x", "a", report); }).code, ErrorCode::kMalformed);
    for (uint64_t seed = 0; seed < 1000; ++seed) {
      Random random(seed);
      std::string flipped = message;
      flipped[random.below(flipped.size())] = static_cast<char>(random.next());
      try {
        const TriangleMesh decoded = decode_message(flipped, "a", report);
        EXPECT_EQ(decoded.vertices.size(), mesh.vertices.size());
        EXPECT_EQ(decoded.triangles.size(), mesh.triangles.size());
      } catch (const Error&) {
      }
    }
  }
  LoadReport report;
  const Error copy = error_of([&] { decode_message(encode_error(error), "a", report); });
  EXPECT_STREQ(copy.what(), error.what());
}

}  // namespace
}  // namespace raygrain

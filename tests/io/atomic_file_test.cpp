#include <atomic>
#include <csignal>
#include <filesystem>
#include <ostream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "raygrain/io.h"

#include "mesh_files.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using test::error_of;
using test::file_names;
using test::get_file;
using test::put_file;
using Names = std::vector<std::string>;

void write_text(const std::string& path, const std::string& text) {
  write_file_atomically(path, [&](std::ostream& stream) { stream << text; });
}

TEST(AtomicFile, WritesWhatItIsGiven) {
  const test::TemporaryFolder folder;
  const std::string large(300000, 'x');
  write_text(folder.file("a.txt"), "first");
  write_text(folder.file("a.txt"), large);
  write_text(folder.file("empty"), "");
  EXPECT_EQ(get_file(folder.file("a.txt")), large);
  EXPECT_EQ(file_names(folder.path()), (Names{"a.txt", "empty"}));
}

TEST(AtomicFile, KeepsThePermissionsOfTheFileItReplaces) {
  const test::TemporaryFolder folder;
  put_file(folder.file("a"), "old");
  ASSERT_EQ(chmod(folder.file("a").c_str(), 0640), 0);
  write_text(folder.file("a"), "new");
  struct stat status {};
  ASSERT_EQ(stat(folder.file("a").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
}

TEST(AtomicFile, WritesThroughSymbolicLinks) {
  const test::TemporaryFolder folder;
  put_file(folder.file("target"), "old");
  std::filesystem::create_symlink("target", folder.file("link"));
  std::filesystem::create_symlink("link", folder.file("chain"));
  std::filesystem::create_symlink("later", folder.file("dangling"));
  write_text(folder.file("chain"), "new");
  write_text(folder.file("dangling"), "born");
  EXPECT_EQ(get_file(folder.file("target")), "new");
  EXPECT_EQ(get_file(folder.file("later")), "born");
  for (const char* link : {"link", "chain", "dangling"})
    EXPECT_TRUE(std::filesystem::is_symlink(folder.file(link))) << link;
  EXPECT_EQ(file_names(folder.path()).size(), 5u);
}

TEST(AtomicFile, LeavesTheOldFileWhenTheWriterThrows) {
  const test::TemporaryFolder folder;
  put_file(folder.file("a"), "old");
  const auto throwing = [](std::ostream& stream) {
    stream << std::string(200000, 'x');
    throw std::runtime_error("stop");
  };
  EXPECT_THROW(write_file_atomically(folder.file("a"), throwing), std::runtime_error);
  EXPECT_EQ(get_file(folder.file("a")), "old");
  EXPECT_EQ(file_names(folder.path()), Names{"a"});
}

TEST(AtomicFile, RefusesATargetThatCannotBe) {
  const test::TemporaryFolder folder;
  put_file(folder.file("file"), "");
  std::filesystem::create_directory(folder.file("sub"));
  for (const std::string& path :
       {folder.file("none/a"), folder.file("file/a"), folder.file("sub"), folder.file("sub/"), folder.file("new/"),
        folder.file(std::string(300, 'n')), std::string(), std::string("/proc/none/a")}) {
    SCOPED_TRACE(path);
    const Error error = error_of([&] { write_text(path, "text"); });
    EXPECT_EQ(error.code, ErrorCode::kUnwritable);
    EXPECT_EQ(error.where, path);
    EXPECT_EQ(error.message.find("cannot write: "), 0u);
  }
  EXPECT_EQ(file_names(folder.path()), (Names{"file", "sub"}));
  EXPECT_TRUE(file_names(folder.file("sub")).empty());
}

TEST(AtomicFile, WritesToDevicesDirectly) {
  write_text("/dev/null", "gone");
  struct stat status {};
  ASSERT_EQ(stat("/dev/null", &status), 0);
  EXPECT_TRUE(S_ISCHR(status.st_mode));
  const Error error = error_of([] { write_text("/dev/full", "text"); });
  EXPECT_EQ(error.code, ErrorCode::kUnwritable);
  EXPECT_EQ(error.message, "cannot write: No space left on device");
  EXPECT_FALSE(error.hint.empty());
}

TEST(AtomicFile, GoesOnWhereStandardOutputStands) {
  const test::TemporaryFolder folder;
  std::fflush(stdout);
  const int saved = dup(1);
  const int file = open(folder.file("out").c_str(), O_WRONLY | O_CREAT, 0666);
  ASSERT_GE(file, 0);
  dup2(file, 1);
  ASSERT_EQ(write(1, "before ", 7), 7);
  write_text("/dev/stdout", "one ");
  write_text("/dev/fd/1", "two ");
  write_text("/proc/self/fd/1", "three");
  dup2(saved, 1);
  close(saved);
  close(file);
  EXPECT_EQ(get_file(folder.file("out")), "before one two three");
  EXPECT_EQ(file_names(folder.path()), Names{"out"});
}

TEST(AtomicFile, LeavesNothingWhenTheDiskIsFull) {
  const test::TemporaryFolder folder;
  put_file(folder.file("a"), "old");
  rlimit old{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit small = old;
  small.rlim_cur = 100000;  // more than one block of the stream, less than all
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &small), 0);
  const Error fresh = error_of([&] { write_text(folder.file("b"), std::string(300000, 'x')); });
  const Error replaced = error_of([&] { write_text(folder.file("a"), std::string(300000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &old);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(fresh.code, ErrorCode::kUnwritable);
  EXPECT_EQ(replaced.code, ErrorCode::kUnwritable);
  EXPECT_EQ(get_file(folder.file("a")), "old");
  EXPECT_EQ(file_names(folder.path()), Names{"a"});
}

TEST(AtomicFile, ManyThreadsLeaveOneWholeVersion) {
  const test::TemporaryFolder folder;
  std::vector<std::thread> threads;
  for (char name = 'a'; name < 'i'; ++name)
    threads.emplace_back([&, name] {
      for (int i = 0; i < 5; ++i) write_text(folder.file("same"), std::string(100000, name));
    });
  for (std::thread& thread : threads) thread.join();
  const std::string text = get_file(folder.file("same"));
  ASSERT_EQ(text.size(), 100000u);
  EXPECT_EQ(text.find_first_not_of(text[0]), std::string::npos);
  EXPECT_EQ(file_names(folder.path()), Names{"same"});
}

void write_nested(const test::TemporaryFolder& folder, int depth) {
  write_file_atomically(folder.file(std::to_string(depth)), [&](std::ostream&) { write_nested(folder, depth + 1); });
}

TEST(AtomicFile, TooManyWritesAtOnceAreAnError) {
  const test::TemporaryFolder folder;
  EXPECT_EQ(error_of([&] { write_nested(folder, 0); }).code, ErrorCode::kLimit);
  EXPECT_TRUE(file_names(folder.path()).empty());
  write_text(folder.file("a"), "again");
  EXPECT_EQ(get_file(folder.file("a")), "again");
}

TEST(AtomicFile, RemoveUnfinishedFilesEndsAWrite) {
  const test::TemporaryFolder folder;
  write_text(folder.file("done"), "kept");
  const Error error = error_of([&] {
    write_file_atomically(folder.file("a"), [&](std::ostream& stream) {
      stream << "text";
      EXPECT_EQ(file_names(folder.path()).size(), 2u);
      remove_unfinished_files();
      EXPECT_EQ(file_names(folder.path()), Names{"done"});
    });
  });
  EXPECT_EQ(error.code, ErrorCode::kUnwritable);
  EXPECT_EQ(file_names(folder.path()), Names{"done"});
}

TEST(AtomicFile, ASignalHandlerMayCleanUp) {
  const test::TemporaryFolder folder;
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGTERM, [](int) {
      remove_unfinished_files();
      _exit(7);
    });
    write_file_atomically(folder.file("a"), [](std::ostream& stream) {
      stream << std::string(200000, 'x');
      std::raise(SIGTERM);
    });
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(WEXITSTATUS(status), 7);
  EXPECT_TRUE(file_names(folder.path()).empty());
}

TEST(OutputFolder, IsCreatedWithItsParents) {
  const test::TemporaryFolder folder;
  make_output_folder(folder.file("a/b/c"));
  make_output_folder(folder.file("a/b/c"));
  make_output_folder(folder.file("a/d/"));
  EXPECT_TRUE(file_names(folder.file("a/b/c")).empty());
  EXPECT_EQ(file_names(folder.file("a")), (Names{"b", "d"}));
}

TEST(OutputFolder, IsRefusedWhereNothingCanBeWritten) {
  const test::TemporaryFolder folder;
  put_file(folder.file("file"), "");
  std::vector<std::string> paths{folder.file("file"), folder.file("file/sub"), "/proc/none", "/proc/self", ""};
  if (geteuid() != 0) {
    std::filesystem::create_directory(folder.file("locked"));
    chmod(folder.file("locked").c_str(), 0500);
    paths.push_back(folder.file("locked"));
    paths.push_back(folder.file("locked/sub"));
  }
  for (const std::string& path : paths) {
    SCOPED_TRACE(path);
    const Error error = error_of([&] { make_output_folder(path); });
    EXPECT_EQ(error.code, ErrorCode::kUnwritable);
    EXPECT_EQ(error.where, path);
  }
}

}  // namespace
}  // namespace raygrain

// The runner: every row once, whatever is interrupted when; the same file for any number of jobs.
#include <atomic>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/study.h"

#include "study/table.h"
#include "support/error_of.h"
#include "support/shared.h"

namespace raygrain {
namespace {

using test::error_of;

std::string content(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

void write(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

/// `count` rows, given in an order that is not that of their keys.
Study counting_study(size_t count, std::atomic<int>& runs, const std::string& identity = "a") {
  Study study{"counting", {{"square"}, {"text"}}, {}, identity, {}};
  for (size_t i = 0; i < count; ++i) {
    const size_t number = i * 7 % count;
    const std::string digits = std::to_string(number),
                      scene = std::string("scene, ").append(1, '"').append(digits, 0, 1);
    study.add({scene, "plane", "", std::string("c").append(digits)}, [number, &runs] {
      ++runs;
      return std::vector<std::string>{study_cell(static_cast<double>(number * number) / 3),
                                      number % 2 == 0 ? "a,b \"c\"" : ""};
    });
  }
  return study;
}

TEST(StudyRunner, SortsAndReadsBack) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  const StudyTable table = run_study(counting_study(20, runs), {.folder = folder.file("out"), .jobs = 3});
  EXPECT_EQ(runs, 20);
  ASSERT_EQ(table.rows.size(), 20u);
  const StudyTable read = load_study_table(folder.file("out") + "/results.csv");
  EXPECT_EQ(read.header, table.header);
  EXPECT_EQ(read.rows, table.rows);
  for (size_t i = 1; i < table.rows.size(); ++i)
    EXPECT_LT(*study::key_of(table.rows[i - 1]), *study::key_of(table.rows[i]));
  EXPECT_FALSE(std::filesystem::exists(folder.file("out") + "/results.partial.csv"));
  EXPECT_EQ(error_of([&] { return table.column("cube"); }).code, ErrorCode::kNotFound);
  EXPECT_TRUE(std::isnan(read.number(1, read.column("commit"))));
}

TEST(StudyRunner, SameForAnyNumberOfJobs) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  std::string first;
  for (const unsigned jobs : {1u, 2u, 8u, 0u}) {
    const std::string out = folder.file(std::string("out").append(std::to_string(jobs)));
    run_study(counting_study(33, runs), {.folder = out, .jobs = jobs});
    if (first.empty()) first = content(out + "/results.csv");
    EXPECT_EQ(content(out + "/results.csv"), first) << jobs;
  }
}

/// Stops after each number of rows; the next run must compute the rest only, and end with the same file.
TEST(StudyRunner, GoesOnAfterACancel) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  const Study study = counting_study(12, runs);
  run_study(study, {.folder = folder.file("whole")});
  for (int stop = 0; stop <= 12; ++stop) {
    SCOPED_TRACE(stop);
    const std::string out = folder.file(std::to_string(stop));
    runs = 0;
    int told = 0;
    StudyRunOptions options{.folder = out};
    options.progress = [&](const std::string&, double done) {
      EXPECT_GE(done, 0);
      EXPECT_LE(done, 1);
      return told++ < stop;
    };
    EXPECT_EQ(error_of([&] { return run_study(study, options); }).code, ErrorCode::kCancelled);
    EXPECT_EQ(runs, stop);
    run_study(study, {.folder = out});
    EXPECT_EQ(runs, 12);
    EXPECT_EQ(content(out + "/results.csv"), content(folder.file("whole") + "/results.csv"));
  }
}

/// A kill may leave the partial file cut at any byte.
TEST(StudyRunner, GoesOnFromAPartialFileCutAnywhere) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  const Study study = counting_study(5, runs);
  run_study(study, {.folder = folder.file("whole")});
  const std::string out = folder.file("out"), partial = out + "/results.partial.csv";
  StudyRunOptions options{.folder = out};
  options.progress = [](const std::string&, double done) { return done < 1; };
  EXPECT_EQ(error_of([&] { return run_study(study, options); }).code, ErrorCode::kCancelled);
  const std::string all = content(partial);
  ASSERT_GT(all.size(), 100u);
  for (size_t size = 0; size <= all.size(); size += 5) {  // a disk flush each
    write(partial, all.substr(0, size));
    const auto lines = std::count(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(size), '\n');
    runs = 0;
    run_study(study, {.folder = out});
    ASSERT_EQ(runs, 5 - std::max<std::ptrdiff_t>(lines - 1, 0)) << "cut at " << size;
    ASSERT_EQ(content(out + "/results.csv"), content(folder.file("whole") + "/results.csv")) << "cut at " << size;
  }
}

TEST(StudyRunner, RefusesWhatIsNotItsOwn) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  const std::string out = folder.file("out"), partial = out + "/results.partial.csv";
  StudyRunOptions options{.folder = out};
  options.progress = [](const std::string&, double done) { return done < 0.5; };
  EXPECT_EQ(error_of([&] { return run_study(counting_study(5, runs), options); }).code, ErrorCode::kCancelled);
  const std::string all = content(partial);

  EXPECT_EQ(error_of([&] { return run_study(counting_study(6, runs), {.folder = out}); }).code, ErrorCode::kUsage);
  EXPECT_EQ(error_of([&] { return run_study(counting_study(5, runs, "b"), {.folder = out}); }).code, ErrorCode::kUsage);
  EXPECT_EQ(content(partial), all);  // nothing was lost

  write(partial, all + "some,line\n");
  const Error malformed = error_of([&] { return run_study(counting_study(5, runs), {.folder = out}); });
  EXPECT_EQ(malformed.code, ErrorCode::kMalformed);
  EXPECT_TRUE(
      malformed.where.ends_with(std::string(":").append(std::to_string(std::count(all.begin(), all.end(), '\n') + 1))))
      << malformed.where;

  Study twice = counting_study(3, runs);
  twice.tasks.push_back(twice.tasks[0]);
  EXPECT_EQ(error_of([&] { return run_study(twice, {.folder = folder.file("twice")}); }).code, ErrorCode::kUsage);
  write(folder.file("file"), "");
  EXPECT_EQ(error_of([&] { return run_study(counting_study(1, runs), {.folder = folder.file("file")}); }).code,
            ErrorCode::kUnwritable);
}

/// Finished results are overwritten by the same study alone; by names of rows where nothing else is known of them.
TEST(StudyRunner, KeepsFinishedResultsOfOthers) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  const std::string out = folder.file("out"), results = out + "/results.csv";
  run_study(counting_study(5, runs), {.folder = out});
  const std::string finished = content(results), note = content(out + "/study.txt");
  Study other_name = counting_study(5, runs), other_columns = counting_study(5, runs);
  other_name.name = "another";
  other_columns.columns[0].name = "cube";
  runs = 0;
  for (const Study& other : {counting_study(6, runs), counting_study(5, runs, "b"), other_name, other_columns}) {
    const Error error = error_of([&] { return run_study(other, {.folder = out}); });
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    EXPECT_EQ(error.where, results);
    EXPECT_FALSE(error.hint.empty());
    EXPECT_EQ(content(results), finished);
    EXPECT_EQ(content(out + "/study.txt"), note);
    EXPECT_FALSE(std::filesystem::exists(out + "/results.partial.csv"));
  }
  EXPECT_EQ(runs, 0);
  run_study(counting_study(5, runs), {.folder = out});
  EXPECT_EQ(runs, 5);

  std::filesystem::remove(out + "/study.txt");
  EXPECT_EQ(error_of([&] { return run_study(counting_study(6, runs), {.folder = out}); }).code, ErrorCode::kUsage);
  run_study(counting_study(5, runs), {.folder = out});
  std::filesystem::remove(out + "/study.txt");
  write(results, "a table of mine\n1\n");
  EXPECT_EQ(error_of([&] { return run_study(counting_study(5, runs), {.folder = out}); }).code, ErrorCode::kUsage);
  EXPECT_EQ(content(results), "a table of mine\n1\n");
}

TEST(StudyRunner, RefusesASecondRunInTheSameFolder) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  StudyRunOptions options{.folder = folder.file("out")};
  options.progress = [&](const std::string&, double) {
    const Error error = error_of([&] { return run_study(counting_study(2, runs), {.folder = folder.file("out")}); });
    EXPECT_EQ(error.code, ErrorCode::kUsage);
    return true;
  };
  run_study(counting_study(2, runs), options);
}

TEST(StudyRunner, NamesTheRowThatFailsAndKeepsTheOthers) {
  const test::TemporaryFolder folder;
  std::atomic<int> runs{0};
  Study study = counting_study(4, runs);
  study.tasks[2].run = []() -> std::vector<std::string> { throw Error(ErrorCode::kBadHeuristic, "node 7", "is bad"); };
  const Error error = error_of([&] { return run_study(study, {.folder = folder.file("out")}); });
  EXPECT_EQ(error.code, ErrorCode::kBadHeuristic);
  EXPECT_EQ(error.where, study::describe(study.tasks[2].key));
  EXPECT_EQ(error.message, "node 7: is bad");
  study.tasks[2].run = [] { return std::vector<std::string>{"1", ""}; };
  EXPECT_EQ(run_study(study, {.folder = folder.file("out")}).rows.size(), 4u);
  EXPECT_EQ(runs, 3);
}

TEST(StudyTable, RefusesBrokenFiles) {
  const test::TemporaryFolder folder;
  const std::string path = folder.file("results.csv");
  for (const auto& [text, line] : std::vector<std::pair<std::string, std::string>>{{"", ""},
                                                                                   {"a,b\n1\n", ":2"},
                                                                                   {"a,b\n1,2\n\"x,3\n", ":3"},
                                                                                   {"a,b\nx\"y,2\n", ":2"},
                                                                                   {"a,b\n1,2,3\n", ":2"}}) {
    write(path, text);
    const Error error = error_of([&] { return load_study_table(path); });
    EXPECT_EQ(error.code, ErrorCode::kMalformed) << text;
    EXPECT_EQ(error.where, path + line) << text;
  }
  EXPECT_EQ(error_of([&] { return load_study_table(folder.file("none")); }).code, ErrorCode::kNotFound);
  write(path, "a,b\r\n\"1,\"\"2\",x\r\n");
  const StudyTable table = load_study_table(path);
  EXPECT_EQ(table.rows, (std::vector<std::vector<std::string>>{{"1,\"2", "x"}}));
  EXPECT_EQ(error_of([&] { return table.number(0, 1); }).code, ErrorCode::kMalformed);
}

}  // namespace
}  // namespace raygrain

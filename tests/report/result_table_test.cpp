// Results files: what is read, and what is refused with a place and a reason.
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "raygrain/error.h"
#include "raygrain/study_report.h"

namespace raygrain {
namespace {

namespace fs = std::filesystem;

class ResultsFile : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const fs::path path = folder_ / name;
    fs::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary) << text;
    return path.string();
  }

  fs::path folder_ = fs::path(testing::TempDir()) /
                     ("results_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
};

TEST_F(ResultsFile, IsReadWithQuotesByteOrderMarkAndEitherLineEnd) {
  const ResultTable table = load_results(
      write("mine.csv", "\xef\xbb\xbfscene,combo,real_cost_local\r\n\"a,\"\"b\"\"\",\"two\nlines\",1.5\r\n\r\nc,d,\n"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"scene", "recipe", "real_cost"}));
  ASSERT_EQ(table.rows.size(), 2u);
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"a,\"b\"", "two\nlines", "1.5"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"c", "d", ""}));
  EXPECT_EQ(table.study, "mine");
}

TEST_F(ResultsFile, HasTheNameOfItsRowsOrStudyOrFolder) {
  EXPECT_EQ(load_results(write("corrected/results.csv", "combo,pruned_cost\na,1\n")).study, "corrected");
  write("s/study.txt", "# raygrain-study 1 my own study 1234567\n");
  EXPECT_EQ(load_results(write("s/results.csv", "combo,pruned_cost\na,1\n")).study, "my own study");
  EXPECT_EQ(load_results(write("s/x.csv", "combo,pruned_cost\na,1\n")).study, "x");
  for (const char* foreign : {"", "hello", "# raygrain-study 1 ", "# raygrain-study 1 x"}) {
    write("s/study.txt", foreign);
    EXPECT_EQ(load_results(write("s/results.csv", "combo,pruned_cost\na,1\n")).study, "s") << foreign;
  }
  EXPECT_EQ(load_results(write("x.csv", "study,combo,pruned_cost\npaper,a,1\n")).study, "paper");
}

TEST_F(ResultsFile, IsRefusedWithItsPlace) {
  struct Case {
    const char* name;
    const char* text;
    const char* where;
    const char* what;
  };
  const Case cases[] = {
      {"empty", "", ".csv", "empty"},
      {"blank", "\n\n", ".csv", "empty"},
      {"header_only", "scene,combo,pruned_cost\n", ".csv", "no results"},
      {"foreign", "date,close\n2020-01-01,5\n", ".csv:1", "no results file"},
      {"binary", "\x89PNG\r\n\x1a\n", ".csv:1", "no results file"},
      {"twice", "combo,pruned_cost,pruned_cost\na,1,2\n", ".csv:1", "twice"},
      {"same_twice", "combo,real_cost,real_cost_local\na,1,2\n", ".csv:1", "twice"},
      {"short", "scene,combo,pruned_cost\nWood,a,1\nWood,b\n", ".csv:3", "2 cells where the header has 3"},
      {"long", "combo,pruned_cost\na,1,2\n", ".csv:2", "3 cells"},
      {"text", "combo,pruned_cost\n\"x\ny\",1\na,cheap\n", ".csv:4", "not a number"},
      {"open_quote", "combo,pruned_cost\n\"a,1\n", ".csv:2", "not closed"},
      {"after_quote", "combo,pruned_cost\n\"a\"b,1\n", ".csv:2", "closing quote"},
  };
  for (const Case& c : cases) {
    try {
      load_results(write(std::string(c.name) + ".csv", c.text));
      ADD_FAILURE() << c.name << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.code, ErrorCode::kMalformed) << c.name;
      EXPECT_TRUE(error.where.ends_with(c.where)) << c.name << ": " << error.what();
      EXPECT_NE(error.message.find(c.what), std::string::npos) << c.name << ": " << error.what();
      EXPECT_FALSE(error.hint.empty()) << c.name;
    }
  }
  EXPECT_THROW(load_results((folder_ / "nothing.csv").string()), Error);
  EXPECT_THROW(load_results(folder_.string()), Error);
}

}  // namespace
}  // namespace raygrain

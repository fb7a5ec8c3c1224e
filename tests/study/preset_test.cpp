// The ready-made studies against tables that were committed: every deterministic number of every row. After a change
// that is meant to change them: RAYGRAIN_UPDATE_EXPECTED=1 writes the tables anew; read the difference, then commit it.
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>

#include <gtest/gtest.h>

#include "raygrain/study.h"

#include "study/table.h"
#include "support/mesh_families.h"
#include "support/shared.h"

namespace raygrain {
namespace {

struct Expectation {
  std::string name;  // of the file
  std::string study;
  std::vector<std::string> only;
  size_t rays = 1000;
  bool quick = false, shared = false;
  bool full = false;  // at full scale only
};

std::vector<Expectation> expectations() {
  return {
      {"published", "published", {"Random100", "Random1000"}},
      {"paper", "paper", {"Random100", "Random1000"}},
      {"corrected", "corrected", {"Random100", "Random1000", "Terrain"}, 500, true},
      {"parameters", "parameters", {"Random100", "Random1000"}, 500, true},
      {"areas", "areas", {"City"}, 500, true},
      {"memory", "memory", {"Random100", "Random1000"}},
      {"scaling", "scaling", {}, 500, true},
      {"stress", "stress", {"Random100", "Random1000"}, 500},
      {"visibility", "visibility", {"City", "Terrain"}, 200, true},
      {"published_shared", "published", {"Wood", "Suzanne", "Cottage", "CottageWalls"}, 1000, false, true},
      {"paper_shared", "paper", {"Suzanne", "Cottage"}, 1000, false, true},
      {"corrected_shared", "corrected", {"Suzanne"}, 1000, true, true},
      {"paper_large", "paper", {"Crowd", "Sponza"}, 1000, false, true, true},
      {"corrected_full", "corrected", {}, 1000, false, true, true},
      {"paper_rest", "paper", {"Wood", "CottageWalls"}, 1000, false, true, true},
      {"published_large", "published", {"Crowd", "Sponza"}, 1000, false, true, true},
      {"parameters_full", "parameters", {"Random100"}, 1000, false, false, true},
      {"areas_full", "areas", {"City"}, 1000, false, false, true},
      {"scaling_full", "scaling", {"City 8", "City 15", "City 30"}, 500, false, false, true},
      {"memory_shared", "memory", {}, 1000, false, true, true},
      {"stress_shared", "stress", {"Wood", "Suzanne", "Cottage", "CottageWalls"}, 500, false, true, true},
  };
}

std::string scenes_folder() {
  const auto file = test::shared_scene("suzanne.obj");
  return file ? std::filesystem::path(*file).parent_path().string() : std::string();
}

StudyTable run(const Expectation& expectation, const std::string& folder) {
  const StudySources sources{expectation.shared ? scenes_folder() : "", expectation.only, expectation.rays, 1,
                             expectation.quick};
  return run_study(preset_study(expectation.study, sources), {.folder = folder, .jobs = 2});
}

/// The columns that must be the same everywhere.
std::vector<std::vector<std::string>> deterministic(const StudyTable& table, const std::string& study) {
  std::map<std::string, bool> keep{{"commit", false}, {"compiler", false}, {"cpu", false}};
  for (const StudyColumn& column : preset_study(study, StudySources{}).columns)
    keep[column.name] = column.deterministic;
  std::vector<std::vector<std::string>> result;
  const auto add = [&](const std::vector<std::string>& row) {
    std::vector<std::string>& kept = result.emplace_back();
    for (size_t i = 0; i < row.size(); ++i)
      if (const auto known = keep.find(table.header[i]); known == keep.end() || known->second) kept.push_back(row[i]);
  };
  add(table.header);
  for (const auto& row : table.rows) add(row);
  return result;
}

class Preset : public testing::TestWithParam<Expectation> {};

TEST_P(Preset, EqualsTheCommittedTable) {
  const Expectation& expectation = GetParam();
  if (expectation.full && !test::is_full_scale()) GTEST_SKIP() << "at full scale only";
  if (expectation.shared && scenes_folder().empty()) GTEST_SKIP() << "needs ../shared/scenes";
  const test::TemporaryFolder folder;
  const auto rows = deterministic(run(expectation, folder.path()), expectation.study);
  const std::string path = (test::source_folder() / "tests/study/expected" / (expectation.name + ".csv")).string();
  if (std::getenv("RAYGRAIN_UPDATE_EXPECTED") != nullptr) {
    std::ofstream file(path);
    for (const auto& row : rows) file << study::csv_line(row) << '\n';
  }
  const StudyTable expected = load_study_table(path);
  ASSERT_EQ(rows[0], expected.header);
  ASSERT_EQ(rows.size(), expected.rows.size() + 1);
  for (size_t i = 1; i < rows.size(); ++i)
    for (size_t column = 0; column < rows[i].size(); ++column)
      ASSERT_EQ(rows[i][column], expected.rows[i - 1][column])
          << expected.header[column] << " of row " << study::csv_line({rows[i].begin(), rows[i].begin() + 4});
}

INSTANTIATE_TEST_SUITE_P(Studies, Preset, testing::ValuesIn(expectations()),
                         [](const auto& expectation) { return expectation.param.name; });

}  // namespace
}  // namespace raygrain

// The published numbers: means over the six scenes whose models are the authors' own, by the rules of their program.
#include <cmath>

#include <gtest/gtest.h>

#include "raygrain/study.h"

#include "support/shared.h"

namespace raygrain {
namespace {

struct Published {
  const char* combo;
  double planes[4], points[4];  // parallel, 15, 45 degrees, oblique
};

/// Mean real costs in the local tree over Wood, Suzanne, Cottage, CottageWalls, Random100 and Random1000.
constexpr Published kPublished[] = {
    {"PAH+SPFH", {63.4, 106.8, 108.3, 96.9}, {74.3, 71.5, 82.3, 80.8}},
    {"SAH+SPFH", {69.7, 81.4, 92.8, 82.8}, {65.2, 63.2, 72.7, 74.5}},
    {"SAH+LSPH", {78.7, 93.8, 98.9, 86.8}, {72.1, 70.6, 73.5, 78.9}},
    {"PAH+LSPH", {82.7, 125.3, 140.4, 140.2}, {83.2, 82.2, 104.4, 90.1}},
};
constexpr const char* kVariants[] = {"parallel", "15deg", "45deg", "oblique"};

/// The committed tables, which the tests of presets compare with what is computed.
std::vector<StudyTable> tables() {
  const auto folder = test::source_folder() / "tests/study/expected";
  return {load_study_table((folder / "published.csv").string()),
          load_study_table((folder / "published_shared.csv").string())};
}

double mean(const std::vector<StudyTable>& all, const std::string& combo, const std::string& kind,
            const std::string& variant) {
  double sum = 0;
  int count = 0;
  for (const StudyTable& table : all) {
    const size_t cost = table.column("real_cost_local");
    for (size_t row = 0; row < table.rows.size(); ++row) {
      const auto& cells = table.rows[row];
      if (cells[table.column("combo")] != combo || cells[table.column("kind")] != kind ||
          cells[table.column("variant")] != variant)
        continue;
      sum += table.number(row, cost);
      ++count;
    }
  }
  EXPECT_EQ(count, 6);
  return sum / count;
}

TEST(Published, SixSceneMeansAreMet) {
  const std::vector<StudyTable> all = tables();
  for (const Published& row : kPublished)
    for (size_t i = 0; i < 4; ++i)
      for (const char* kind : {"plane", "point"}) {
        const double published = *kind == 'p' && kind[1] == 'l' ? row.planes[i] : row.points[i];
        const double measured = mean(all, row.combo, kind, kVariants[i]);
        EXPECT_NEAR(measured / published, 1, 0.021) << row.combo << ' ' << kind << ' ' << kVariants[i];
      }
}

TEST(Published, MostMeansAreMetToATenthOfAPercent) {
  const std::vector<StudyTable> all = tables();
  int met = 0;
  for (const Published& row : kPublished)
    for (size_t i = 0; i < 4; ++i) {
      met += std::abs(mean(all, row.combo, "plane", kVariants[i]) / row.planes[i] - 1) < 0.0015 ? 1 : 0;
      met += std::abs(mean(all, row.combo, "point", kVariants[i]) / row.points[i] - 1) < 0.0015 ? 1 : 0;
    }
  EXPECT_EQ(met, 30);  // of 32; PAH+LSPH for planes at 15 degrees and oblique is 2 % off
}

/// The published program accepted hits that are not the nearest, up to 1.5 % of the rays of a test.
TEST(Published, WrongHitsWereAccepted) {
  double worst = 0;
  for (const StudyTable& table : tables())
    for (size_t row = 0; row < table.rows.size(); ++row)
      worst = std::max(worst, table.number(row, table.column("mismatches")) / table.number(row, table.column("rays")));
  EXPECT_GT(worst, 0.005);
  EXPECT_LT(worst, 0.02);
}

}  // namespace
}  // namespace raygrain

#include <array>
#include <charconv>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "raygrain/report.h"

namespace raygrain {
namespace {

using enum FieldId;

constexpr std::array<FieldId, 6> kColumns{kPrunedCost, kHitRatio, kNodes, kMemoryBytes, kBuildSeconds, kMismatches};

ReportRow make_row(const std::string& name, const std::string& area, double cost) {
  ReportRow row{name, area, {}};
  row.values[kPrunedCost] = cost;
  row.values[kHitRatio] = 1;
  row.values[kNodes] = 12345678;
  row.values[kMemoryBytes] = 3 * 1024 * 1024;
  row.values[kBuildSeconds] = 0.012345;
  return row;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(ValueText, HasASensiblePrecisionPerField) {
  EXPECT_EQ(value_text(kPrunedCost, 12.3456), "12.35");
  EXPECT_EQ(value_text(kPrunedCost, 12), "12.00");
  EXPECT_EQ(value_text(kHitRatio, 0.25), "0.250");
  EXPECT_EQ(value_text(kBreakEvenHitRatio, -1.5), "-1.500");
  EXPECT_EQ(value_text(kNodes, 123456789012.0), "123456789012");
  EXPECT_EQ(value_text(kMeanLeafDepth, 12.345), "12.35");
  EXPECT_EQ(value_text(kMemoryBytes, 100), "100 B");
  EXPECT_EQ(value_text(kMemoryBytes, 1536), "1.5 KiB");
  EXPECT_EQ(value_text(kMemoryBytes, 3.25 * 1024 * 1024), "3.2 MiB");
  EXPECT_EQ(value_text(kBuildSeconds, 0.0012345), "0.00123");
  EXPECT_EQ(value_text(kBuildSeconds, 1.2345), "1.23");
  EXPECT_EQ(value_text(kBuildSeconds, 123.45), "123");
  EXPECT_EQ(value_text(kBuildSeconds, 12345), "12345");
  EXPECT_EQ(value_text(kBuildSeconds, 0), "0");
  EXPECT_EQ(value_text(kBuildSeconds, std::nan("")), "-");
}

TEST(TextTable, AlignsNumbersAtTheRight) {
  const ReportRow rows[] = {make_row("SAH+LSPH", "sun", 5.125), make_row("PAH+ALL", "sun", 1234.5)};
  const std::vector<std::string> lines = lines_of(text_table(rows, kColumns));
  ASSERT_GE(lines.size(), 4u);
  const std::string& last = lines.back();
  const std::string& before = lines[lines.size() - 2];
  EXPECT_EQ(before.find("5.12") + 4, last.find("1234.50") + 7) << before << "\n" << last;
  EXPECT_EQ(last.substr(0, 7), "PAH+ALL");
  for (const std::string& line : lines) EXPECT_LE(line.size(), 100u);
}

TEST(TextTable, ShowsAreasOnlyWhereTheyDiffer) {
  const ReportRow one[] = {make_row("A", "sun", 1), make_row("B", "sun", 2)};
  EXPECT_EQ(text_table(one, kColumns).find("sun"), std::string::npos);
  const ReportRow two[] = {make_row("A", "sun", 1), make_row("A", "lamp", 2)};
  EXPECT_NE(text_table(two, kColumns).find("lamp"), std::string::npos);
}

TEST(TextTable, LeavesOutColumnsWithoutValuesAndMarksMissingOnes) {
  ReportRow rows[] = {make_row("A", "", 1), make_row("B", "", 2)};
  rows[0].values[kRealCost] = 7;
  const FieldId columns[] = {kRealCost, kEstimatedCost};
  const std::string text = text_table(rows, columns);
  EXPECT_EQ(text.find("estimated"), std::string::npos);
  EXPECT_EQ(lines_of(text).back().back(), '-');
  EXPECT_EQ(text_table({}, columns), "");
}

TEST(Verdict, NamesBothRowsAndTheirRatio) {
  const std::string text = verdict(make_row("PAH+ALL", "sun", 30), make_row("SAH+LSPH", "sun", 40));
  EXPECT_NE(text.find("sun: PAH+ALL costs 0.75x of SAH+LSPH: 30.00 instead of 40.00"), std::string::npos) << text;
  const ReportRow same = make_row("SAH+LSPH", "sun", 40);
  EXPECT_NE(verdict(same, same).find("SAH+LSPH is best"), std::string::npos);
}

TEST(Verdict, NothingIsBestWhereNothingIs) {
  ReportRow row = make_row("SAH+LSPH", "far", 0);
  row.values[FieldId::kTriangles] = 0;
  EXPECT_EQ(verdict(row, row), "far: no triangle lies in this area.");
}

TEST(CsvTable, QuotesWhatNeedsIt) {
  const ReportRow rows[] = {make_row("a,\"b\"", "two\nlines", 1)};
  const std::string text = csv_table(rows, kColumns);
  EXPECT_NE(text.find("\"a,\"\"b\"\"\",\"two\nlines\",1,"), std::string::npos) << text;
  EXPECT_TRUE(text.starts_with("name,area,pruned_cost,hit_ratio,nodes,memory_bytes,build_seconds\r\n")) << text;
}

TEST(CsvTable, NumbersReadBackAsTheyWere) {
  for (const double value : {0.1, 1.0 / 3, 1e-300, 6.02214076e23, 12345678901234567.0}) {
    const ReportRow rows[] = {make_row("A", "", value)};
    const std::string line = lines_of(csv_table(rows, kColumns)).at(1);
    const size_t start = line.find(',', line.find(',') + 1) + 1;
    double read = 0;
    std::from_chars(line.data() + start, line.data() + line.size(), read);
    EXPECT_EQ(read, value) << line;
  }
}

TEST(ReportJson, HasTheKeysInOrderAndNullForWhatWasNotMeasured) {
  const ReportRow rows[] = {make_row("A", "sun", 1.5)};
  const std::string text = report_json("scene \"x\"", 12, 18446744073709551615u, {"c", "g", "i", 2}, rows, kColumns);
  const auto json = nlohmann::ordered_json::parse(text);
  std::vector<std::string> keys;
  for (const auto& [key, value] : json.items()) keys.push_back(key);
  EXPECT_EQ(keys, (std::vector<std::string>{"scene", "triangles", "seed", "environment", "rows"}));
  EXPECT_EQ(json["scene"], "scene \"x\"");
  EXPECT_EQ(json["seed"], 18446744073709551615u);
  EXPECT_EQ(json["environment"]["threads"], 2);
  const auto& row = json["rows"].at(0);
  EXPECT_EQ(row["name"], "A");
  EXPECT_EQ(row["area"], "sun");
  EXPECT_EQ(row["pruned_cost"], 1.5);
  EXPECT_TRUE(row["mismatches"].is_null());
  EXPECT_NE(text.find("\"nodes\": 12345678,"), std::string::npos) << "counts are whole numbers";
}

TEST(ReportJson, SurvivesNamesThatAreNoUtf8) {
  const std::string text = report_json("caf\xe9", 1, 1, {}, {}, kColumns);
  EXPECT_TRUE(nlohmann::json::accept(text));
}

TEST(Environment, NamesWhatItRunsOn) {
  const Environment environment = current_environment(3);
  EXPECT_EQ(environment.threads, 3u);
  EXPECT_GE(current_environment(0).threads, 1u);
  EXPECT_FALSE(environment.commit.empty());
  EXPECT_FALSE(environment.cpu.empty());
  EXPECT_NE(environment.compiler.find(' '), std::string::npos);
}

}  // namespace
}  // namespace raygrain

#include "report/study_data.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "raygrain/fields.h"

namespace raygrain {

namespace {

/// Numbers of studies that no single tree has: these, and what ends like a cost, ratio, time or size.
constexpr std::array<std::string_view, 8> kOwnMetrics{"estimated_pah",   "estimated_sah", "areas",
                                                      "foreign_share",   "areas_tested",  "local_searches",
                                                      "global_searches", "continued"};
constexpr std::array<std::string_view, 7> kOwnEndings{"_seconds", "_bytes",  "_cost",      "_ratio",
                                                      "_share",   "_culled", "_per_global"};
constexpr std::array<std::string_view, 8> kTestColumns{"scene",   "kind",  "variant", "area",
                                                       "ray_set", "areas", "seed",    "repeat"};

}  // namespace

std::string test_key(const ResultRow& row) {
  std::string key;
  for (const std::string_view column : kTestColumns) key += std::string(row.text(column)) + '\n';
  return key;
}

bool is_metric(std::string_view column) {
  const auto named = [&](const Field& f) { return f.name == column; };
  return std::any_of(fields().begin(), fields().end(), named) ||
         std::find(kOwnMetrics.begin(), kOwnMetrics.end(), column) != kOwnMetrics.end() ||
         std::any_of(kOwnEndings.begin(), kOwnEndings.end(), [&](std::string_view e) { return column.ends_with(e); });
}

bool is_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

std::string_view ResultRow::text(std::string_view column) const {
  const auto cell = cells.find(column);
  return cell == cells.end() ? std::string_view{} : cell->second;
}

double ResultRow::number(std::string_view column) const {
  const std::string_view cell = text(column);
  double value = kNotMeasured;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return error == std::errc{} && end == cell.data() + cell.size() && std::isfinite(value) ? value : kNotMeasured;
}

std::vector<ResultRow> study_rows(const ResultTable& table) {
  std::vector<ResultRow> rows;
  for (const std::vector<std::string>& cells : table.rows) {
    ResultRow& row = rows.emplace_back();
    for (size_t i = 0; i < cells.size() && i < table.columns.size(); ++i) row.cells[table.columns[i]] = cells[i];
    row.scene = row.text("scene");
    row.kind = row.text("kind");
    row.variant = row.text("variant");
    row.recipe = row.text(kRecipeColumn);
    const std::string_view setting = row.text("setting");
    if (!setting.empty()) row.recipe.append(" ").append(setting);
  }
  return rows;
}

RowValue column_value(std::string column) {
  return [column = std::move(column)](const ResultRow& row) { return row.number(column); };
}

bool any_measured(std::span<const ResultRow> rows, const RowValue& value) {
  return std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) { return !std::isnan(value(row)); });
}

std::vector<std::string> distinct(std::span<const ResultRow> rows, const RowText& text) {
  std::vector<std::string> result;
  for (const ResultRow& row : rows)
    if (const std::string value = text(row); std::find(result.begin(), result.end(), value) == result.end())
      result.push_back(value);
  return result;
}

std::vector<ResultRow> filtered(std::span<const ResultRow> rows, const std::function<bool(const ResultRow&)>& keep) {
  std::vector<ResultRow> result;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(result), keep);
  return result;
}

std::vector<ResultRow> rows_of_recipe(std::span<const ResultRow> rows, std::string_view recipe) {
  return filtered(rows, [&](const ResultRow& row) { return row.recipe == recipe; });
}

std::vector<ChartPoint> group_means(std::span<const ResultRow> rows, const RowText& group, const RowText& series,
                                    const RowValue& value) {
  std::vector<ChartPoint> points;
  for (const ResultRow& row : rows) {
    const double v = value(row);
    if (std::isnan(v)) continue;
    const std::string g = group(row), s = series(row);
    const auto same = [&](const ChartPoint& p) { return p.group == g && p.series == s; };
    auto point = std::find_if(points.begin(), points.end(), same);
    if (point == points.end()) {
      points.push_back({.series = s, .group = g, .y = 0, .low = v, .high = v, .count = 0});
      point = points.end() - 1;
    }
    point->y += v;
    point->low = std::min(point->low, v);
    point->high = std::max(point->high, v);
    ++point->count;
  }
  for (ChartPoint& point : points) point.y /= static_cast<double>(point.count);
  return points;
}

double mean_of(std::span<const ResultRow> rows, const RowValue& value) {
  double sum = 0;
  size_t count = 0;
  for (const ResultRow& row : rows)
    if (const double v = value(row); !std::isnan(v)) {
      sum += v;
      ++count;
    }
  return count == 0 ? kNotMeasured : sum / static_cast<double>(count);
}

double median_of(std::span<const ResultRow> rows, const RowValue& value) {
  std::vector<double> values;
  for (const ResultRow& row : rows)
    if (const double v = value(row); !std::isnan(v)) values.push_back(v);
  if (values.empty()) return kNotMeasured;
  const auto middle = values.begin() + static_cast<ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

PairedRatio paired_ratio(std::span<const ResultRow> rows, std::string_view recipe, std::string_view baseline,
                         const RowValue& value) {
  std::map<std::string, double> base;
  for (const ResultRow& row : rows)
    if (row.recipe == baseline) base.emplace(test_key(row), value(row));
  PairedRatio result;
  double sum = 0;
  for (const ResultRow& row : rows) {
    if (row.recipe != recipe) continue;
    const auto other = base.find(test_key(row));
    const double ratio = other == base.end() ? kNotMeasured : value(row) / other->second;
    if (!(ratio > 0) || !std::isfinite(ratio)) continue;
    sum += std::log(ratio);
    result.low = result.count == 0 ? ratio : std::min(result.low, ratio);
    result.high = result.count == 0 ? ratio : std::max(result.high, ratio);
    ++result.count;
    result.less += ratio < 1;
  }
  if (result.count > 0) result.mean = std::exp(sum / static_cast<double>(result.count));
  return result;
}

double correlation(std::span<const std::pair<double, double>> points) {
  if (points.size() < 3) return kNotMeasured;
  const auto n = static_cast<double>(points.size());
  double mean_x = 0, mean_y = 0;
  for (const auto& [x, y] : points) {
    mean_x += x / n;
    mean_y += y / n;
  }
  double xx = 0, yy = 0, xy = 0;
  for (const auto& [x, y] : points) {
    xx += (x - mean_x) * (x - mean_x);
    yy += (y - mean_y) * (y - mean_y);
    xy += (x - mean_x) * (y - mean_y);
  }
  return xx > 0 && yy > 0 ? xy / std::sqrt(xx * yy) : kNotMeasured;
}

}  // namespace raygrain

#include "report/charts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "report/published.h"

namespace raygrain {

namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kRecipeColours{{
    {"PAH+SPFH", "#d9480f"},
    {"PAH+LSPH", "#b0479a"},
    {"SAH+SPFH", "#2b7bba"},
    {"SAH+LSPH", "#868e96"},
    {kMislabelledRecipe, "#8c6d31"},
}};
constexpr std::array<std::string_view, 9> kOtherColours{"#2f9e44", "#e8890c", "#1098ad", "#7048e8", "#c2255c",
                                                        "#66a80f", "#a0522d", "#4263eb", "#0b7285"};

std::string joined(std::string_view a, std::string_view b) {
  return std::string(a) + (a.empty() || b.empty() ? "" : " ") + std::string(b);
}

/// Those of `first` that are among `found`, then the others in their order.
template <class Names>
std::vector<std::string> in_order(const Names& first, std::vector<std::string> found) {
  std::vector<std::string> names;
  for (const std::string_view name : first)
    if (std::erase(found, name) > 0) names.emplace_back(name);
  std::erase(found, std::string{});
  names.insert(names.end(), found.begin(), found.end());
  return names;
}

bool is_paper_recipe(std::string_view recipe) {
  return published_cost(recipe) != nullptr;
}

const PaperGroup* paper_group(const ResultRow& row) {
  const auto found = std::find_if(kPaperGroups.begin(), kPaperGroups.end(), [&](const PaperGroup& group) {
    return group.kind == row.kind && group.variant == row.variant;
  });
  return found == kPaperGroups.end() ? nullptr : &*found;
}

}  // namespace

bool has_paper_tests(const StudyResults& study) {
  const auto in_group = [](const ResultRow& row) { return paper_group(row) != nullptr; };
  const std::vector<std::string> recipes =
      distinct(filtered(study.rows, in_group), [](const ResultRow& row) { return row.recipe; });
  const auto known = std::count_if(recipes.begin(), recipes.end(), is_paper_recipe);
  return known >= 2 && std::find(recipes.begin(), recipes.end(), kBaseline) != recipes.end();
}

std::string group_label(const ResultRow& row) {
  if (const PaperGroup* group = paper_group(row)) return std::string(group->label);
  const std::string label = joined(row.kind, row.variant);
  return label.empty() ? joined(row.text("area"), row.text("ray_set")) : label;
}

std::vector<std::string> group_labels(std::span<const ResultRow> rows) {
  const std::vector<std::string> found = distinct(rows, group_label);
  std::vector<std::string> labels;
  for (const PaperGroup& group : kPaperGroups)
    if (std::find(found.begin(), found.end(), group.label) != found.end()) labels.emplace_back(group.label);
  for (const std::string& label : found)
    if (std::find(labels.begin(), labels.end(), label) == labels.end()) labels.push_back(label);
  return labels;
}

std::vector<std::string> recipe_names(std::span<const ResultRow> rows) {
  std::array<std::string_view, kRecipeColours.size()> known;
  std::transform(kRecipeColours.begin(), kRecipeColours.end(), known.begin(), [](const auto& c) { return c.first; });
  return in_order(known, distinct(rows, [](const ResultRow& row) { return row.recipe; }));
}

std::vector<std::string> scene_names(std::span<const ResultRow> rows) {
  return in_order(kPaperScenes, distinct(rows, [](const ResultRow& row) { return row.scene; }));
}

size_t paper_scene_count(std::span<const ResultRow> rows, size_t count) {
  return static_cast<size_t>(std::count_if(kPaperScenes.begin(), kPaperScenes.begin() + count, [&](std::string_view s) {
    return std::any_of(rows.begin(), rows.end(), [&](const ResultRow& row) { return row.scene == s; });
  }));
}

std::string scenes_note(std::span<const ResultRow> rows) {
  const size_t count = paper_scene_count(rows, kPaperScenes.size());
  if (count == kPaperScenes.size()) return {};
  return fmt::format("{} of the paper's {} scenes were measured; the published values are means over all of them.",
                     count, kPaperScenes.size());
}

std::string scenes_sentence(std::span<const ResultRow> rows) {
  return fmt::format(" It rests on {}, {} of the paper's {}.", counted(scene_names(rows).size(), "scene"),
                     paper_scene_count(rows, kPaperScenes.size()), kPaperScenes.size());
}

std::vector<std::string> own_recipes(const StudyResults& study) {
  std::vector<std::string> recipes = distinct(study.rows, [](const ResultRow& row) { return row.recipe; });
  std::erase_if(recipes, [](const std::string& recipe) { return recipe.empty() || is_paper_recipe(recipe); });
  return recipes;
}

std::string baseline_recipe(const StudyResults& study) {
  const std::vector<std::string> recipes = distinct(study.rows, [](const ResultRow& row) { return row.recipe; });
  for (const std::string& wanted : {study.baseline, std::string(kBaseline)})
    if (!wanted.empty() && std::find(recipes.begin(), recipes.end(), wanted) != recipes.end()) return wanted;
  const auto near =
      std::find_if(recipes.begin(), recipes.end(), [](const std::string& r) { return r.starts_with(kBaseline); });
  if (near != recipes.end()) return *near;
  const auto standard =
      std::find_if(recipes.begin(), recipes.end(), [](const std::string& r) { return r.starts_with("SAH+"); });
  if (standard != recipes.end()) return *standard;
  if (std::string tuned = default_recipe(study); !tuned.empty()) return tuned;
  return recipes.empty() ? std::string{} : recipes.front();
}

std::vector<ChartSeries> coloured(const std::vector<std::string>& names) {
  std::vector<ChartSeries> series;
  size_t others = 0;
  for (const std::string& name : names) {
    const auto known =
        std::find_if(kRecipeColours.begin(), kRecipeColours.end(), [&](const auto& c) { return c.first == name; });
    const std::string_view colour =
        known != kRecipeColours.end() ? known->second : kOtherColours[others++ % kOtherColours.size()];
    series.push_back({name, std::string(colour)});
  }
  return series;
}

double nanoseconds_per_ray(const ResultRow& row) {
  const double seconds = row.number("ray_seconds");
  return std::isnan(seconds) ? row.number("trace_seconds") * 1e9 / row.number("rays") : seconds * 1e9;
}

ChartPanel line_panel(std::span<const ResultRow> rows, const std::string& title, const RowText& series,
                      const std::pair<ChartAxis, RowValue>& x, const std::pair<ChartAxis, RowValue>& y) {
  ChartPanel panel{.title = title, .kind = ChartKind::kLines, .x = x.first, .y = y.first};
  const auto fits = [](const std::pair<ChartAxis, RowValue>& axis, const ResultRow& row) {
    const double value = axis.second(row);
    return std::isfinite(value) && (value > 0 || !axis.first.logarithmic);
  };
  const std::vector<ResultRow> shown =
      filtered(rows, [&](const ResultRow& row) { return fits(x, row) && fits(y, row); });
  // Colours as in the other panels of the chart, whose rows may have more values.
  const std::vector<std::string> names = distinct(shown, series);
  for (ChartSeries& s : coloured(distinct(rows, series)))
    if (std::find(names.begin(), names.end(), s.name) != names.end()) panel.series.push_back(std::move(s));
  panel.measured = group_means(
      shown, [&](const ResultRow& row) { return fmt::format("{}", x.second(row)); }, series, y.second);
  for (ChartPoint& point : panel.measured) point.x = std::stod(std::exchange(point.group, {}));
  return panel;
}

std::vector<ResultRow> main_rays(std::span<const ResultRow> rows) {
  const std::vector<std::string> sets =
      distinct(rows, [](const ResultRow& row) { return std::string(row.text("ray_set")); });
  const bool matched = std::find(sets.begin(), sets.end(), "matched") != sets.end();
  const std::string chosen = matched || sets.empty() ? "matched" : sets.front();
  return sets.size() < 2 ? std::vector<ResultRow>(rows.begin(), rows.end())
                         : filtered(rows, [&](const ResultRow& row) { return row.text("ray_set") == chosen; });
}

ChartPanel group_bars(std::span<const ResultRow> rows, const std::vector<std::string>& recipes,
                      const std::string& title, const std::string& axis, const RowValue& value) {
  ChartPanel panel{.title = title, .y = {axis}};
  const std::vector<ResultRow> shown = filtered(rows, [&](const ResultRow& row) {
    return std::find(recipes.begin(), recipes.end(), row.recipe) != recipes.end() && !std::isnan(value(row));
  });
  panel.groups = group_labels(shown);
  panel.series = coloured(recipes);
  panel.measured = group_means(
      shown, group_label, [](const ResultRow& row) { return row.recipe; }, value);
  return panel;
}

std::vector<ChartPanel> user_bars(std::span<const ResultRow> rows, const std::vector<std::string>& recipes) {
  std::vector<ChartPanel> panels;
  const RowValue pruned = column_value("pruned_cost");
  if (any_measured(rows, pruned))
    panels.push_back(group_bars(rows, recipes, "What users pay: pruned cost", "mean pruned cost per ray", pruned));
  if (any_measured(rows, nanoseconds_per_ray))
    panels.push_back(group_bars(rows, recipes, "What users pay: time", "mean time per ray in ns", nanoseconds_per_ray));
  return panels;
}

std::vector<RankedRecipe> ranking(std::span<const ResultRow> rows, const std::string& baseline, const RowValue& value) {
  std::vector<RankedRecipe> ranked;
  const std::vector<ResultRow> compared = most_comparable(rows, baseline, positive(value));
  for (const std::string& recipe : recipe_names(compared))
    if (const PairedRatio ratio = paired_ratio(compared, recipe, baseline, value); ratio.count > 0)
      ranked.push_back({recipe, ratio});
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const RankedRecipe& a, const RankedRecipe& b) { return a.ratio.mean < b.ratio.mean; });
  return ranked;
}

std::string short_number(double value) {
  if (std::isnan(value)) return "-";
  if (value == 0 || std::abs(value) >= 1e6 || std::abs(value) < 1e-4) return fmt::format("{:.3g}", value);
  const int before = static_cast<int>(std::floor(std::log10(std::abs(value)))) + 1;
  return fmt::format("{:.{}f}", value, std::clamp(3 - before, 0, 6));
}

std::string percent(double share) {
  return short_number(share * 100) + " %";
}

std::string counted(size_t count, std::string_view thing) {
  return fmt::format("{} {}{}", count, thing, count == 1 ? "" : "s");
}

std::string user_sentence(const StudyResults& study, const std::string& recipe, const std::string& baseline) {
  const PairedRatio pruned = paired_ratio(study.rows, recipe, baseline, column_value("pruned_cost"));
  const PairedRatio time = paired_ratio(study.rows, recipe, baseline, nanoseconds_per_ray);
  if (pruned.count == 0) return {};
  std::string text = fmt::format("users pay {} times the pruned cost of {}", short_number(pruned.mean), baseline);
  if (time.count > 0) text += fmt::format(" and {} times its time", short_number(time.mean));
  return text + fmt::format(" (geometric mean of {})", counted(pruned.count, "test"));
}

Verdict verdict_of(size_t agreeing, size_t all) {
  if (all == 0) return Verdict::kMissing;
  if (agreeing == all) return Verdict::kConfirms;
  return 2 * agreeing >= all ? Verdict::kPartly : Verdict::kContradicts;
}

const char* name(Verdict verdict) {
  switch (verdict) {
    case Verdict::kConfirms:
      return "confirms";
    case Verdict::kPartly:
      return "partly confirms";
    case Verdict::kContradicts:
      return "contradicts";
    case Verdict::kExtends:
      return "goes beyond the paper";
    case Verdict::kIncomparable:
      return "not comparable";
    case Verdict::kMissing:
      return "not measured";
  }
  return "";
}

std::string id_of(std::string_view text) {
  std::string id;
  for (const char c : text) {
    if ((c >= 'a' && c <= 'z') || (c >= '0' && c <= '9'))
      id += c;
    else if (c >= 'A' && c <= 'Z')
      id += static_cast<char>(c - 'A' + 'a');
    else if (!id.empty() && id.back() != '-')
      id += '-';
  }
  while (id.ends_with('-')) id.pop_back();
  return id.empty() ? "study" : id;
}

}  // namespace raygrain

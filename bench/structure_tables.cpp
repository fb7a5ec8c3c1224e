// The figures of the suite `structures` as tables in Markdown.
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

#include <fmt/format.h>

#include "structure_rows.h"

namespace raygrain::bench {
namespace {

struct Named {
  std::string key, title;
};

const std::vector<Named> kRays{{"sun_any", "sun, any hit"},
                               {"sun_closest_shuffled", "sun, closest, shuffled"},
                               {"point_any", "lamp, any hit"},
                               {"pinhole_closest_shuffled", "pinhole, closest, shuffled"},
                               {"disc_any_0.27", "disc, 0.27 degrees"},
                               {"disc_any_5", "disc, 5 degrees"}};
/// One set for each kind of area: what its structures take.
const std::vector<Named> kAreas{{"sun_any", "sun"},
                                {"point_any", "lamp, six frusta"},
                                {"pinhole_closest_shuffled", "camera"},
                                {"disc_any_0.27", "disc, 0.27 degrees"},
                                {"disc_any_5", "disc, 5 degrees"}};
/// Columns: STRUCTURE/API.
const std::vector<Named> kStructures{{"coverage/single", "coverage"},
                                     {"coverage/batch", "coverage, batch"},
                                     {"tree in ray space/single", "tree in ray space"},
                                     {"tree in the world/single", "tree in the world"},
                                     {"ray space, accelerator/single", "ray space, accelerator"},
                                     {"world, accelerator/single", "world, accelerator"},
                                     {"global tree/single", "global tree"},
                                     {"global tree/array", "global tree, array"}};
const std::vector<Named> kBuilt{{"global tree/single", "global tree"},
                                {"coverage/single", "coverage"},
                                {"tree in ray space/single", "tree in ray space"},
                                {"tree in the world/single", "tree in the world"}};
const std::vector<Named> kGrids{{"coverage", "two levels, 0.25 cells a triangle (kept)"},
                                {"two levels, 1", "two levels, 1 cell"},
                                {"flat grid, 0.25", "flat grid, 0.25 cells"},
                                {"flat grid, 1", "flat grid, 1 cell"}};

using Rows = std::vector<const StructureRow*>;
using Figure = std::function<std::optional<double>(const StructureRow&)>;

std::optional<double> positive(double x) {
  return x > 0 ? std::optional(x) : std::nullopt;
}
std::optional<double> ratio(double a, double b) {
  return a > 0 && b > 0 ? std::optional(a / b) : std::nullopt;
}

/// Of a set's rows those of one structure and api, scene by scene.
Rows choose(const Rows& rows, const std::string& rays, const std::string& structure) {
  Rows chosen;
  for (const StructureRow* row : rows)
    if (row->rays == rays && row->structure + "/" + row->api == structure) chosen.push_back(row);
  return chosen;
}

/// "1.2 / 3.4 / 5.6", scene by scene; empty where nothing was measured.
std::string list(const Rows& rows, int digits, const Figure& figure) {
  std::string text;
  for (const StructureRow* row : rows)
    if (const std::optional<double> x = figure(*row))
      text += fmt::format("{}{:.{}f}", text.empty() ? "" : " / ", *x, digits);
  return text;
}

std::string mean(const Rows& rows, const Figure& figure) {
  double sum = 0;
  int count = 0;
  for (const StructureRow* row : rows)
    if (const std::optional<double> x = figure(*row)) sum += std::log(*x), ++count;
  return count == 0 ? "" : fmt::format("{:.2f}", std::exp(sum / count));
}

void print_line(const std::string& first, const std::vector<std::string>& cells) {
  fmt::print("| {} |", first);
  for (const std::string& cell : cells) fmt::print(" {} |", cell);
  fmt::print("\n");
}

void print_head(const std::string& first, const std::vector<Named>& columns, const std::vector<std::string>& more) {
  std::vector<std::string> titles;
  for (const Named& column : columns) titles.push_back(column.title);
  titles.insert(titles.end(), more.begin(), more.end());
  print_line(first, titles);
  fmt::print("|---|");
  for (size_t i = 0; i < titles.size(); ++i) fmt::print("---|");
  fmt::print("\n");
}

void print_times(const Rows& rows) {
  print_head("nanoseconds a ray", kStructures, {"Embree, single", "Embree, best mode"});
  for (const Named& rays : kRays) {
    std::vector<std::string> cells;
    for (const Named& structure : kStructures)
      cells.push_back(list(choose(rows, rays.key, structure.key), 0,
                           [](const StructureRow& r) { return positive(r.nanoseconds); }));
    const Rows any = choose(rows, rays.key, "global tree/single");
    cells.push_back(list(any, 0, [](const StructureRow& r) { return positive(r.embree_single_nanoseconds); }));
    cells.push_back(list(any, 0, [](const StructureRow& r) { return positive(r.embree_best_nanoseconds); }));
    print_line(rays.title, cells);
  }
}

/// Single calls against Embree's single rays, batches and arrays against its best mode.
void print_ratios(const Rows& rows) {
  print_head("times Embree (means)", kStructures, {});
  for (const Named& rays : kRays) {
    std::vector<std::string> cells;
    for (const Named& structure : kStructures)
      cells.push_back(mean(choose(rows, rays.key, structure.key), [](const StructureRow& r) {
        return ratio(r.api == "single" ? r.embree_single_nanoseconds : r.embree_best_nanoseconds, r.nanoseconds);
      }));
    print_line(rays.title, cells);
  }
}

void print_costs(const Rows& rows) {
  print_head("build and memory", kBuilt, {});
  const auto print = [&](const std::string& title, const std::string& rays, int digits, const Figure& figure) {
    std::vector<std::string> cells;
    for (const Named& structure : kBuilt) cells.push_back(list(choose(rows, rays, structure.key), digits, figure));
    print_line(title, cells);
  };
  for (const Named& area : kAreas) {
    print(area.title + ": seconds", area.key, 3, [](const StructureRow& r) { return positive(r.build_seconds); });
    print("... of the global tree's", area.key, 2,
          [](const StructureRow& r) { return ratio(r.build_seconds, r.global_build_seconds); });
    print("... MiB", area.key, 1,
          [](const StructureRow& r) { return positive(static_cast<double>(r.memory_bytes) / 1048576); });
    print("... of the global tree's", area.key, 2, [](const StructureRow& r) {
      return ratio(static_cast<double>(r.memory_bytes), static_cast<double>(r.global_bytes));
    });
  }
}

void print_grids(const Rows& rows) {
  print_head("cells", kGrids, {});
  const auto print = [&](const std::string& title, const Named& rays, const std::string& api, int digits,
                         const Figure& figure) {
    std::vector<std::string> cells;
    for (const Named& grid : kGrids)
      cells.push_back(list(choose(rows, rays.key, grid.key + "/" + api), digits, figure));
    print_line(title, cells);
  };
  for (const std::string api : {"batch", "single"})
    for (size_t i = 0; i < 4; ++i)
      print(kRays[i].title + ", " + api + ": ns", kRays[i], api, 0,
            [](const StructureRow& r) { return positive(r.nanoseconds); });
  for (size_t i = 0; i < 3; ++i) {
    print(kAreas[i].title + ": bytes a triangle", kAreas[i], "batch", 0, [](const StructureRow& r) {
      return ratio(static_cast<double>(r.memory_bytes), static_cast<double>(r.triangles));
    });
    print(kAreas[i].title + ": seconds", kAreas[i], "batch", 3,
          [](const StructureRow& r) { return positive(r.build_seconds); });
  }
}

/// Procedural scenes of one size stand in one table, models each in their own.
std::string group_of(const StructureRow& row) {
  for (const std::string size : {" 100k", " 1M"})
    if (row.scene.ends_with(size)) return size.substr(1);
  return row.scene;
}

/// "100k, 1 thread: city 100k (108051 triangles) / forest 100k ...".
void print_caption(const std::string& group, const Rows& rows, unsigned threads) {
  std::string scenes;
  for (const StructureRow* row : choose(rows, kRays.front().key, "global tree/single"))
    scenes += fmt::format("{}{} ({} triangles)", scenes.empty() ? "" : " / ", row->scene, row->triangles);
  fmt::print("{}, {} thread{}: {}\n\n", group, threads, threads == 1 ? "" : "s", scenes);
}

void print_structures(const Rows& rows) {
  print_times(rows);
  fmt::print("\n");
  print_ratios(rows);
  fmt::print("\n");
  print_costs(rows);
}

template <class T, class Of>
std::vector<T> different(std::span<const StructureRow> rows, const Of& of) {
  std::vector<T> values;
  for (const StructureRow& row : rows)
    if (const T value = of(row); std::ranges::find(values, value) == values.end()) values.push_back(value);
  return values;
}

/// Between marks, so that a script can put it into a document; for each size of scenes and each number of threads.
void print_block(const std::string& name, std::span<const StructureRow> rows,
                 const std::function<void(const Rows&)>& print) {
  fmt::print("\n<!-- structures:{} -->\n", name);
  const char* gap = "";
  for (const unsigned threads : different<unsigned>(rows, [](const StructureRow& r) { return r.threads; })) {
    for (const std::string& group : different<std::string>(rows, group_of)) {
      Rows chosen;
      for (const StructureRow& row : rows)
        if (row.threads == threads && group_of(row) == group) chosen.push_back(&row);
      fmt::print("{}", gap);
      print_caption(group, chosen, threads);
      print(chosen);
      gap = "\n";
    }
  }
  fmt::print("<!-- /structures:{} -->\n", name);
}

}  // namespace

void print_structure_tables(std::span<const StructureRow> rows) {
  size_t differences = 0;
  for (const StructureRow& row : rows) differences += row.differences;
  fmt::print("\nanswers that are not the global tree's: {}\n", differences);
  print_block("pays", rows, print_structures);
  print_block("cells", rows, print_grids);
}

}  // namespace raygrain::bench

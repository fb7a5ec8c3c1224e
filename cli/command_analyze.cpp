// raygrain analyze: all metrics of one tree, of the rays through it and of the top level; per node on request.
#include <cmath>
#include <memory>
#include <ostream>

#include <fmt/format.h>

#include "raygrain/analyze.h"
#include "raygrain/io.h"
#include "raygrain/rays.h"

#include "cli/commands.h"
#include "cli/one_tree.h"
#include "cli/rows.h"

namespace raygrain::cli {

namespace {

constexpr uint64_t kMostRays = 1'000'000'000;

struct Options {
  TreeOptions tree;
  std::string nodes;  // CSV
  uint64_t rays = 10000;
};

void merge(FieldValues& values, const FieldValues& more) {
  for (size_t i = 0; i < fields().size(); ++i)
    if (more.has(FieldId{i})) values[FieldId{i}] = more[FieldId{i}];
}

/// What the area's own rays pay in the tree, with the global tree behind it.
void add_rays(FieldValues& values, const OneTree& tree, const Scene& scene, const Options& options) {
  const unsigned threads = options.tree.common.thread_count();
  const AreaGeometry geometry(*tree.area);
  const std::vector<Ray> rays = cast_rays(AreaRays{.area = *tree.area}, options.rays, options.tree.seed);
  std::vector<Ray> served;
  for (const Ray& ray : rays)
    if (geometry.serves(ray)) served.push_back(ray);
  const Bvh global = build_global_tree(scene.mesh, parse_recipe("SAH+LSPH", tree.registry), tree.registry);
  const LocalTree local{*tree.area, tree.tree, tree.log, 0};
  const TraceStats trace = analyze_rays(*tree.tree, scene.mesh, served, {}, threads);
  const FallbackStats fallback = analyze_fallback(local, global, scene.mesh, rays, {}, threads);
  merge(values, collect_fields(analyze(*tree.tree, tree.measure()), nullptr, nullptr, &trace, &fallback));
}

/// How sharply the top level over all areas answers for points where the rays of this area start.
void add_top_level(FieldValues& values, const OneTree& tree, std::span<const InfluenceArea> areas,
                   const Options& options) {
  std::vector<ConvexRegion> regions;
  for (const InfluenceArea& area : areas) regions.push_back(AreaGeometry(area).region());
  const AreaRays caster{.area = *tree.area, .start = RayStart::kRandomDepth};
  std::vector<Vec3> points;
  for (const Ray& ray : cast_rays(caster, options.rays, options.tree.seed)) points.push_back(ray.origin);
  merge(values, collect_fields(analyze_top_level(regions, {}, points)));
}

/// RFC 4180; what does not exist is left empty.
void save_node_table(const NodeTable& table, const std::string& path) {
  write_file_atomically(path, [&](std::ostream& out) {
    for (size_t i = 0; i < table.columns.size(); ++i) out << (i ? "," : "") << table.columns[i];
    out << "\r\n";
    for (const std::vector<double>& row : table.rows) {
      for (size_t i = 0; i < row.size(); ++i)
        out << (i ? "," : "") << (std::isnan(row[i]) ? "" : fmt::format("{}", row[i]));
      out << "\r\n";
    }
  });
}

void save_nodes(const OneTree& tree, const std::string& path) {
  std::optional<AreaGeometry> geometry;
  if (tree.area) geometry.emplace(*tree.area);
  save_node_table(tabulate_nodes(*tree.tree, tree.measure(), geometry ? &*geometry : nullptr, &tree.log), path);
}

int analyze_tree(const Options& options) {
  check_tree_options(options.tree, default_registry());
  const Output output(options.tree.common);
  require_writable(options.nodes);
  Progress progress(!options.tree.common.quiet);
  const Scene scene = open_scene(options.tree.scene, progress);
  const std::vector<InfluenceArea> areas = choose_areas(options.tree.areas, scene, output);
  const OneTree tree = build_one_tree(options.tree, scene, areas, progress);

  progress.show("measure the tree", 0.3);
  ReportRow row = tree.row();
  progress.show("trace rays", 0.5);
  if (tree.area) add_rays(row.values, tree, scene, options);
  if (tree.area) add_top_level(row.values, tree, areas, options);
  if (!options.nodes.empty()) save_nodes(tree, options.nodes);
  progress.erase();

  output.save_json(
      rows_json(scene.name, scene.mesh.triangle_count(), options.tree.seed, options.tree.common, {&row, 1}));
  output.print(fmt::format("{}, {}{}\n{}", scene.name, row.name, row.area.empty() ? "" : " for " + row.area,
                           row_listing(row) + tree.peak_line() + tree.sample_line()));
  if (!options.nodes.empty()) output.note("Written:\n  " + options.nodes + "\n");
  return kSuccess;
}

}  // namespace

Action declare_analyze(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  add_tree_options(arguments, options->tree);
  arguments.file("--tree", "FILE.rgt", options->tree.file, "Analyze this built tree in place of a new one");
  arguments.whole("--rays", options->rays, {1, kMostRays}, "Rays of the area to trace");
  arguments.output("--nodes", "FILE.csv", options->nodes, "Write a row for each node");
  add_common(arguments, options->tree.common);
  return [options] { return analyze_tree(*options); };
}

}  // namespace raygrain::cli

// raygrain build: one tree, written as JSON, with its statistics.
#include <memory>

#include <fmt/format.h>

#include "raygrain/io.h"

#include "cli/commands.h"
#include "cli/one_tree.h"
#include "cli/rows.h"
#include "cli/tree_file.h"

namespace raygrain::cli {

namespace {

struct Options {
  TreeOptions tree;
  std::string output;
};

int build(const Options& options) {
  check_tree_options(options.tree, default_registry());
  const Output output(options.tree.common);
  require_writable(options.output);
  Progress progress(!options.tree.common.quiet);
  const Scene scene = open_scene(options.tree.scene, progress);
  const OneTree tree = build_one_tree(options.tree, scene, choose_areas(options.tree.areas, scene, output), progress);

  progress.show("measure the tree", 0.5);
  const ReportRow row = tree.row();
  const std::string json =
      rows_json(scene.name, scene.mesh.triangle_count(), options.tree.seed, options.tree.common, {&row, 1});
  if (is_tree_file(options.output))
    save_tree(*tree.tree, options.output);
  else
    save_tree_json(*tree.tree, json, options.output);
  progress.erase();
  output.save_json(json);
  output.print(fmt::format("{}, {}{}\n{}", scene.name, row.name, row.area.empty() ? "" : " for " + row.area,
                           row_listing(row) + tree.peak_line() + tree.sample_line()));
  output.note("Written:\n  " + options.output + "\n");
  return kSuccess;
}

}  // namespace

Action declare_build(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  add_tree_options(arguments, options->tree);
  arguments.output("-o,--output", "FILE", options->output,
                   "Where to write the tree: TREE.rgt for --tree and refit, else JSON");
  arguments.require("--output");
  add_common(arguments, options->tree.common);
  return [options] { return build(*options); };
}

}  // namespace raygrain::cli

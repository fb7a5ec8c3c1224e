// raygrain refit: fits a built tree to vertices that moved, and says what it is worth then.
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/refine.h"

#include "cli/commands.h"
#include "cli/open_scene.h"
#include "cli/output.h"
#include "cli/tree_file.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

constexpr double kRebuild = 1.3;  // above it a new tree pays for most scenes

struct Options {
  CommonOptions common;
  std::string scene, tree, output;
};

/// Refit trusts that the scene is the old one but for its vertices: at least every triangle must be there.
void check_fit(const Bvh& tree, const std::vector<Bounds>& bounds, const std::string& path) {
  if (const auto defect = find_defect(tree, bounds))
    throw Error(ErrorCode::kMalformed, path, "this tree is not one of this scene: " + *defect,
                "Build a tree of the whole scene");
}

int refit_tree(const Options& options) {
  if (!is_tree_file(options.output))
    fail_usage("--output", "'" + options.output + "' is no name of a tree file", "Give a name that ends with .rgt");
  const Output output(options.common);
  require_writable(options.output);
  Progress progress(!options.common.quiet);
  const Scene scene = open_scene(options.scene, progress);
  progress.show("fit the tree", 0.5);
  Bvh tree = load_tree(options.tree);
  const std::vector<Bounds> bounds = triangle_bounds(scene.mesh);
  RefitResult result;
  try {
    result = refit(tree, bounds);
  } catch (const Error& error) {
    throw Error(ErrorCode::kMalformed, options.tree, error.message, "Build the tree again");
  }
  check_fit(tree, bounds, options.tree);
  save_tree(tree, options.output);
  progress.erase();

  const bool rebuild = result.ratio() > kRebuild;
  const nlohmann::ordered_json report{{"scene", scene.name},
                                      {"cost_before", result.cost_before},
                                      {"cost_after", result.cost_after},
                                      {"ratio", result.ratio()},
                                      {"rebuild", rebuild}};
  output.save_json(report.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  output.print(fmt::format("{}: estimated cost {:.2f} before, {:.2f} now: {:.3f} times. {}\n", scene.name,
                           result.cost_before, result.cost_after, result.ratio(),
                           rebuild ? "A new tree would pay." : "Good enough to keep."));
  output.note("Written:\n  " + options.output + "\n");
  return kSuccess;
}

}  // namespace

Action declare_refit(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("SCENE", options->scene, kSceneHelp);
  arguments.file("--tree", "OLD.rgt", options->tree, "A tree of the whole scene, from before its vertices moved");
  arguments.require("--tree");
  arguments.output("-o,--output", "NEW.rgt", options->output, "Where to write the tree that fits");
  arguments.require("--output");
  add_common(arguments, options->common);
  arguments.footer(
      "Costs are estimated under SAH. Trees with split references (spatial, --quality best) cannot be fitted.");
  return [options] { return refit_tree(*options); };
}

}  // namespace raygrain::cli

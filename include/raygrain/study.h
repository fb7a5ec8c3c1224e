// Studies: grids of experiments whose rows go to a CSV file as they finish, resume after a kill, and do not depend on
// the number of jobs.
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/area.h"
#include "raygrain/mesh.h"
#include "raygrain/rays.h"
#include "raygrain/registry.h"

namespace raygrain {

// --- Any study: tasks that each give one row. ---

/// What tells one row from all others of a study. Rows are sorted by it, text by text, then number by number.
struct StudyKey {
  std::string scene = {}, kind = {}, variant = {};  // kind: plane, point or empty; variant: which area
  std::string combo = {}, setting = {};             // the recipe, and what about it is not the default
  std::string ray_set = {};                         // which rays
  uint64_t seed = 1, repeat = 1;

  friend auto operator<=>(const StudyKey&, const StudyKey&) = default;  // NOLINT(modernize-use-nullptr): its mistake
};

/// A column of results.csv beside the key's. Those that are not deterministic (times) differ from run to run.
struct StudyColumn {
  std::string name;
  bool deterministic = true;
};

/// A number as studies write it: the shortest decimal that reads back as the same double; empty for NaN.
std::string study_cell(double value);

/// One row to be. `run` returns a cell per column; it is called once, from any thread, and must depend on nothing but
/// its own input.
struct StudyTask {
  StudyKey key;
  std::function<std::vector<std::string>()> run;
  double weight = 1;  // about how long it takes, compared with the others: for the progress
};

struct Study {
  std::string name;
  std::vector<StudyColumn> columns;
  std::vector<StudyTask> tasks;
  std::string identity;              // whatever else decides the numbers; a run resumes only where it is the same
  std::vector<std::string> missing;  // what was left out, each with its reason: for people

  void add(const StudyKey& key, std::function<std::vector<std::string>()> run, double weight = 1);
};

/// Written into every row, so that rows of several machines can be told apart.
struct StudyEnvironment {
  std::string commit, compiler, cpu;
};

struct StudyRunOptions {
  std::string folder;  // gets results.csv, and results.partial.csv while the study runs
  unsigned jobs = 1;   // rows at a time; 0 = all cores
  StudyEnvironment environment = {};
  /// Told after each row which one was finished and the finished share in [0, 1]; false stops after the rows in
  /// progress (Error kCancelled; the next run goes on). Never called by two threads at once.
  std::function<bool(const std::string& step, double done)> progress = {};
};

/// The finished table, as in results.csv: header, then rows sorted by key.
struct StudyTable {
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;

  /// The index of a column. Throws Error (kNotFound).
  size_t column(const std::string& name) const;
  /// NaN for an empty cell. Throws Error (kMalformed) for a cell that is no number.
  double number(size_t row, size_t column) const;
};

/// Runs what the folder does not hold yet. Each finished row is appended to results.partial.csv and brought to the
/// disk; at the end all rows go, sorted, to results.csv, and the partial file is removed. A killed run loses the rows
/// in progress, no others: call again with the same study. study.txt keeps which study the folder belongs to: finished
/// results of another one are never overwritten. Times are of one row among `jobs` others: compare times of runs with
/// one job only.
///
/// Throws Error: kUsage (two tasks with one key; a name with control characters; the folder holds results, or an
/// unfinished run, of another study or of the same with other options, or is in use by another run), kNotFound (no
/// rows, since what they need is missing), kMalformed (a damaged partial file), kUnwritable, kCancelled; and what tasks
/// throw, naming the row.
StudyTable run_study(const Study& study, const StudyRunOptions& options);

/// What a table of trees says, line by line, for people: mean costs of each recipe over its tests, together with those
/// that have the same ones, and how far PAH's and SAH's predictions were off. Nothing for other tables.
std::vector<std::string> study_summary(const StudyTable& table);

/// Mean over the rows of a kind ("plane", "point"), combo and ray set of |real - estimated| / estimated, by `estimate`
/// ("estimated_pah", "estimated_sah"); NaN without such rows. An empty text stands for any.
double prediction_error(const StudyTable& table, const std::string& estimate, const std::string& kind,
                        const std::string& combo = {}, const std::string& ray_set = {});

/// Reads results.csv. Throws Error: kNotFound, kUnreadable, kMalformed with the line.
StudyTable load_study_table(const std::string& path);

// --- Grids of trees: scenes x areas x recipes x ray sets x seeds x repeats. ---

struct StudyArea {
  std::string variant;  // its name in the rows
  InfluenceArea area;
};

/// The mesh is loaded when its first row runs.
struct StudyScene {
  std::string name;
  std::function<TriangleMesh()> load;
  std::vector<StudyArea> areas;
  double weight = 1;  // about how many triangles, compared with the other scenes: for the progress
  /// Stands for the model, whose numbers decide those of the rows, as a checksum does: a run resumes only where it is
  /// the same.
  std::string content = {};
};

/// A tree to build. `combo` and `setting` are its names in the rows.
struct StudyRecipe {
  std::string combo, setting;
  Recipe recipe;
  bool reinsert = false;  // improve the finished tree by reinsertion under its own measure
  /// In ray space, with the measure of a frame's xy area in place of the recipe's: of the frames that suit the area,
  /// the one that predicts the least cost. The builder is the recipe's.
  bool in_frame = false;
  bool visible = false;  // sample rays, for recipes that have them, end at their first hit
};

/// Rays of each area: near-plane-uniform by default, `count` for each seed.
struct StudyRays {
  std::string name = "matched";
  PointSpread spread = PointSpread::kNearPlane;
  size_t count = 1000;
};

/// How each row of a grid is made, for experiments that are to break the rules of the exactness contract or of the
/// builders. An empty function means the default named beside it. Called from several threads.
struct StudyRules {
  /// The area that a recipe is really built and measured for: the area as it is.
  std::function<InfluenceArea(const StudyScene&, const StudyArea&, const StudyRecipe&)> area;
  /// The tree behind all local ones: StudyGrid::global.
  std::function<Bvh(const TriangleMesh&)> global_tree;
  /// Sets tree (its leaves hold indices of the mesh's triangles), log and measure: build_local_tree with the recipe.
  /// Called with what `area` gave.
  std::function<LocalTree(const TriangleMesh&, const InfluenceArea&, const StudyRecipe&)> local_tree;
  /// The rays of a row: StudyRays. Called with what `area` gave.
  std::function<std::vector<Ray>(const StudyScene&, const StudyArea&, const StudyRecipe&, const StudyRays&,
                                 uint64_t seed)>
      rays;
  /// Makes, once a row, the rule that says which rays search the local tree: those that the area serves.
  std::function<std::function<bool(const Ray&)>(const InfluenceArea&)> serves;
  /// Is a hit in the local tree taken for the nearest of all? Those before the ray leaves the region.
  std::function<bool(const InfluenceArea&, const Ray&, const Hit&)> accepts;
};

struct StudyGrid {
  std::string name;
  std::vector<StudyScene> scenes;
  std::vector<StudyRecipe> recipes;
  std::vector<StudyRays> rays{StudyRays{}};
  std::vector<uint64_t> seeds{1};
  uint32_t repeats = 1;
  Recipe global{"SAH", "LSPH", "paper", {}};  // of the tree behind every local one
  Registry registry = default_registry();     // add own measures and orientations here
  CostModel costs;
  /// Rows to leave out; empty: none.
  std::function<bool(const StudyScene&, const StudyArea&, const StudyRecipe&, const StudyRays&)> leave_out = {};
  StudyRules rules = {};
  std::vector<std::string> missing = {};
  /// Text of what else decides the numbers, like a file of measures: a run resumes only where it is the same.
  std::string source = {};
};

/// One task per row of the grid. Throws Error, before any row runs: kUsage for a grid without scenes, recipes, rays,
/// seeds or repeats, names that are there twice, parameters out of range, and recipes that the registry does not know
/// or an area cannot serve; kNotFound where all scenes are missing; kLimit above a million rows.
Study make_study(const StudyGrid& grid);

/// The columns of every grid, in order; docs/formats.md has their meanings.
std::vector<StudyColumn> grid_columns();

// --- Ready-made studies of the paper's evaluation. ---

struct StudySources {
  std::string scenes = {};             // the folder of the paper's models; empty or missing: what needs it is left out
  std::vector<std::string> only = {};  // names of scenes; empty: all
  size_t rays = 1000;                  // per area
  uint64_t seed = 1;
  bool quick = false;  // few rows of each kind: for tests
};

struct StudyPreset {
  std::string name, description;
};
/// paper, published, corrected, parameters, areas, memory, scaling, stress, visibility.
std::vector<StudyPreset> study_presets();

/// The grid behind paper, published, corrected, parameters and scaling, for changes and additions of one's own. Throws
/// Error (kUsage).
StudyGrid preset_grid(const std::string& name, const StudySources& sources);

/// A preset by name. Throws Error (kUsage) for unknown names of studies and scenes.
Study preset_study(const std::string& name, const StudySources& sources);

/// A grid from a JSON file (format raygrain-study; docs/formats.md). Mesh files are searched beside the file, then in
/// sources.scenes. Throws Error: kNotFound, kUnreadable, kMalformed, kUnsupported, naming the place; kUsage for names
/// in sources.only that the file does not have, only.
StudyGrid load_study_grid(const std::string& path, const StudySources& sources);

}  // namespace raygrain

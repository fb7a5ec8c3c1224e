// raygrain study: a grid of experiments into a folder, resumable.
#include <cmath>
#include <filesystem>
#include <memory>

#include <fmt/format.h>

#include "raygrain/error.h"
#include "raygrain/report.h"
#include "raygrain/study.h"

#include "base/timer.h"
#include "cli/commands.h"
#include "cli/file_names.h"
#include "cli/output.h"
#include "cli/progress.h"

namespace raygrain::cli {

namespace {

constexpr uint64_t kMostRays = 100'000'000, kMostJobs = 1024;

struct Options {
  std::string study, scenes, folder;  // no folder: one below study/ that is named as the study
  std::vector<std::string> only;
  uint64_t rays = 1000, seed = 1, jobs = 1;
  bool quick = false, quiet = false;
};

bool is_file(const std::string& study) {
  return std::filesystem::path(study).extension() == ".json";
}

Study choose_study(const Options& options) {
  const StudySources sources{options.scenes, options.only, options.rays, options.seed, options.quick};
  return is_file(options.study) ? make_study(load_study_grid(options.study, sources))
                                : preset_study(options.study, sources);
}

std::string duration(double seconds) {
  const auto whole = static_cast<uint64_t>(std::llround(seconds));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

/// "3 min 20 s left, Wood plane parallel PAH+SPFH": a terminal cuts long names off, not the time. What an earlier run
/// did says nothing about the speed of this one.
std::function<bool(const std::string&, double)> shower(Progress& progress) {
  struct State {
    Timer timer;
    double begun = -1;
  };
  return [&progress, state = std::make_shared<State>()](const std::string& step, double done) {
    if (state->begun < 0) state->begun = done;
    const double share = done - state->begun;
    const bool is_known = share > 0 && done < 1;
    progress.show(is_known ? duration(state->timer.seconds() * (1 - done) / share) + " left, " + step : step, done);
    return true;
  };
}

StudyEnvironment environment() {
  const Environment all = current_environment(1);
  return {all.commit, all.compiler, all.cpu};
}

/// Each study has a folder of its own, so that none is in the way of another.
std::string folder_of(const Options& options, const Study& study) {
  return options.folder.empty() ? "study/" + file_names({&study.name, 1}).front() : options.folder;
}

int run(const Options& options) {
  if (!options.scenes.empty() && !std::filesystem::is_directory(options.scenes))
    throw Error(ErrorCode::kNotFound, options.scenes, "is no folder", "Name the folder of the scenes");
  const Study study = choose_study(options);
  CommonOptions common;
  common.quiet = options.quiet;
  const Output output(common);
  for (const std::string& missing : study.missing) output.note("left out: " + missing + "\n");
  Progress progress(!options.quiet);
  const Timer timer;
  const std::string folder = folder_of(options, study);
  StudyRunOptions how{folder, static_cast<unsigned>(options.jobs), environment(), shower(progress)};
  const StudyTable table = run_study(study, how);
  progress.erase();
  output.print(fmt::format("{}: {} rows in {} after {}\n", study.name, table.rows.size(), folder + "/results.csv",
                           duration(timer.seconds())));
  for (const std::string& line : study_summary(table)) output.print(line + "\n");
  return kSuccess;
}

std::string known_studies() {
  std::string text = "Studies:\n";
  for (const StudyPreset& preset : study_presets())
    text += fmt::format("  {:<11} {}\n", preset.name, preset.description);
  return text +
         "A run that was stopped goes on when it is started again; finished results of another study, or of the same\n"
         "with other options, are never overwritten. Rows of results.csv are the same for any --jobs,\n"
         "except times: measure those with one job on a quiet machine.";
}

}  // namespace

Action declare_study(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.operand("STUDY", options->study, "A study below, or a FILE.json that describes one");
  arguments.file("--scenes", "DIR", options->scenes,
                 "The folder of the paper's models; what needs them is left out without");
  arguments.list("--only", "SCENE,...", options->only, "These scenes alone");
  arguments.output_folder("--out", "DIR", options->folder, {"results.csv", "results.partial.csv", "study.txt"},
                          "The folder that results.csv is written into [study/NAME]");
  arguments.whole("--rays", options->rays, {1, kMostRays}, "Rays per area");
  arguments.whole("--seed", options->seed, {0, UINT32_MAX}, "Of the rays");
  arguments.whole("-j,--jobs", options->jobs, {0, kMostJobs, 4}, "Rows at a time; 0 = all cores");
  arguments.flag("--quick", options->quick, "A few rows of each kind only");
  arguments.flag("--quiet", options->quiet, "No progress and no notes");
  arguments.footer(known_studies());
  return [options] { return run(*options); };
}

}  // namespace raygrain::cli

// raygrain verify: random scenes and hard rays through every kind of structure, against brute force.
#include <algorithm>
#include <memory>
#include <optional>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/error.h"
#include "raygrain/io.h"
#include "raygrain/report.h"
#include "raygrain/verify.h"

#include "cli/commands.h"
#include "cli/open_scene.h"
#include "cli/output.h"
#include "cli/output_folder.h"
#include "cli/signals.h"
#include "cli/values.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

constexpr uint64_t kUsualRays = 10'000'000;
constexpr float kMostMinutes = 1e6f;
constexpr const char* kUsualFolder = "verify-failures";

struct Options {
  CommonOptions common;
  std::vector<std::string> scenes;
  std::optional<uint64_t> rays;
  std::optional<float> minutes;
  uint64_t seed = 1;
  std::string folder;  // empty: the usual one, made for a failure only
};

VerifyOptions verify_options(const Options& options, Progress& progress) {
  VerifyOptions result;
  result.rays = options.rays.value_or(options.minutes ? UINT64_MAX : kUsualRays);
  if (options.minutes) result.seconds = 60 * static_cast<double>(*options.minutes);
  result.seed = options.seed;
  result.threads = options.common.thread_count();
  result.folder = options.folder.empty() ? kUsualFolder : options.folder;
  for (const std::string& scene : options.scenes) result.scenes.push_back(open_scene(scene, progress));
  result.stop = was_interrupted;
  result.progress = [&progress, rays = static_cast<double>(result.rays),
                     seconds = result.seconds](const VerifyTally& t) {
    const double done = std::max(static_cast<double>(t.rays) / rays, t.seconds / seconds);
    progress.show(fmt::format("{} differences, {:.1f} M rays, {:.2f} M/s", t.differences + t.leaks,
                              static_cast<double>(t.rays) / 1e6, static_cast<double>(t.rays) / t.seconds / 1e6),
                  done);
  };
  return result;
}

std::string verify_json(const Options& options, const VerifyResult& result) {
  const VerifyTally& t = result.tally;
  const Environment environment = current_environment(options.common.thread_count());
  Json failures = Json::array();
  for (const VerifyFailure& failure : result.failures)
    failures.push_back({{"structure", failure.structure},
                        {"what", failure.what},
                        {"triangles", failure.scene.mesh.triangle_count()},
                        {"scene", failure.path}});
  const Json report{{"seed", options.seed},
                    {"environment",
                     {{"commit", environment.commit},
                      {"compiler", environment.compiler},
                      {"cpu", environment.cpu},
                      {"threads", environment.threads}}},
                    {"scenes", t.scenes},
                    {"structures", t.structures},
                    {"rays", t.rays},
                    {"hits", t.hits},
                    {"comparisons", t.comparisons},
                    {"oracle_rays", t.oracle_rays},
                    {"differences", t.differences},
                    {"inside_rays", t.inside_rays},
                    {"lines", t.lines},
                    {"leaks", t.leaks},
                    {"seconds", t.seconds},
                    {"comparisons_of", t.comparisons_of},
                    {"failures", failures}};
  return report.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

VerifyResult verify_into(const std::string& given_folder, const VerifyOptions& how) {
  try {
    std::optional<OutputFolder> folder;
    if (!given_folder.empty()) folder.emplace(given_folder);  // before hours of work, not after them
    finish_on_interrupt();
    return verify(how);
  } catch (const Error& error) {
    if (error.code != ErrorCode::kUnwritable) throw;
    throw Error(error.code, error.where, error.message, "Name another folder for failures: --out DIR");
  }
}

int verify_answers(const Options& options) {
  const Output output(options.common);
  Progress progress(!options.common.quiet);
  const VerifyOptions how = verify_options(options, progress);
  const VerifyResult result = verify_into(options.folder, how);
  progress.erase();
  output.save_json(verify_json(options, result));
  for (const VerifyFailure& failure : result.failures)
    output.print(fmt::format("{}\n  {}\n  {} triangles, saved as {}\n", failure.structure, failure.what,
                             failure.scene.mesh.triangle_count(), failure.path));
  output.print(to_text(result.tally) + "\n");
  return result.tally.is_good() ? kSuccess : kBadData;
}

}  // namespace

Action declare_verify(Arguments& arguments) {
  const auto options = std::make_shared<Options>();
  arguments.optional_operands("SCENE", options->scenes,
                              "Scenes to take in turns with random ones; their own rays are asked first");
  arguments.optional_whole("--rays", options->rays, {1, UINT64_MAX}, "At least so many rays [10000000]");
  arguments.real("--minutes", "M", options->minutes, {0, kMostMinutes},
                 "End after this time, with what was done so far");
  arguments.whole("--seed", options->seed, {}, "Of scenes, rays and structures");
  arguments.output_folder("--out", "DIR", options->folder, {},
                          "Where scenes that show a wrong answer are saved [verify-failures]");
  add_common(arguments, options->common);
  arguments.footer(
      "Each answer is compared, bit by bit, with brute force over all triangles. What differs is made small and\n"
      "saved as a scene; raygrain verify FILE.json --rays 1 shows it again. Ctrl-C ends with the verdict so far.\n"
      "Exit codes: 0 no difference, 1 wrong answers, 2 bad usage.");
  return [options] { return verify_answers(*options); };
}

}  // namespace raygrain::cli

#include "raygrain/verify.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <utility>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "base/parallel.h"
#include "base/timer.h"
#include "geometry/same_bits.h"
#include "verify/compare.h"
#include "verify/minimise.h"
#include "verify/watertight.h"

namespace raygrain {

using namespace verification;

namespace {

constexpr uint64_t kMostRounds = 64;  // at a time

/// What one round found.
struct Finding {
  VerifyTally tally;
  std::vector<VerifyFailure> failures;
};

/// One in sixteen rays, as lines; and brute force about the rays from inside.
void check_closed(const Round& round, Finding& found, size_t most_failures) {
  const Oracle oracle(*round.scene.mesh);
  const auto note = [&](const char* what, const Ray& ray) {
    ++found.tally.leaks;
    if (found.failures.size() >= most_failures) return;
    Scene scene{"leak", *round.scene.mesh, {}, {{"rays", std::vector<Ray>{ray}}}};
    found.failures.push_back({"brute force", std::string(what) + ": " + to_text(ray), std::move(scene), {}});
  };
  for (size_t g = 0; g < round.groups.size(); ++g) {
    const RayGroup& group = round.groups[g];
    if (group.must_hit) {
      found.tally.inside_rays += group.rays.size();
      for (size_t i = 0; i < group.rays.size(); ++i)
        if (round.is_brute_force && !is_hit(round.expected[g][i])) note("a ray from inside leaves", group.rays[i]);
    }
    if (!round.is_brute_force || group.kind != RayGroupKind::kMixed) continue;
    for (size_t i = 0; i < group.rays.size(); i += 16) {
      const std::optional<bool> even = crosses_evenly(oracle, group.rays[i]);
      if (!even) continue;
      ++found.tally.lines;
      if (!*even) note("a line crosses an odd number of times", group.rays[i]);
    }
  }
}

/// Of a mesh that is too large, one ray in a thousand.
void check_reference(const Round& round, Finding& found) {
  const Oracle oracle(*round.scene.mesh);
  size_t number = 0;
  for (size_t g = 0; g < round.groups.size(); ++g)
    for (size_t i = 0; i < round.groups[g].rays.size(); ++i) {
      if (number++ % 1000 != 0) continue;
      ++found.tally.oracle_rays;
      const Hit right = oracle.nearest(round.groups[g].rays[i]);
      if (same_bits(right, round.expected[g][i])) continue;
      ++found.tally.differences;
      found.failures.push_back(
          {"binary",
           "nearest hit " + to_text(round.expected[g][i]) + " instead of " + to_text(right),
           {"binary", *round.scene.mesh, {}, {{"rays", std::vector<Ray>{round.groups[g].rays[i]}}}},
           {}});
    }
}

/// Each ray counts once, however often it is asked.
void count_rays(const Round& round, VerifyTally& tally) {
  tally.scenes = 1;
  tally.rays = round.ray_count();
  if (round.is_brute_force) tally.oracle_rays = tally.rays;
  for (const std::vector<Hit>& hits : round.expected)
    tally.hits += static_cast<uint64_t>(std::ranges::count_if(hits, is_hit));
}

void run_structures(const Round& round, std::span<const RayStructure> structures, size_t most_failures,
                    Finding& found) {
  for (const RayStructure& structure : structures) {
    const auto difference = compare(structure, round, found.tally);
    if (!difference || found.failures.size() >= most_failures) continue;
    VerifyFailure failure = minimise(structure, round, *difference);
    found.failures.push_back(std::move(failure));
  }
}

Finding run_round(const VerifyOptions& options, uint64_t number) {
  const Round round = make_round(options, number);
  Finding found;
  count_rays(round, found.tally);
  if (round.closed) check_closed(round, found, options.most_failures);
  if (!round.is_brute_force) check_reference(round, found);
  std::vector<RayStructure> structures = options.structures;
  for (const std::string& name : round.structures) structures.push_back(parse_structure(name));
  run_structures(round, structures, options.most_failures, found);
  return found;
}

std::string with_ray(const VerifyFailure& failure) {
  const auto& rays = std::get<std::vector<Ray>>(failure.scene.ray_sets.at(0).source);
  return failure.what +
         (rays.size() == 1 ? ", ray " + to_text(rays[0]) : ", one of " + std::to_string(rays.size()) + " rays");
}

/// Keeps a round's failures, as many as are wanted, in files too.
void keep(const VerifyOptions& options, uint64_t number, std::vector<VerifyFailure>& found, VerifyResult& result) {
  size_t in_round = 0;
  for (VerifyFailure& failure : found) {
    if (result.failures.size() >= options.most_failures) return;
    failure.what = with_ray(failure);
    if (!options.folder.empty()) {
      if (result.failures.empty()) make_output_folder(options.folder);
      failure.path = options.folder + "/seed-" + std::to_string(options.seed) + "-scene-" + std::to_string(number) +
                     "-" + std::to_string(in_round) + ".json";
      save_scene(failure.scene, failure.path);
    }
    ++in_round;
    result.failures.push_back(std::move(failure));
  }
}

}  // namespace

void VerifyTally::add(const VerifyTally& other) {
  scenes += other.scenes;
  structures += other.structures;
  rays += other.rays;
  hits += other.hits;
  comparisons += other.comparisons;
  oracle_rays += other.oracle_rays;
  differences += other.differences;
  inside_rays += other.inside_rays;
  lines += other.lines;
  leaks += other.leaks;
  for (const auto& [aspect, count] : other.comparisons_of) comparisons_of[aspect] += count;
  seconds += other.seconds;
}

std::string to_text(const VerifyTally& t) {
  char text[400];
  const auto number = [](uint64_t n) { return static_cast<unsigned long long>(n); };
  const double speed = t.seconds > 0 ? static_cast<double>(t.rays) / t.seconds / 1e6 : 0;
  std::snprintf(text, sizeof text,
                "%s: %llu rays, %llu comparisons, %llu rays by brute force, %llu differences, %llu leaks "
                "(%llu scenes, %llu structures, %.1f s, %.3f million rays/s)",
                t.is_good() ? "verified" : "WRONG ANSWERS", number(t.rays), number(t.comparisons),
                number(t.oracle_rays), number(t.differences), number(t.leaks), number(t.scenes), number(t.structures),
                t.seconds, speed);
  return text;
}

VerifyResult verify(const VerifyOptions& options) {
  if (options.structures_per_scene == 0 && options.structures.empty())
    throw Error(ErrorCode::kUsage, "verify", "there is no structure to ask", "Ask for some per scene");
  VerifyResult result;
  const Timer timer;
  std::atomic<bool> is_over{false};
  const auto is_time = [&] {
    if (!is_over && (timer.seconds() >= options.seconds || (options.stop && options.stop()))) is_over = true;
    return is_over.load();
  };
  // Rounds go in blocks whose sizes depend on nothing else, so that the same rays are asked on any number of threads.
  uint64_t first = 0;
  for (uint64_t block = 1; result.tally.rays < options.rays && !is_time(); block = std::min(2 * block, kMostRounds)) {
    std::vector<Finding> findings(block);
    parallel_for(block, 1, options.threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        if (!is_time()) findings[i] = run_round(options, first + i);
    });
    for (size_t i = 0; i < block; ++i) {
      result.tally.add(findings[i].tally);
      keep(options, first + i, findings[i].failures, result);
    }
    first += block;
    result.tally.seconds = timer.seconds();
    if (options.progress) options.progress(result.tally);
  }
  return result;
}

VerifyResult verify_scene(const Scene& scene, std::span<const RayStructure> structures) {
  const Timer timer;
  const Round round = make_round_of(scene);
  VerifyResult result;
  Finding found;
  count_rays(round, found.tally);
  for (const RayStructure& structure : structures)
    if (const auto difference = compare(structure, round, found.tally))
      result.failures.push_back({structure.name, difference->what, scene, {}});
  result.tally = found.tally;
  result.tally.seconds = timer.seconds();
  return result;
}

}  // namespace raygrain

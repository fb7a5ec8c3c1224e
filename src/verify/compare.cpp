#include "verify/compare.h"

#include <array>
#include <cstdio>
#include <exception>
#include <numeric>

#include "geometry/same_bits.h"
#include "verify/aspects.h"
#include "verify/oracle.h"

namespace raygrain::verification {
namespace {

/// Room for one group's answers.
struct Room {
  std::vector<Hit> nearest;
  std::vector<uint8_t> any, told;
  std::vector<float> until;

  /// Filled with what no structure would answer.
  explicit Room(size_t rays) : nearest(rays, Hit{-7, -7, -7, 7}), any(rays, 7), told(rays, 0), until(rays, kInf) {}
  RayAnswers answers() { return {nearest, any, told, until}; }
};

/// What is wrong about one ray's answers; empty: nothing.
std::string wrong(const Room& room, size_t i, const Hit& nearest) {
  const Hit expected = is_hit(nearest) && nearest.t <= room.until[i] ? nearest : Hit{};
  if ((room.told[i] & RayAnswers::kNearest) != 0 && !same_bits(room.nearest[i], expected))
    return "nearest hit " + to_text(room.nearest[i]) + " instead of " + to_text(expected);
  if ((room.told[i] & RayAnswers::kAny) != 0 && room.any[i] != (is_hit(expected) ? 1 : 0))
    return "any hit: " + std::to_string(room.any[i]) + ", but the nearest is " + to_text(expected);
  return {};
}

uint64_t answers_told(uint8_t told) {
  return static_cast<uint64_t>(std::popcount(unsigned{told} & (RayAnswers::kNearest | RayAnswers::kAny)));
}

void count_aspects(const std::string& structure, const VerifyScene& scene, RayGroupKind rays,
                   std::span<const uint8_t> told, VerifyTally& tally) {
  std::array<uint64_t, 256> answers{};  // by how they were told
  for (const uint8_t how : told) answers[how] += answers_told(how);
  const uint64_t all = std::accumulate(answers.begin(), answers.end(), uint64_t{0});
  tally.comparisons += all;
  if (all == 0) return;
  for (const std::string& aspect : aspects_of(structure, scene, rays)) tally.comparisons_of[aspect] += all;
  for (size_t how = 0; how < answers.size(); ++how) {
    if (answers[how] == 0) continue;
    for (const std::string& aspect : aspects_told(structure, static_cast<uint8_t>(how)))
      tally.comparisons_of[aspect] += answers[how];
  }
}

bool is_leak(const Room& room, size_t i) {
  return ((room.told[i] & RayAnswers::kNearest) != 0 && !is_hit(room.nearest[i])) ||
         ((room.told[i] & RayAnswers::kAny) != 0 && room.any[i] == 0);
}

/// A large mesh has a tree's answers for the right ones: brute force decides who differs.
bool is_really_wrong(const Round& round, const Room& room, size_t group, size_t i) {
  if (round.is_brute_force) return true;
  const Oracle oracle(*round.scene.mesh);
  return !wrong(room, i, oracle.nearest(round.groups[group].rays[i])).empty();
}

}  // namespace

std::optional<Difference> compare(const RayStructure& structure, const Round& round, VerifyTally& tally) {
  std::optional<Difference> first;
  const auto note = [&](Difference difference) {
    ++tally.differences;
    if (!first) first = std::move(difference);
  };
  try {
    const AnswerRays answer = structure.make(round.scene);
    if (!answer) return {};
    ++tally.structures;
    for (size_t g = 0; g < round.groups.size(); ++g) {
      const RayGroup& group = round.groups[g];
      Room room(group.rays.size());
      answer(group, room.answers());
      for (size_t i = 0; i < group.rays.size(); ++i) {
        if (group.must_hit && room.until[i] == kInf && is_leak(room, i)) ++tally.leaks;
        std::string what = wrong(room, i, round.expected[g][i]);
        if (what.empty()) continue;
        if (!is_really_wrong(round, room, g, i)) what.insert(0, "the tree of reference is wrong: ");
        note({what, g, i});
      }
      count_aspects(structure.name, round.scene, group.kind, room.told, tally);
    }
  } catch (const std::exception& error) {
    note({std::string("threw: ") + error.what(), 0, 0, true});
  }
  return first;
}

std::optional<std::string> difference_about(const RayStructure& structure, const VerifyScene& scene,
                                            const RayGroup& group, size_t ray, const Hit& expected) {
  const AnswerRays answer = structure.make(scene);
  if (!answer) return {};
  Room room(group.rays.size());
  answer(group, room.answers());
  const std::string what = wrong(room, ray, expected);
  return what.empty() ? std::nullopt : std::optional(what);
}

std::string to_text(const Ray& ray) {
  char text[300];
  const Vec3d o = to_double(ray.origin), d = to_double(ray.direction);
  std::snprintf(text, sizeof text, "{{%a, %a, %a}, {%a, %a, %a}, %a, %a}", o.x, o.y, o.z, d.x, d.y, d.z,
                static_cast<double>(ray.tmin), static_cast<double>(ray.tmax));
  return text;
}

std::string to_text(const Hit& hit) {
  if (same_bits(hit, Hit{})) return "none";
  char text[200];
  std::snprintf(text, sizeof text, "{t %a, u %a, v %a, triangle %u}", static_cast<double>(hit.t),
                static_cast<double>(hit.u), static_cast<double>(hit.v), hit.triangle);
  return text;
}

}  // namespace raygrain::verification

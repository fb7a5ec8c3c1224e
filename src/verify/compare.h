// One structure's answers beside the right ones.
#pragma once

#include <optional>
#include <string>

#include "verify/round.h"

namespace raygrain::verification {

/// The first difference that a structure made: which ray, and what about it; or that there is no structure.
struct Difference {
  std::string what;
  size_t group = 0, ray = 0;
  bool is_about_making = false;  // making it, or asking it, threw
};

/// Asks the structure about all groups and counts; the first difference, if any.
std::optional<Difference> compare(const RayStructure& structure, const Round& round, VerifyTally& tally);

/// The difference that a structure makes about the group's ray number `ray` alone, all of the group being asked.
std::optional<std::string> difference_about(const RayStructure& structure, const VerifyScene& scene,
                                            const RayGroup& group, size_t ray, const Hit& expected);

std::string to_text(const Ray& ray);
std::string to_text(const Hit& hit);

}  // namespace raygrain::verification

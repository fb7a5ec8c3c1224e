// One random scene with its rays and their right answers.
#pragma once

#include <string>
#include <vector>

#include "raygrain/verify.h"

#include "verify/oracle.h"

namespace raygrain::verification {

struct Round {
  VerifyScene scene;
  bool closed = false;
  std::vector<RayGroup> groups;
  /// By group and ray. Of meshes that are too large for brute force: a binary tree's answers.
  std::vector<std::vector<Hit>> expected;
  bool is_brute_force = true;
  std::vector<std::string> structures;  // names

  size_t ray_count() const;
};

/// Everything follows from the options and the number.
Round make_round(const VerifyOptions& options, uint64_t number);

/// The scene's own rays, as they are, in groups.
Round make_round_of(const Scene& scene);

/// The group that these rays are, if they share something; mixed otherwise.
std::vector<RayGroup> groups_of(const std::vector<Ray>& rays, const std::vector<InfluenceArea>& areas);

}  // namespace raygrain::verification

// Rays that a user hands in: those of a file or of one of the scene's ray sets.
#pragma once

#include <string>
#include <vector>

#include "raygrain/scene.h"

#include "cli/arguments.h"

namespace raygrain::cli {

struct RayOptions {
  std::string file, set;

  bool is_given() const { return !file.empty() || !set.empty(); }
};
void add_ray_options(Arguments& arguments, RayOptions& options);

/// Throws Error (kUsage) where both are given. Needs no scene, so it can come first.
void check_ray_options(const RayOptions& options);

/// What a user without rays is told.
inline constexpr char kRaysHint[] =
    "Give --rays FILE.csv (columns ox,oy,oz,dx,dy,dz[,tmin,tmax]) or --set NAME of a scene.json";

/// None where none are given. Throws Error.
std::vector<Ray> given_rays(const RayOptions& options, const Scene& scene);

}  // namespace raygrain::cli

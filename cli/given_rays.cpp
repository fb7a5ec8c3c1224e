#include "cli/given_rays.h"

#include <string_view>

#include "raygrain/io.h"

#include "base/nearest_name.h"
#include "cli/memory.h"
#include "cli/values.h"

namespace raygrain::cli {

void add_ray_options(Arguments& arguments, RayOptions& options) {
  arguments.file("--rays", "FILE.csv", options.file, "Rays: columns ox,oy,oz,dx,dy,dz and optional tmin,tmax");
  arguments.text("--set", "NAME", options.set, "Rays of this ray set of a scene.json");
}

void check_ray_options(const RayOptions& options) {
  if (!options.file.empty() && !options.set.empty()) fail_usage("--rays", "cannot be combined with --set", kRaysHint);
}

std::vector<Ray> given_rays(const RayOptions& options, const Scene& scene) {
  if (!options.file.empty()) return load_rays(options.file);
  if (options.set.empty()) return {};
  std::vector<std::string_view> names;
  for (const RaySet& set : scene.ray_sets) {
    if (set.name == options.set) {
      require_memory("casting the rays '" + set.name + "'", static_cast<double>(ray_count(set) * sizeof(Ray)),
                     "Ask for fewer rays");
      return make_rays(set, scene.mesh);
    }
    names.push_back(set.name);
  }
  fail_usage("--set", "the scene has no rays '" + options.set + "'",
             names.empty() ? "It has no ray sets: use --rays FILE.csv" : suggestion(options.set, names));
}

}  // namespace raygrain::cli

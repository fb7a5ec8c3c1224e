#include "cli/structures.h"

#include <algorithm>
#include <variant>

#include "cli/values.h"

namespace raygrain::cli {

namespace {

LocalSpace parse_space(const std::string& text) {
  if (text == "none") return LocalSpace::kNone;
  if (text == "world") return LocalSpace::kWorld;
  if (text == "ray") return LocalSpace::kRay;
  fail_usage("--space", "unknown space '" + text + "'", "Known: none, world, ray");
}

FrameKind parse_frame(const std::string& text) {
  for (const FrameKind kind : kFrameKinds)
    if (text == name(kind)) return kind;
  fail_usage("--frame", "unknown frame '" + text + "'", "Known: rotation, shear_x, shear_y, shear_z, projective");
}

RayDensity parse_density(const std::string& text) {
  if (text == "near-plane") return RayDensity::kNearPlane;
  if (text == "solid-angle") return RayDensity::kSolidAngle;
  fail_usage("--density", "unknown density '" + text + "'", "Known: near-plane, solid-angle");
}

Routing parse_routing(const std::string& text) {
  if (text == "cheapest") return Routing::kCheapest;
  if (text == "areas") return Routing::kAreas;
  fail_usage("--routing", "unknown routing '" + text + "'", "Known: cheapest, areas");
}

/// What cannot be had together would be ignored.
void check_structures(const StructureOptions& options, const AcceleratorOptions& result) {
  const LocalSpace space = local_space(result);
  const bool in_ray_space = space == LocalSpace::kRay, binary = result.traversal == Traversal::kBinary;
  if (result.frame && !in_ray_space)
    fail_usage("--frame", "is for trees in ray space, and there are none", "Add --space ray");
  if (result.density != RayDensity::kNearPlane && !in_ray_space)
    fail_usage("--density", "is for trees in ray space, and there are none", "Add --space ray");
  if (binary && space == LocalSpace::kNone)
    fail_usage("--space", "none leaves areas nothing under --traversal binary, which has no coverage",
               "Leave one of them out");
  if (binary && options.no_coverage)
    fail_usage("--no-coverage", "changes nothing under --traversal binary, which has no coverage",
               "Leave one of them out");
  if (options.no_coverage && space == LocalSpace::kNone)
    fail_usage("--no-coverage", "leaves areas nothing under --space none", "Leave one of them out");
  if (binary && in_ray_space)
    fail_usage("--space", "ray needs wide trees, and --traversal binary has none", "Leave one of them out");
  if (binary && !options.routing.empty() && result.routing == Routing::kCheapest)
    fail_usage("--routing", "cheapest needs wide trees, and --traversal binary has none", "Leave one of them out");
}

}  // namespace

void add_structure_options(Arguments& arguments, StructureOptions& options, Routing usual) {
  arguments.group("Structures");
  arguments.text(
      "--space", "NAME", options.space,
      "Space of the areas' trees: world, ray (both), or none for coverage alone [none where rays go to whoever "
      "costs least, else world]");
  arguments.text("--frame", "NAME", options.frame,
                 "Frame of trees in ray space, where it suits: rotation, shear_x, shear_y, shear_z or projective "
                 "[the cheapest]");
  arguments.text("--density", "NAME", options.density,
                 "Of point areas' rays, for trees in ray space: near-plane, or solid-angle (isotropic) [near-plane]");
  arguments.text("--routing", "NAME", options.routing,
                 std::string("Who answers an area's rays: its structures (areas), or whoever is predicted to cost "
                             "least (cheapest) [") +
                     (usual == Routing::kAreas ? "areas]" : "cheapest]"));
  arguments.flag("--no-coverage", options.no_coverage, "Areas get trees alone: they answer rays along the area, too");
}

std::string given_structure_option(const StructureOptions& options) {
  if (!options.space.empty()) return "--space";
  if (options.density != StructureOptions{}.density) return "--density";
  if (!options.frame.empty()) return "--frame";
  if (!options.routing.empty()) return "--routing";
  return options.no_coverage ? "--no-coverage" : "";
}

void set_structures(const StructureOptions& options, AcceleratorOptions& result) {
  if (!options.space.empty()) result.space = parse_space(options.space);
  result.density = parse_density(options.density);
  if (!options.frame.empty()) result.frame = parse_frame(options.frame);
  if (!options.routing.empty()) result.routing = parse_routing(options.routing);
  if (options.no_coverage) result.coverage.reset();
  check_structures(options, result);
}

void check_structures_of(const StructureOptions& options, std::span<const InfluenceArea> areas) {
  const bool has_points = std::ranges::any_of(
      areas, [](const InfluenceArea& area) { return std::holds_alternative<PointArea>(area.shape); });
  if (parse_density(options.density) != RayDensity::kNearPlane && !has_points)
    fail_usage("--density", "is about rays through a point, and no area has one",
               "Leave it out, or give --light X,Y,Z or --camera EYE TARGET");
}

}  // namespace raygrain::cli

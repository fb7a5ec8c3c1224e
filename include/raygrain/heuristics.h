// The measures and orientations of the paper, ready made.
#pragma once

#include <span>
#include <vector>

#include "raygrain/area.h"
#include "raygrain/measure.h"
#include "raygrain/orientation.h"
#include "raygrain/ray.h"

namespace raygrain {

/// SAH: surface area / 4 (Goldsmith and Salmon 1987, MacDonald and Booth 1990); total = the root's.
RayMeasure surface_area_measure();

/// PAH for parallel rays as three face weights |direction|. `direction` need not have unit length.
RayMeasure directional_measure(Vec3 direction);

/// PAH: projected area of a box as the area's rays see it. kWindow: culled to the window, total = window area, so
/// measure / total is the absolute hit probability; kNone: total = the root's.
RayMeasure projected_area_measure(const InfluenceArea& area, Culling culling = Culling::kWindow);

/// The solid angle under which a point area's eye sees a box: rays of an isotropic light, which the projected area
/// overrates up to 5.2 times towards the corners of a window of 90 degrees. kWindow: culled to the window, total = the
/// window's solid angle; kNone: total = the root's, without the flattest rays (AreaGeometry::solid_angle). For a plane
/// area projected_area_measure: so it looks from far away.
RayMeasure solid_angle_measure(const InfluenceArea& area, Culling culling = Culling::kWindow);

/// Counts the sample rays that meet a box (as infinite lines cut to [tmin, tmax]); total = their number.
RayMeasure sampled_measure(std::span<const Ray> rays);

/// `base`, times the share of the sample rays through a box that are still alive where they enter it: rays stop at
/// their first hit, so what opaque surfaces hide costs little. After Vinkler, Havran and Sochor, "Visibility driven BVH
/// build up algorithm for ray tracing" (2012); the share is counted on a grid over all that the rays see and is at
/// least 1/16. `rays` end (tmax) where they hit, see end_at_hits; a few thousand do. Where none ends, nothing is hidden
/// and the result is `base`. Total = that of `base`.
RayMeasure visible_measure(const RayMeasure& base, std::span<const Ray> rays);

/// LSPH: quality = extent / longest extent.
SplitOrientation longest_axis_orientation();

/// SPFH (section 7 of the paper): value_k = |v_k| / (|v_x| + |v_y| + |v_z|), quality_k = (1 - value_k)^2. v is the
/// plane normal; for a point area node centre - eye, or the area's axis where the node holds the eye.
SplitOrientation facing_orientation(const InfluenceArea& area);

/// One axis per level: (parent_axis + 1) mod 3 first, the others after it with lower quality.
SplitOrientation round_robin_orientation();

}  // namespace raygrain

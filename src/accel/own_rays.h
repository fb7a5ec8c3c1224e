// Which rays are an area's, for counts.
#pragma once

#include "raygrain/area.h"

namespace raygrain {

/// A valid ray that the area serves, or whose line is within a millionth (sine) of its direction, or of a line through
/// its point, in its window (see AreaUse).
bool is_own_ray(const AreaGeometry& area, const Ray& ray);

}  // namespace raygrain

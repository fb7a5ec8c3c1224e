// Measures of boxes in a projective frame.
#pragma once

#include "raygrain/measure.h"

namespace raygrain {

/// face_weight_measure of boxes in a projective frame, with the solid angle under which the eye sees a box's xy extent
/// in place of the extent: its area times the mean density of isotropic rays there, which is 1 in the frame's middle
/// and (1 + x^2 + y^2)^(-3/2) elsewhere.
RayMeasure solid_face_measure(Vec3 weights);

}  // namespace raygrain

// The one function that decides hits. Its answer is defined in real arithmetic, so every correct program agrees on its
// bits.
#pragma once

#include "raygrain/ray.h"

namespace raygrain {

/// Decides whether `ray` meets the closed triangle (a, b, c), exactly.
///
/// In real arithmetic on the given float32 numbers, with E(p, q) = det[d, p - o, q - o], wa = E(b, c), wb = E(c, a),
/// wc = E(a, b), D = wa + wb + wc: a hit has D != 0, no two of wa, wb, wc of strictly opposite sign, and
/// tmin <= t <= tmax, where t = det[a - o, b - o, c - o] / D, u = wb / D and v = wc / D are each rounded once to the
/// nearest float32 (ties to even). A ray in the triangle's plane misses it; zero-area triangles are never hit.
///
/// On a hit sets `hit.t`, `hit.u`, `hit.v` (not `hit.triangle`) and returns true; otherwise leaves `hit` alone.
/// Precondition: is_valid(ray), finite vertices.
bool intersect_triangle(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit);

/// The same answer by exact integer arithmetic alone: the definition, to test the fast path against. Slow.
bool intersect_triangle_exact(const Ray& ray, Vec3 a, Vec3 b, Vec3 c, Hit& hit);

}  // namespace raygrain

// The first hit: a mesh, a sun, a ray.
#include <cstdio>

#include "raygrain/raygrain.h"

int main() {
  raygrain::InfluenceArea sun{"sun", raygrain::PlaneArea{{0, 50, 0}, {0, -1, 0}, {0, 0, 1}, 20, 20, 100}};
  raygrain::Accelerator scene(raygrain::load_mesh("city.obj"), {sun});
  raygrain::Hit hit = scene.intersect({{1, 40, 2}, {0, -1, 0}});
  std::printf("triangle %u at t = %g\n", hit.triangle, static_cast<double>(hit.t));
  return raygrain::is_hit(hit) ? 0 : 1;
}

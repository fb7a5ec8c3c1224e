#include <cstdio>

#include <raygrain/raygrain.h>

int main() {
  raygrain::Scene scene = raygrain::generate_scene({.kind = "random100"});
  const raygrain::Ray ray{{5, 5, -4}, {0, 0, 1}};
  const raygrain::Hit expected = raygrain::intersect_reference(scene.mesh, ray);
  const raygrain::Accelerator accelerator(scene.mesh, scene.areas);
  const raygrain::Hit hit = accelerator.intersect(ray);
  std::printf("t = %g, triangle %u\n", static_cast<double>(hit.t), hit.triangle);
  return hit == expected ? 0 : 1;
}

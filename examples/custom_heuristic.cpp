// A heuristic of one's own is a function of a box: here, rays that come mostly along y, some from everywhere else.
#include <iostream>

#include <raygrain/raygrain.h>

int main() {
  const raygrain::Scene scene = raygrain::generate_scene({.kind = "city", .size = 6, .seed = 1});
  const raygrain::RayMeasure mine = [](const raygrain::Bounds& box) {
    const raygrain::Vec3 e = extent(box);
    return e.x * e.z + 0.1f * e.y * (e.x + e.z);
  };
  raygrain::BuildOptions options;
  for (const raygrain::RayMeasure& measure : {raygrain::RayMeasure(), mine}) {
    options.strategy.measure = measure;
    const raygrain::Bvh tree = build_binned(triangle_bounds(scene.mesh), triangle_centroids(scene.mesh), options);
    std::cout << "estimated cost for my rays: " << analyze(tree, mine).estimated_cost << '\n';
  }
}

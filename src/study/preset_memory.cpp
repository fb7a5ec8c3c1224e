// The study `memory`: section 9.6 of the paper, its own sums put right, and the memory of real trees beside it.
#include <cmath>

#include "raygrain/analyze.h"

#include "study/presets.h"
#include "study/scene_pool.h"
#include "study/sources.h"

namespace raygrain::study {
namespace {

const std::vector<StudyColumn>& columns() {
  static const std::vector<StudyColumn> all{{"areas"},
                                            {"triangles"},
                                            {"local_triangles"},
                                            {"global_memory_bytes"},
                                            {"local_memory_bytes"},
                                            {"area_memory_bytes"},
                                            {"top_level_memory_bytes"},
                                            {"total_memory_bytes"},
                                            {"global_paper_memory_bytes"},
                                            {"local_paper_memory_bytes"},
                                            {"area_paper_memory_bytes"},
                                            {"top_level_paper_memory_bytes"},
                                            {"total_paper_memory_bytes"},
                                            {"published_memory_bytes"},
                                            {"total_per_global"}};
  return all;
}

struct Memory {
  double global = 0, local = 0, area = 0, top_level = 0;
  double total() const { return global + local + area + top_level; }
};

void set(Cells& cells, const std::string& kind, const Memory& memory) {
  cells.set("global_" + kind, memory.global);
  cells.set("local_" + kind, memory.local);
  cells.set("area_" + kind, memory.area);
  cells.set("top_level_" + kind, memory.top_level);
  cells.set("total_" + kind, memory.total());
}

std::vector<std::string> run_row(const SceneTrees& scene, const StudyArea& area) {
  const AreaGeometry geometry(area.area);
  const LocalTree local = build_local_tree(scene.mesh, area.area, {"PAH", "SPFH", "paper", {}}, default_registry());
  const ConvexRegion region = geometry.region();
  const TopLevelStats top = analyze_top_level({&region, 1}, {}, {});
  const auto paper_bytes = [](const Bvh& tree) {
    return static_cast<double>(paper_memory_bytes(tree.nodes.size(), tree.prims.size()));
  };
  const Memory measured{static_cast<double>(memory_bytes(scene.global)), static_cast<double>(memory_bytes(*local.tree)),
                        static_cast<double>(sizeof(AreaGeometry)), static_cast<double>(top.memory_bytes)};
  const Memory counted{paper_bytes(scene.global), paper_bytes(*local.tree),
                       static_cast<double>(paper_memory_bytes(area.area)), static_cast<double>(top.paper_memory_bytes)};
  Cells cells(columns());
  cells.set("areas", 1);
  cells.set("triangles", static_cast<double>(scene.mesh.triangle_count()));
  cells.set("local_triangles", static_cast<double>(local.tree->prims.size()));
  set(cells, "memory_bytes", measured);
  set(cells, "paper_memory_bytes", counted);
  cells.set("total_per_global", measured.total() / measured.global);
  return cells.take();
}

/// A balanced tree whose leaves hold two triangles each, as section 9.6 has it.
double balanced_bytes(int levels) {
  const double leaves = std::exp2(levels - 1);
  return (leaves - 1) * 40 + leaves * 48;
}

/// The paper's own example: 21 levels; with 20 areas, 16 levels in each local tree.
std::vector<std::string> run_example(int areas, double published) {
  constexpr double kInner = 585, kLeaves = 4096;  // (8^5 - 1) / 7 nodes of an octree with five levels
  constexpr double kArea = (184.0 + 360.0) / 2;   // a frustum holds its own box, too
  constexpr int kGlobalLevels = 21, kLocalLevels = 16;
  const double triangles = std::exp2(kGlobalLevels);
  const Memory memory{balanced_bytes(kGlobalLevels), areas * balanced_bytes(areas == 1 ? kGlobalLevels : kLocalLevels),
                      areas * kArea, kInner * 56 + kLeaves * 60};
  Cells cells(columns());
  cells.set("areas", areas);
  cells.set("triangles", triangles);
  cells.set("local_triangles", areas == 1 ? triangles : std::round(triangles * 0.65 / areas));
  set(cells, "paper_memory_bytes", memory);
  cells.set("published_memory_bytes", published);
  cells.set("total_per_global", memory.total() / memory.global);
  return cells.take();
}

}  // namespace

Study memory_study(const StudySources& sources) {
  Study study{"memory", columns(), {}, "", {}};
  const std::vector<StudyScene> scenes = paper_scenes(sources, study.missing);
  study.identity += contents_of(scenes);
  for (const StudyScene& scene : scenes) {
    const auto trees = std::make_shared<LazyScene>([load = scene.load] {
      TriangleMesh mesh = load();
      Bvh global = build_global_tree(mesh, {"SAH", "LSPH", "paper", {}}, default_registry());
      return make_scene_trees(std::move(mesh), std::move(global));
    });
    for (const StudyArea& area : scene.areas) {
      const bool is_plane = std::holds_alternative<PlaneArea>(area.area.shape);
      study.add(
          {scene.name, is_plane ? "plane" : "point", area.variant, "PAH+SPFH"},
          [trees, area] { return run_row(trees->get(), area); }, scene.weight);
    }
  }
  study.add({"section 9.6", "", "1 area"}, [] { return run_example(1, 186.44e6); });
  study.add({"section 9.6", "", "20 areas"}, [] { return run_example(20, 191.22e6); });
  return study;
}

}  // namespace raygrain::study

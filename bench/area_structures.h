// What can answer the rays of an area, each structure alone, over one mesh and beside one global tree.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "raygrain/accelerator.h"

#include "structured_rays.h"

namespace raygrain::bench {

struct BuildCost {
  double seconds = std::numeric_limits<double>::infinity();  // the least of all builds
  size_t bytes = 0;
};

/// What all areas of a scene share.
class SceneStructures {
 public:
  SceneStructures(const TriangleMesh& mesh, unsigned threads);

  /// Builds the global tree once more, for its time.
  void build_again();

  std::shared_ptr<const TriangleMesh> mesh;
  WideBvh global;
  std::optional<Accelerator> accelerator;  // without areas
  BuildCost cost;                          // of the wide tree and, in seconds, of its binary one

 private:
  unsigned threads_;
};

/// A structure, and how it answers a set of rays.
struct Structure {
  std::string name, api;  // api: single, batch or array
  BuildCost cost;
  std::function<void(Answers&)> trace;
};

/// The structures of a set's areas: coverages of several kinds, trees in ray space and in the world. Rays that one does
/// not answer go to the global tree.
class AreaStructures {
 public:
  AreaStructures(const SceneStructures& scene, const StructuredRays& rays, unsigned threads);

  /// Builds everything; again for the time alone.
  void build();

  /// Those that can answer the set, whose areas must be those that were built for. `rays` and this outlive them.
  std::vector<Structure> structures(const StructuredRays& rays) const;

 private:
  struct GridOfCells {
    std::string name;
    CoverageOptions options;
    std::vector<Coverage> coverages;
    BuildCost cost;
  };
  struct Trees {
    std::vector<LocalTree> locals;  // one an area
    std::vector<WideBvh> wide;
    std::vector<std::optional<FrameTree>> frames;  // nothing where no frame suits
    BuildCost cost_of_wide, cost_of_frames;
  };

  void build_coverage(GridOfCells& grid) const;
  void build_wide();
  void build_frames();
  void add_coverages(const StructuredRays& rays, std::vector<Structure>& all) const;
  void add_trees(const StructuredRays& rays, std::vector<Structure>& all) const;
  void add_accelerators(const StructuredRays& rays, std::vector<Structure>& all) const;

  const SceneStructures& scene_;
  const std::vector<InfluenceArea> areas_;
  const unsigned threads_;
  std::vector<GridOfCells> grids_;  // the library's own first; none where rays do not run along their area
  Trees trees_;
  std::optional<Accelerator> with_wide_, with_frames_;
};

}  // namespace raygrain::bench

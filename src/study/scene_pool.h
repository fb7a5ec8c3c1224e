// The scenes of a study: each is loaded, and its global tree built, when its first row needs them.
#pragma once

#include <functional>
#include <memory>
#include <mutex>

#include "study/tree_row.h"

namespace raygrain::study {

class LazyScene {
 public:
  using Make = std::function<SceneTrees()>;

  explicit LazyScene(Make make) : make_(std::move(make)) {}

  /// The same for all callers; the first one waits for it longest.
  const SceneTrees& get() {
    std::call_once(once_, [this] { trees_ = std::make_unique<const SceneTrees>(make_()); });
    return *trees_;
  }

 private:
  Make make_;
  std::once_flag once_;
  std::unique_ptr<const SceneTrees> trees_;
};

/// Wide form included.
SceneTrees make_scene_trees(TriangleMesh mesh, Bvh global);

}  // namespace raygrain::study

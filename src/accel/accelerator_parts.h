// What an accelerator holds.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "accel/foreign.h"
#include "accel/search.h"
#include "accel/search_tree.h"

namespace raygrain {

struct Accelerator::Parts {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<LocalTree> locals;
  std::vector<SearchTree> searches;  // parallel to `locals`
  SearchTree global;
  AreaTable areas;
  Traversal traversal = Traversal::kWide;
  std::vector<Coverage> coverages = {};  // parallel to `locals`, or empty
  ForeignFilter foreign = ForeignFilter(areas.geometries);

  /// Rays along an area that its coverage answers, whatever region they are in.
  std::optional<Hit> nearest_covered(const Ray& ray) const;
  std::optional<bool> any_covered(const Ray& ray) const;
  void count_use(uint32_t area, const Ray& ray, AcceleratorCounters* counters) const;

  Hit nearest(const Ray& ray, AcceleratorCounters* counters) const;
  bool any(const Ray& ray, AcceleratorCounters* counters) const;

  /// Rays that are no area's go to the global tree together, the others one by one.
  template <class Answer, class One, class Many>
  void answer_array(std::span<const Ray> rays, std::span<Answer> answers, unsigned threads, const One& one,
                    const Many& many) const;
};

}  // namespace raygrain

// How many bytes an accelerator holds: each thing once, however many share it.
#include <numeric>
#include <set>

#include "accel/accelerator_parts.h"

namespace raygrain {
namespace {

template <class T>
size_t bytes_of(const std::vector<T>& values) {
  return values.capacity() * sizeof(T);
}

size_t bytes_of(const Route& route) {
  return route.asked.memory_bytes() + route.batches.memory_bytes() + bytes_of(route.covers) + bytes_of(route.searches) +
         route.foreign.memory_bytes();
}

/// Bytes that nothing before has counted.
class Count {
 public:
  size_t of(const Bvh& tree) { return once(&tree, memory_bytes(tree)); }

  size_t of(const SearchTree& search) {
    const size_t bytes = (search.wide() ? search.wide()->memory_bytes() : 0) + of(search.in_ray_space());
    fast_forms += bytes;
    return of(*search.binary()) + bytes;
  }

  /// Corners are counted apart.
  size_t of(const std::optional<FrameTree>& tree) {
    if (!tree) return 0;
    if (const TriangleCorners* shared = tree->corners().get()) corners += once(shared, shared->memory_bytes());
    return once(&tree->frame(), tree->memory_bytes());
  }

  size_t corners = 0, fast_forms = 0;

 private:
  size_t once(const void* thing, size_t bytes) { return seen_.insert(thing).second ? bytes : 0; }

  std::set<const void*> seen_;
};

}  // namespace

size_t AcceleratorMemory::total() const {
  return std::accumulate(areas.begin(), areas.end(), global + shared);
}

AcceleratorMemory Accelerator::Parts::memory() const {
  AcceleratorMemory sum;
  Count count;
  sum.global = count.of(global);
  sum.areas.resize(geometries.size());
  for (size_t i = 0; i < searches.size(); ++i) sum.areas[i] += count.of(searches[i]);
  sum.fast_forms = count.fast_forms + count.corners;
  for (size_t i = 0; i < locals.size(); ++i)
    sum.areas[i] += count.of(locals[i].in_ray_space) + bytes_of(locals[i].log.nodes);
  for (size_t i = 0; i < coverages.size(); ++i) sum.areas[i] += coverages[i].memory_bytes();
  sum.shared = count.corners + areas.top_level.memory_bytes() + bytes_of(areas.geometries) + bytes_of(areas.ranks) +
               bytes_of(areas.axes) + bytes_of(geometries) + bytes_of(locals) + bytes_of(searches) +
               bytes_of(coverages) + bytes_of(costs);
  for (const Route* route : {&routes.any, &routes.nearest, &routes.any_of_many, &routes.nearest_of_many})
    sum.shared += bytes_of(*route);
  return sum;
}

size_t Accelerator::memory_bytes() const {
  return parts_->memory().total();
}

size_t Accelerator::wide_memory_bytes() const {
  return parts_->memory().fast_forms;
}

}  // namespace raygrain

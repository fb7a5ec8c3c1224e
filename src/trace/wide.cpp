#include "raygrain/wide.h"

#include <string>

#include "raygrain/error.h"

#include "base/parallel.h"
#include "base/sizes.h"
#include "trace/kernels/kernels.h"
#include "trace/wide_tree.h"

namespace raygrain {

struct WideBvh::Data {
  WideTree tree;
  Isa isa = Isa::kScalar;
  const Kernels* kernels = nullptr;
};

namespace {

constexpr size_t kRaysPerTask = 1024;

const Kernels& kernels_of(Isa isa) {
  const Kernels* found = kernels(isa);
  if (found == nullptr)
    throw Error(ErrorCode::kUsage, "WideOptions::isa", "this CPU does not offer '" + std::string(name(isa)) + "'");
  return *found;
}

}  // namespace

WideBvh::WideBvh() : data_(std::make_shared<const Data>()) {}

WideBvh::WideBvh(const Bvh& tree, const TriangleMesh& mesh, const WideOptions& options) {
  const Isa isa = options.isa ? *options.isa : default_isa();
  const Kernels& table = kernels_of(isa);
  check_numbers("WideBvh", tree.prims, mesh.triangle_count(), "triangles");
  data_ = std::make_shared<const Data>(Data{collapse(tree, mesh, options), isa, &table});
}

Hit WideBvh::intersect(const Ray& ray, Hit known, const SearchOptions& options) const {
  if (data_->tree.is_empty()) return known;
  if (options.prune) return data_->kernels->nearest(data_->tree, ray, known, options.skip_before);
  TraceCounters unwanted;
  return data_->kernels->nearest_counted(data_->tree, ray, known, options, unwanted);
}

bool WideBvh::occluded(const Ray& ray, const SearchOptions& options) const {
  if (data_->tree.is_empty()) return false;
  if (options.prune) return data_->kernels->any(data_->tree, ray, options.skip_before);
  TraceCounters unwanted;
  return data_->kernels->any_counted(data_->tree, ray, options, unwanted);
}

void WideBvh::intersect(std::span<const Ray> rays, std::span<Hit> hits, unsigned threads) const {
  check_sizes("WideBvh", rays.size(), hits.size());
  if (data_->tree.is_empty()) return std::fill(hits.begin(), hits.end(), Hit{});
  parallel_for(rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    data_->kernels->nearest_of_many(data_->tree, rays.data() + begin, hits.data() + begin, end - begin);
  });
}

void WideBvh::occluded(std::span<const Ray> rays, std::span<uint8_t> flags, unsigned threads) const {
  check_sizes("WideBvh", rays.size(), flags.size());
  if (data_->tree.is_empty()) return std::fill(flags.begin(), flags.end(), uint8_t{0});
  parallel_for(rays.size(), kRaysPerTask, threads, [&](size_t begin, size_t end) {
    data_->kernels->any_of_many(data_->tree, rays.data() + begin, flags.data() + begin, end - begin);
  });
}

Hit WideBvh::intersect_counted(const Ray& ray, TraceCounters& counters, Hit known, const SearchOptions& options) const {
  if (data_->tree.is_empty()) return known;
  return data_->kernels->nearest_counted(data_->tree, ray, known, options, counters);
}

bool WideBvh::occluded_counted(const Ray& ray, TraceCounters& counters, const SearchOptions& options) const {
  if (data_->tree.is_empty()) return false;
  return data_->kernels->any_counted(data_->tree, ray, options, counters);
}

Isa WideBvh::isa() const {
  return data_->isa;
}

size_t WideBvh::node_count() const {
  return data_->tree.nodes;
}

size_t WideBvh::leaf_count() const {
  return data_->tree.leaves;
}

size_t WideBvh::memory_bytes() const {
  return data_->tree.memory.size();
}

}  // namespace raygrain

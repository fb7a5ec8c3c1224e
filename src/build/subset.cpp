// Tessari, Dittebrand, Doyle and Benthin, "Stochastic subsets for BVH construction" (2023): a tree over a random subset
// sorts all primitives into clusters, and each cluster gets a tree of its own.
#include <algorithm>

#include "raygrain/build.h"

#include "base/parallel.h"
#include "base/random.h"
#include "base/timer.h"
#include "build/laps.h"
#include "build/monitor.h"
#include "build/nearest_leaves.h"
#include "build/reference_builder.h"
#include "build/strategy.h"

namespace raygrain {

namespace {

constexpr uint32_t kStep = 16;            // one of this many primitives is in the subset
constexpr uint32_t kClusterSamples = 32;  // nodes with fewer primitives of the subset are clusters
constexpr size_t kTogether = 16384;       // primitives that look for their clusters together
constexpr size_t kLeast = 8192;           // fewer primitives are not worth a subset

/// One primitive of every kStep in a row, at random.
std::vector<uint32_t> choose_subset(size_t count, uint64_t seed) {
  Random random(seed);
  std::vector<uint32_t> subset;
  subset.reserve(count / kStep + 1);
  for (size_t begin = 0; begin < count; begin += kStep)
    subset.push_back(static_cast<uint32_t>(begin + random.below(std::min<size_t>(kStep, count - begin))));
  return subset;
}

struct Cluster {
  size_t begin = 0, end = 0;  // in the list of members
  uint32_t level = 0;
  Bvh tree;
  BuildLog log;
};

class SubsetBuilder {
 public:
  SubsetBuilder(const builder::Input& input, const BuildOptions& options, bool logging)
      : input_(input), options_(options), logging_(logging), monitor_(options.progress, input.bounds.size()) {}

  Bvh build(BuildLog* log) {
    builder::Laps laps(log ? &log->times : nullptr);
    build_top();
    laps.lap(&BuildTimes::candidates);
    sort_into_clusters();
    laps.lap(&BuildTimes::partition);
    parallel_for(clusters_.size(), 1, options_.threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i) build_cluster(clusters_[i]);
    });
    laps.lap(&BuildTimes::candidates);
    Bvh bvh = assemble(log);
    laps.lap(&BuildTimes::nodes);
    return bvh;
  }

 private:
  Vec3 key(size_t i) const { return input_.centroids.empty() ? center(input_.bounds[i]) : input_.centroids[i]; }

  void build_top() {
    subset_ = choose_subset(input_.bounds.size(), options_.seed);
    std::vector<Bounds> bounds;
    std::vector<Vec3> centroids;
    for (const uint32_t i : subset_) {
      bounds.push_back(input_.bounds[i]);
      if (!input_.centroids.empty()) centroids.push_back(input_.centroids[i]);
    }
    BuildOptions options = options_;
    options.progress = {};
    options.merge_leaves = false;
    options.parameters.max_triangles_per_leaf = std::max(kClusterSamples, options.parameters.max_triangles_per_leaf);
    top_ = build_binned(bounds, centroids, options, logging_ ? &top_log_ : nullptr);
    monitor_.finish(0);
  }

  void sort_into_clusters() {
    std::vector<uint32_t> cluster_of(top_.nodes.size()), levels(top_.nodes.size());
    for (size_t i = 0; i < top_.nodes.size(); ++i) {
      const Bvh::Node& node = top_.nodes[i];
      if (!node.is_leaf()) {
        levels[node.first] = levels[node.first + 1] = levels[i] + 1;
        continue;
      }
      cluster_of[i] = static_cast<uint32_t>(clusters_.size());
      clusters_.push_back({0, 0, levels[i], {}, {}});
    }
    const size_t count = input_.bounds.size();
    std::vector<uint32_t> places(count);
    parallel_for(count, kTogether, options_.threads, [&](size_t begin, size_t end) {
      std::vector<Vec3> keys;
      keys.reserve(end - begin);
      for (size_t i = begin; i < end; ++i) keys.push_back(key(i));
      const std::span<uint32_t> leaves = std::span(places).subspan(begin, end - begin);
      builder::NearestLeaves().find(top_, keys, leaves);
      for (uint32_t& leaf : leaves) leaf = cluster_of[leaf];
    });
    // The subset stays where its tree put it, so no cluster is empty.
    for (size_t i = 0; i < top_.nodes.size(); ++i)
      for (uint32_t k = 0; k < top_.nodes[i].count; ++k)
        places[subset_[top_.prims[top_.nodes[i].first + k]]] = cluster_of[i];

    for (const uint32_t place : places) ++clusters_[place].end;
    size_t begin = 0;
    for (Cluster& cluster : clusters_) {
      const size_t size = cluster.end;
      cluster.begin = cluster.end = begin;
      begin += size;
    }
    members_.resize(count);
    for (uint32_t i = 0; i < count; ++i) members_[clusters_[places[i]].end++] = i;
  }

  void build_cluster(Cluster& cluster) {
    std::vector<Bounds> bounds;
    std::vector<Vec3> centroids;
    bounds.reserve(cluster.end - cluster.begin);
    for (size_t i = cluster.begin; i < cluster.end; ++i) {
      bounds.push_back(input_.bounds[members_[i]]);
      if (!input_.centroids.empty()) centroids.push_back(input_.centroids[members_[i]]);
    }
    BuildOptions options = options_;
    options.progress = {};
    options.threads = 1;
    options.seed = options_.seed + cluster.begin + 1;
    options.parameters.max_levels -= std::min(options.parameters.max_levels, cluster.level);
    cluster.tree = build_binned(bounds, centroids, options, logging_ ? &cluster.log : nullptr);
    monitor_.finish(cluster.end - cluster.begin);
  }

  Bvh assemble(BuildLog* log) {
    size_t count = top_.nodes.size();
    for (const Cluster& cluster : clusters_) count += cluster.tree.nodes.size() - 1;
    Bvh bvh;
    bvh.nodes.resize(count);
    bvh.prims.resize(members_.size());
    if (log) log->nodes.resize(count);
    if (log) log->peak_bytes = 2 * memory_bytes(bvh) + members_.size() * 3 * sizeof(uint32_t) + memory_bytes(top_);

    // Clusters are met in the order in which they are numbered only by node; places follow depth first.
    std::vector<uint32_t> cluster_of(top_.nodes.size());
    for (uint32_t i = 0, next = 0; i < top_.nodes.size(); ++i)
      if (top_.nodes[i].is_leaf()) cluster_of[i] = next++;
    struct Visit {
      uint32_t from, to;
    };
    std::vector<Visit> open{{0, 0}};
    std::vector<uint32_t> inner;
    uint32_t next = 1, next_prim = 0;
    while (!open.empty()) {
      const auto [from, to] = open.back();
      open.pop_back();
      if (top_.nodes[from].is_leaf()) {
        const Cluster& cluster = clusters_[cluster_of[from]];
        place(cluster, to, next, next_prim, bvh, log);
        next += static_cast<uint32_t>(cluster.tree.nodes.size() - 1);
        next_prim += static_cast<uint32_t>(cluster.tree.prims.size());
        continue;
      }
      bvh.nodes[to].first = next;
      inner.push_back(to);
      if (log) log->nodes[to] = top_log_.nodes[from];
      open.push_back({top_.nodes[from].first + 1, next + 1});
      open.push_back({top_.nodes[from].first, next});
      next += 2;
    }
    for (size_t i = inner.size(); i-- > 0;) {
      Bvh::Node& node = bvh.nodes[inner[i]];
      node.bounds = united(bvh.nodes[node.first].bounds, bvh.nodes[node.first + 1].bounds);
    }
    return bvh;
  }

  void place(const Cluster& cluster, uint32_t root, uint32_t first_node, uint32_t first_prim, Bvh& bvh,
             BuildLog* log) const {
    const Bvh& tree = cluster.tree;
    for (uint32_t i = 0; i < tree.nodes.size(); ++i) {
      const uint32_t to = i == 0 ? root : first_node + i - 1;
      bvh.nodes[to] = tree.nodes[i];
      bvh.nodes[to].first += tree.nodes[i].is_leaf() ? first_prim : first_node - 1;
      if (log) log->nodes[to] = cluster.log.nodes[i];
    }
    for (uint32_t i = 0; i < tree.prims.size(); ++i)
      bvh.prims[first_prim + i] = members_[cluster.begin + tree.prims[i]];
  }

  const builder::Input& input_;
  const BuildOptions& options_;
  const bool logging_;
  builder::Monitor monitor_;
  std::vector<uint32_t> subset_, members_;
  Bvh top_;
  BuildLog top_log_;
  std::vector<Cluster> clusters_;
};

}  // namespace

Bvh build_subset(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                 BuildLog* log) {
  validate(options);
  const builder::Input input = builder::checked_input(bounds, centroids, options.threads);
  if (bounds.size() < kLeast || !builder::has_references(input, options.strategy))
    return build_binned(bounds, centroids, options, log);
  if (log) *log = {};
  const Timer timer;
  Bvh bvh = SubsetBuilder(input, options, log != nullptr).build(log);
  if (log) log->times.total = timer.seconds();
  return bvh;
}

}  // namespace raygrain

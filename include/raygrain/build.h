// Builders: from boxes, centroids, a measure and an orientation to a binary tree. They never see rays, areas or meshes.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "raygrain/bvh.h"
#include "raygrain/measure.h"
#include "raygrain/orientation.h"

namespace raygrain {

/// What a ray pays (section 8 of the paper): for each inner box it meets, and for each triangle of a leaf that it
/// meets. Builder, estimate and real cost use the same two numbers.
struct CostModel {
  float inner = 2.0f;
  float triangle = 1.2f;
};

/// Table 1 of the paper. Leaf rules are `<`, so 0 switches them off.
struct PaperParameters {
  float max_leaf_cost = 0;                 // a node of lower cost (measure / total * count * triangle cost) is a leaf
  float max_leaf_area = 0;                 // a node of lower measure is a leaf
  float max_leaf_hit_probability = 0;      // a node of lower measure / total is a leaf
  uint32_t max_triangles_per_leaf = 2;     // a node with *fewer* triangles is a leaf
  uint32_t max_levels = 100;               // nodes at this level are leaves; <= kMaxTreeLevels
  uint32_t bins = 40;                      // slices per axis, bins - 1 interior planes; 2 ... 4096
  uint32_t max_non_fallback_levels = 100;  // deeper nodes use the fallback strategy
  float split_plane_quality_threshold = 0.4f;  // in [0, 1]: axes below it are not tried
  float acceptable_ratio = 1.3f;               // (p_left + p_right) / p_node, lower is better
  float excellent_ratio = 0.9f;
};

/// Cost of a node that would be a leaf, from its measure and triangle count.
using NodeCost = std::function<float(float measure, uint32_t count)>;

/// Appends candidate plane positions, ascending, along an axis of the node. `centroids` bounds the node's centroids
/// (the positions that the partition rule gives, where there is one).
using CandidatePlanes = std::function<void(const NodeContext&, const Bounds& centroids, int axis, uint32_t bins,
                                           std::vector<float>& planes)>;

/// The position of a primitive along an axis: left of a plane when it is less.
using PartitionRule = std::function<float(const Bounds&, Vec3 centroid, int axis)>;

/// What is known when the next orientation is up (figure 9 of the paper).
struct SplitState {
  NodeContext node;
  float node_measure = 0;
  bool has_split = false;  // a split was found along an earlier orientation
  float ratio = kInf;      // (p_left + p_right) / p_node of the best split so far; infinity without one
  AxisChoice next;
  int tried = 0;       // orientations tried so far
  int last_axis = -1;  // the one tried last at this node, before a fallback too; -1 for none
};

enum class SplitVerdict {
  kTry,                // try the next orientation
  kSkip,               // pass over the next orientation
  kSatisfied,          // stop with the best so far
  kFallBack,           // let the fallback strategy split; keep the better under the primary measure
  kFallBackReplacing,  // let the fallback strategy split and forget the best so far (as the published runs did)
};
using SplitDecision = std::function<SplitVerdict(const SplitState&, const PaperParameters&)>;

/// What a stop rule may know of a node. `probability` = measure / total.
struct StopState {
  NodeContext node;
  float measure = 0, probability = 0, cost = 0;
};
using StopRule = std::function<bool(const StopState&, const PaperParameters&)>;

/// What a plane costs: the sum of both sides, and how many primitives each has (neither is 0).
struct PlanePrice {
  double cost = 0;
  uint32_t left_count = 0, right_count = 0;
};

/// Is a candidate plane better than the best one before it along the same axis? Asked in ascending order of planes.
using PlanePreference = std::function<bool(const PlanePrice& candidate, const PlanePrice& best)>;

/// A finished split of one node.
struct SplitOutcome {
  NodeContext node;
  Bounds left, right;
  float left_measure = 0, right_measure = 0;  // under the strategy that judges the children
  bool forced = false;                        // the decision asked for the fallback
  bool fallback = false;                      // and got its split
};

/// The measures (left, right) that the children start with: node_measure of their SplitState and measure of their
/// StopState. Not negative; may be infinite.
using HandDown = std::function<std::pair<float, float>(const SplitOutcome&)>;

/// Everything a builder lets its user replace. An empty function means the default named beside it.
struct BuildStrategy {
  RayMeasure measure;            // surface area
  SplitOrientation orientation;  // all_axes_orientation()
  NodeCost cost;                 // measure * count
  CandidatePlanes planes;        // `bins` equal slices of the node's box (build_binned: of the centroids' box)
  PartitionRule partition;       // the centroid's coordinate
  SplitDecision decision;        // decide_split
  StopRule stop;                 // stop_by_parameters
  // Of build_paper only:
  PlanePreference preference;  // the lower cost; of planes that cost nothing the one with the most even counts
  HandDown hand_down;          // left_measure and right_measure
};

/// A box around the part of a primitive that lies in a box, empty only where no part does: what spatial splits need to
/// know of primitives. Must be safe to call from several threads.
using ClipPrimitive = std::function<Bounds(uint32_t primitive, const Bounds& box)>;

/// build_spatial: when a plane may cut primitives in two.
struct SpatialParameters {
  /// Planes that cut primitives are tried where the sides of the best split overlap in more than this part of the
  /// root's measure (alpha of Stich et al.); in [0, 1].
  float overlap = 1e-4f;
  /// Most references that splits may add, as a share of the primitives; in [0, 16].
  float budget = 0.5f;
};

/// Options of every builder. The default is a good general tree.
struct BuildOptions {
  BuildStrategy strategy;
  std::optional<BuildStrategy> fallback;  // build_paper only; without one a fallback verdict means kSatisfied
  PaperParameters parameters;
  CostModel costs;
  /// Where no candidate plane separates the centroids, cut their own box along its longest axis instead; more than
  /// `leaf_size` primitives whose centroids coincide are cut into two halves of their list. Without it such nodes
  /// become leaves of any size.
  bool split_inseparable = true;
  bool merge_leaves = false;  // build_binned: make a leaf of up to `leaf_size` where splitting costs more
  uint32_t leaf_size = 4;
  /// build_binned, build_spatial and build_subset: a node of up to `rare_leaf_size` primitives becomes a leaf at once
  /// where its measure is below `rare_share / primitives` of the root's: so few rays come there that no split can gain
  /// much, and half of the work of a build is saved. 0: never. For wide trees, whose leaves hold up to 8 triangles.
  uint32_t rare_leaf_size = 0;
  float rare_share = 20;
  uint64_t seed = 1;  // of NodeContext::seed
  /// Threads that build_binned and build_spatial use; 0 = all. The tree is the same for any number. With more than one,
  /// `measure` and `orientation` are called from several threads.
  unsigned threads = 0;
  /// Called now and then, never by two threads at once, with the finished share of the build in [0, 1], not descending.
  /// false cancels the build: Error kCancelled.
  std::function<bool(double done)> progress;
  ClipPrimitive clip;  // build_spatial
  SpatialParameters spatial;
};

/// How a build is run: nothing that its tree depends on. See the fields of BuildOptions.
struct BuildRun {
  unsigned threads = 0;
  std::function<bool(double done)> progress = {};
  bool samples_are_ended = false;  // the sample rays come from samples_for: nobody need find their first hits again
};

/// Figure 9: ratio <= excellent: satisfied; next quality >= threshold: try; ratio <= acceptable: satisfied; else fall
/// back.
SplitVerdict decide_split(const SplitState& state, const PaperParameters& parameters);

/// The leaf rules of Table 1.
bool stop_by_parameters(const StopState& state, const PaperParameters& parameters);

/// What happened at one node, parallel to Bvh::nodes.
struct NodeLog {
  int8_t axis = -1;          // split axis, -1 for leaves
  uint8_t orientations = 0;  // orientations tried, the fallback's too (failed attempts in final leaves count)
  bool fallback = false;     // split by the fallback strategy (asked by the decision, or by the level)
  bool forced = false;       // the decision asked for the fallback; the best split so far may still have won
  float quality = 0;         // of the split axis; 0 for a split that no candidate plane gave (split_inseparable)
  float ratio = kInf;        // (p_left + p_right) / p_node of the split
};

/// Seconds of one build, by part; parts do not overlap. Times only; everything else in a log is deterministic.
struct BuildTimes {
  double total = 0, orientations = 0, candidates = 0, partition = 0, stop = 0, nodes = 0;
};

struct BuildLog {
  std::vector<NodeLog> nodes;
  BuildTimes times;
  size_t peak_bytes = 0;  // most memory that the builder held at once, the tree included
};

/// Algorithm 1 of the paper, iterative: orientations in the strategy's order, `bins` slices each, the decision of
/// figure 9, fallback. Of planes with equal cost the lowest along the first orientation wins; of planes that cost
/// nothing the one with the most even counts. Every node is judged by the primary measure, or by the fallback's below
/// max_non_fallback_levels. `centroids[i]` is the barycentre of primitive i; it need not lie in its box.
///
/// No centroids at all stand for the centers of the boxes, in every builder: better for ordinary trees (long thin
/// triangles stand in the middle of the room that they take), but not Algorithm 1.
///
/// Deterministic. No primitives give an empty tree. Throws Error kUsage for options out of range, boxes that are empty
/// or not finite, and centroids that are not finite or neither one per box
/// nor none; kBadHeuristic (with the node) for a measure
/// that is negative or not finite or an orientation with a wrong axis. Exceptions of user functions pass through.
Bvh build_paper(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log = nullptr);

/// Binned top-down construction after Wald, "On fast construction of SAH-based bounding volume hierarchies" (2007): one
/// pass over the primitives for all axes, prefix and suffix sweeps over the slices, the best plane of all axes that the
/// orientation strategy admits: those whose quality reaches split_plane_quality_threshold, or else the best. Cuts the
/// box of the centroids into equal slices: `bins`, but no more than 4 + count / 16; nodes of up to 8 primitives are cut
/// between any two centroids. Of planes with equal cost the one with the most even counts wins. Ignores `fallback` and
/// `decision`. Same errors, and kCancelled.
///
/// Parallel, and the same tree for any number of threads; one thread where `cost`, `planes`, `partition` or `stop` is
/// replaced (`planes` and `partition` also see all `bins`).
Bvh build_binned(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                 BuildLog* log = nullptr);

/// Full sweep: as build_binned, but every position between two centroids is a candidate (of any key that `partition`
/// gives). The reference for quality; sorts every node's primitives, so much slower. Ignores `bins` and `planes` too.
Bvh build_sweep(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                BuildLog* log = nullptr);

/// As build_binned, and where the sides of its best split overlap too much, planes through space that cut primitives in
/// two: Stich, Friedrich and Dietrich, "Spatial splits in bounding volume hierarchies" (2009), under any measure. A
/// primitive that a plane cuts goes whole to one side where that is cheaper. 16 slices per axis of the node's box; room
/// for added references (`spatial.budget`) is handed down in proportion to counts; the plane is found by cutting boxes
/// and priced by cutting primitives. The tree's leaves may hold a primitive more than once: Bvh::split_references.
/// Parallel, and the same tree for any number of threads. Same errors; kUsage without `clip` or where `cost`, `planes`,
/// `partition` or `stop` is replaced.
Bvh build_spatial(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                  BuildLog* log = nullptr);

/// For trees that must be there soon: Tessari, Dittebrand, Doyle and Benthin, "Stochastic subsets for BVH construction"
/// (2023). build_binned over one in 16 primitives, drawn with `seed`; its nodes with fewer than 32 of them are
/// clusters; all other primitives go down to the nearer box; build_binned in each cluster. Fewer than 8192 primitives,
/// and strategies that replace `cost`, `planes`, `partition` or `stop`: build_binned. Parallel, and the same tree for
/// any number of threads. Same errors.
Bvh build_subset(std::span<const Bounds> bounds, std::span<const Vec3> centroids, const BuildOptions& options,
                 BuildLog* log = nullptr);

/// Throws Error (kUsage, naming the field) for values out of range.
void validate(const BuildOptions& options);

}  // namespace raygrain

// The parallel builder behind build_binned and build_spatial: top-down over packed references.
//
// The largest nodes are split one after the other, each by parallel loops over chunks of its references; smaller ones
// level by level, side by side; what is left are subtrees, each built by one thread into memory of its own; at last all
// are copied to their places, which their sizes alone decide. Chunks depend on counts only and merge in order, so no
// thread decides a bit of the tree.
#pragma once

#include <vector>

#include "base/buffer.h"
#include "build/laps.h"
#include "build/monitor.h"
#include "build/slices.h"
#include "build/space_slices.h"

namespace raygrain::builder {

/// A node that is not yet split. Its references stand at [begin, begin + count) of one of two buffers, and may grow in
/// number up to `room` on their way down.
struct OpenRange {
  NodeContext context;
  float measure = 0;
  KeyBox keys;
  size_t begin = 0, room = 0;
  bool in_second = false;
  uint32_t index = 0;  // in the nodes of its subtree, or of the top
};

/// A finished piece of the tree. Children of nodes and first primitives of leaves count from the piece's own start.
struct Piece {
  std::vector<Bvh::Node> nodes;
  std::vector<uint32_t> prims;
  std::vector<NodeLog> notes;
  BuildTimes times;
};

/// Where a piece goes in the whole tree.
struct PiecePlace {
  uint32_t root, first_node, first_prim;
};

template <class Reference>
class ReferenceBuilder {
 public:
  /// `spatial` asks for splits that cut primitives.
  ReferenceBuilder(const Input& input, const BuildOptions& options, bool spatial);

  Bvh build(BuildLog* log);

 private:
  struct Scratch;
  struct Children {
    OpenRange left, right;
  };
  /// What became of a node above all subtrees, or at the root of one.
  struct TopSplit {
    bool is_split = false;
    Children children;
    NodeLog note;
    BuildTimes times;
  };
  /// Nodes above all subtrees.
  struct TopNode {
    Bvh::Node node;  // first: of the children in this list
    NodeLog note;
    int64_t piece = -1;
  };

  void fill(std::span<Reference> references, Bounds& box, KeyBox& keys) const;
  void split_top(const OpenRange& root, BuildTimes* times);
  void split_level(std::span<const OpenRange> level, std::span<TopSplit> splits, BuildTimes* times) const;
  void split_for_top(const OpenRange& node, Scratch& scratch, unsigned threads, TopSplit& result) const;
  std::vector<OpenRange> next_level(std::span<const OpenRange> level, std::span<TopSplit> splits);
  Piece build_piece(const OpenRange& root) const;
  bool split(const OpenRange& node, Scratch& scratch, unsigned threads, Children& children, NodeLog& note,
             Laps& laps) const;
  bool is_rare(const OpenRange& node) const;
  AxisOrder admitted_axes(const NodeContext& node) const;
  Cut find_cut(const OpenRange& node, const AxisOrder& order, Scratch& scratch, unsigned threads) const;
  Cut find_space_cut(const OpenRange& node, const AxisOrder& order, const Cut& best, Scratch& scratch,
                     unsigned threads) const;
  Cut find_last_cut(const OpenRange& node, Scratch& scratch, unsigned threads) const;
  Cut halve(const OpenRange& node) const;
  bool part_by_space(const OpenRange& node, Cut& cut, double limit, Scratch& scratch, unsigned threads,
                     Children& children) const;
  bool price_sides(const OpenRange& node, Cut& cut, std::span<const SpaceSides<Reference>> chunks) const;
  static bool fits(const OpenRange& node, const Cut& cut);
  void part_by_keys(const OpenRange& node, const Cut& cut, Scratch& scratch, unsigned threads,
                    Children& children) const;
  void open_children(const OpenRange& node, const Cut& cut, Children& children) const;
  std::span<Reference> buffer(bool second) const {
    const size_t room = both_.size() / 2;
    return both_.elements().subspan(second ? room : 0, room);
  }
  std::span<const Reference> references_of(const OpenRange& node) const {
    return std::span<const Reference>(buffer(node.in_second)).subspan(node.begin, node.context.count);
  }
  Bvh assemble(std::vector<Piece>& pieces, BuildLog* log) const;
  Bvh make_room(std::span<const Piece> pieces, BuildLog* log) const;
  std::vector<PiecePlace> place_pieces(std::span<const Piece> pieces, Bvh& bvh, BuildLog* log) const;

  const Input& input_;
  const BuildOptions& options_;
  const bool spatial_;
  ActiveStrategy strategy_;
  Buffer<Reference> both_;  // one after the other; split writes disjoint ranges from several threads
  std::vector<TopNode> top_;
  std::vector<OpenRange> subtrees_;
  float root_measure_ = 0;
  bool logging_ = false;
  mutable Monitor monitor_;
};

/// Whether this builder can serve the options: only measure and orientation are replaced, and keys are so near to each
/// other that float can tell their distances.
bool has_references(const Input& input, const BuildStrategy& strategy);

/// With the form of references that the input's keys need; the log starts anew and gets the whole time.
Bvh build_from_references(const Input& input, const BuildOptions& options, bool spatial, BuildLog* log);

}  // namespace raygrain::builder

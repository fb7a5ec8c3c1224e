// The upper nodes of the parallel builder, down to subtrees that one thread builds.
#include "base/parallel.h"
#include "base/timer.h"
#include "build/reference_scratch.h"

namespace raygrain::builder {

namespace {
constexpr size_t kSubtree = 4096;  // nodes of up to this many references are built by one thread
}

/// Splits nodes until each is small enough for one thread, level by level: the largest by all threads, one after the
/// other, then the rest of the level side by side.
template <class Reference>
void ReferenceBuilder<Reference>::split_top(const OpenRange& root, BuildTimes* times) {
  const unsigned threads = options_.threads != 0 ? options_.threads : default_threads();
  top_.assign(1, {});
  std::vector<OpenRange> level{root};
  while (!level.empty()) {
    std::vector<TopSplit> splits(level.size());
    const Timer timer;
    Scratch scratch;
    const auto is_large = [&](const OpenRange& node) {
      return size_t{4} * threads * node.context.count > root.context.count;
    };
    for (size_t i = 0; i < level.size(); ++i)
      if (is_large(level[i])) split_for_top(level[i], scratch, threads, splits[i]);
    parallel_for(level.size(), 1, threads, [&](size_t begin, size_t end) {
      for (size_t i = begin; i < end; ++i)
        if (Scratch own; !is_large(level[i])) split_for_top(level[i], own, 1, splits[i]);
    });
    if (times) add_scaled<TopSplit>(*times, splits, timer.seconds());
    level = next_level(level, splits);
  }
}

template <class Reference>
void ReferenceBuilder<Reference>::split_for_top(const OpenRange& node, Scratch& scratch, unsigned threads,
                                                TopSplit& result) const {
  Laps laps(logging_ ? &result.times : nullptr);
  result.is_split = node.context.count > kSubtree && split(node, scratch, threads, result.children, result.note, laps);
  laps.finish();
  monitor_.finish(0);
}

/// Notes what became of the nodes of a level; the nodes below them.
template <class Reference>
std::vector<OpenRange> ReferenceBuilder<Reference>::next_level(std::span<const OpenRange> level,
                                                               std::span<TopSplit> splits) {
  std::vector<OpenRange> next;
  for (size_t i = 0; i < level.size(); ++i) {
    TopNode& node = top_[level[i].index];
    if (!splits[i].is_split) {
      node.piece = static_cast<int64_t>(subtrees_.size());
      subtrees_.push_back(level[i]);
      subtrees_.back().index = 0;
      continue;
    }
    const auto first = static_cast<uint32_t>(top_.size());
    node.node = {level[i].context.bounds, first, 0};
    node.note = splits[i].note;
    top_.resize(top_.size() + 2);
    splits[i].children.left.index = first;
    splits[i].children.right.index = first + 1;
    next.push_back(splits[i].children.left);
    next.push_back(splits[i].children.right);
  }
  return next;
}

template void ReferenceBuilder<Reference>::split_top(const OpenRange&, BuildTimes*);
template void ReferenceBuilder<KeyedReference>::split_top(const OpenRange&, BuildTimes*);

}  // namespace raygrain::builder

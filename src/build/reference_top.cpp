// The upper nodes of the parallel builder, down to subtrees that one thread builds.
#include <algorithm>

#include "base/parallel.h"
#include "base/timer.h"
#include "build/reference_scratch.h"

namespace raygrain::builder {

namespace {
constexpr size_t kSubtree = 4096;  // nodes of up to this many references are built by one thread
}

/// Splits nodes until each is small enough for one thread, level by level.
template <class Reference>
void ReferenceBuilder<Reference>::split_top(const OpenRange& root, BuildTimes* times) {
  top_.assign(1, {});
  std::vector<OpenRange> level{root};
  while (!level.empty()) {
    std::ranges::stable_sort(level, std::greater<>(), [](const OpenRange& node) { return node.context.count; });
    std::vector<TopSplit> splits(level.size());
    split_level(level, splits, times);
    level = next_level(level, splits);
  }
}

/// Those that would hold up the others by all threads, one after the other; then the rest side by side.
template <class Reference>
void ReferenceBuilder<Reference>::split_level(std::span<const OpenRange> level, std::span<TopSplit> splits,
                                              BuildTimes* times) const {
  const size_t threads = options_.threads != 0 ? options_.threads : default_threads();
  size_t rest = 0;
  for (const OpenRange& node : level) rest += node.context.count;
  Scratch scratch;
  const Timer timer;
  size_t large = 0;
  for (; large < level.size() && level[large].context.count * threads > rest; ++large) {
    rest -= level[large].context.count;
    split_for_top(level[large], scratch, static_cast<unsigned>(threads), splits[large]);
  }
  const double by_all = timer.seconds();
  parallel_for(level.size() - large, 1, static_cast<unsigned>(threads), [&](size_t begin, size_t end) {
    for (size_t i = large + begin; i < large + end; ++i) {
      Scratch own;
      split_for_top(level[i], own, 1, splits[i]);
    }
  });
  if (!times) return;
  add_scaled<TopSplit>(*times, splits.first(large), by_all);
  add_scaled<TopSplit>(*times, splits.subspan(large), timer.seconds() - by_all);
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

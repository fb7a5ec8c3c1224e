// The nearest hits of many rays in flight. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_NEAREST_STREAM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_NEAREST_STREAM_INL_H
#undef RAYGRAIN_TRACE_KERNELS_NEAREST_STREAM_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_NEAREST_STREAM_INL_H
#endif

#include "raygrain/triangle.h"

#include "trace/kernels/confirm-inl.h"
#include "trace/kernels/streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

/// Pairs of rays and triangles that wait for double precision; as many as a vector holds are decided together.
class Confirmations {
 public:
  Confirmations(const Ray* rays, Hit* hits) : rays_(rays), hits_(hits) {}

  HWY_INLINE void add(size_t index, const WideLeaf& leaf, size_t lane, float size) {
    const Ray& ray = rays_[index];
    set(kOrigin, ray.origin);
    set(kDirection, ray.direction);
    for (size_t c = 0; c < 3; ++c) set(kCorners + 3 * c, leaf.vertex(c, lane));
    values_[kSize][count_] = size;
    values_[kMin][count_] = ray.tmin;
    values_[kMax][count_] = ray.tmax;
    index_[count_] = index;
    triangle_[count_] = leaf.id(lane);
    if (++count_ == kCapacity) decide();
  }

  /// Decides all that wait.
  void decide() {
    for (size_t first = 0; first < count_; first += kDoubles) decide(first, std::min(kDoubles, count_ - first));
    count_ = 0;
  }

 private:
  enum : size_t { kOrigin = 0, kDirection = 3, kCorners = 6, kSize = 15, kMin, kMax, kValues };

  /// Several vectors full: what was stored a number at a time need not be awaited when it is loaded.
  static constexpr size_t kCapacity = 4 * kDoubles;

  HWY_INLINE void decide(size_t first, size_t count) {
    const DoubleVectors direction = load(kDirection, first), a = load(kCorners, first);
    Verdicts verdicts;  // NOLINT: written by confirm
    confirm<false>({direction, a - load(kOrigin, first), load(kCorners + 3, first) - a, load(kCorners + 6, first) - a,
                    largest_component(direction), load_doubles(values_[kSize] + first),
                    load_floats(values_[kMin] + first), load_floats(values_[kMax] + first)},
                   verdicts);
    const VerdictHits hits(verdicts, triangle_ + first);
    for (size_t i = 0; i < count; ++i) {
      Hit hit = hits[i];
      const bool is_unsure = (verdicts.unsure >> i & 1) != 0;
      const bool is_hit = is_unsure ? decide_alone(first + i, hit) : (verdicts.hit >> i & 1) != 0;
      Hit& best = hits_[index_[first + i]];
      if (is_hit && is_nearer(hit, best)) best = hit;
    }
  }

  HWY_INLINE void set(size_t i, Vec3 a) {
    values_[i][count_] = a.x;
    values_[i + 1][count_] = a.y;
    values_[i + 2][count_] = a.z;
  }
  HWY_INLINE DoubleVectors load(size_t i, size_t first) const {
    return {load_doubles(values_[i] + first), load_doubles(values_[i + 1] + first),
            load_doubles(values_[i + 2] + first)};
  }
  HWY_NOINLINE bool decide_alone(size_t lane, Hit& hit) const {
    hit.triangle = triangle_[lane];
    const auto corner = [&](size_t i) {
      return Vec3{values_[kCorners + i][lane], values_[kCorners + i + 1][lane], values_[kCorners + i + 2][lane]};
    };
    return intersect_triangle(rays_[index_[lane]], corner(0), corner(3), corner(6), hit);
  }

  const Ray* rays_;
  Hit* hits_;
  size_t count_ = 0;
  alignas(32) float values_[kValues][kCapacity] = {};
  uint32_t triangle_[kCapacity] = {};
  size_t index_[kCapacity];
};

class NearestStream {
 public:
  struct Slot {
    BoxFilter<float> boxes;
    TriangleFilter<float> triangles;
    ChildRef current;
    float bound;            // no hit beyond it matters
    size_t index, waiting;  // the ray, and how many leaves wait for the end of its search
    struct {
      ChildRef ref;
      uint32_t lanes;
      float earliest;
    } leaves[16];
    StreamStack stack;
  };

  NearestStream(const WideTree& tree, const Ray* rays, Hit* hits, size_t count)
      : tree_(tree), rays_(rays), hits_(hits), count_(count), confirmations_(rays, hits) {}

  void run() {
    Stream<NearestStream>(*this).run();
    confirmations_.decide();
  }

  HWY_INLINE bool start(Slot& s) {
    while (next_ < count_) {
      const Ray& ray = rays_[next_];
      s.index = next_++;
      hits_[s.index] = {};
      if (!(ray.tmin <= ray.tmax)) continue;
      if (!s.boxes.prepare(tree_, ray, -kInf)) [[unlikely]] {
        if (is_valid(ray)) hits_[s.index] = nearest_carefully(tree_, ray, {}, {}, nullptr);
        continue;
      }
      s.triangles.prepare(ray);
      s.bound = ray.tmax;
      s.current = node_ref(0);
      s.waiting = 0;
      s.stack.clear();
      return true;
    }
    return false;
  }

  /// The nearest child is next, the others go on the stack by their place in the node.
  HWY_INLINE void visit_node(Slot& s) {
    const WideNode& node = tree_.node(s.current);
    alignas(32) float entry[kWidth];
    const uint32_t bits = s.boxes(node, s.bound, entry);
    const Popped popped = pop(s.stack, s.bound);
    const auto enter = hn::Load(Tag(), entry);
    const uint32_t lane = nearest_of(enter, bits), others = bits & ~(1u << lane);
    store_entries(s.stack, enter, others);
    store_children(s.stack, node, others);
    const size_t size = s.stack.size + static_cast<size_t>(std::popcount(others));
    s.current = choose(bits != 0, node.child[lane], popped.child);
    s.stack.size = choose(bits != 0, size, popped.size);
    fetch(tree_, s.current);
  }

  HWY_INLINE void visit_leaf(Slot& s) {
    Candidates found;
    const uint32_t possible = s.triangles.test<false>(tree_.leaf(s.current), s.current, s.bound, found);
    s.bound = std::min(s.bound, least_of(found.latest, found.sure));
    s.leaves[s.waiting] = {s.current, possible, least_of(found.earliest, possible)};
    s.waiting += possible != 0;
    if (s.waiting == std::size(s.leaves)) finish(s);
    const Popped popped = pop(s.stack, s.bound);
    s.current = popped.child;
    s.stack.size = popped.size;
    fetch(tree_, s.current);
  }

  /// Lets double precision decide what may still matter.
  HWY_INLINE void finish(Slot& s) {
    for (size_t i = 0; i < s.waiting; ++i) {
      const auto& [ref, lanes, earliest] = s.leaves[i];
      if (earliest > s.bound) continue;
      const bool is_one = (lanes & (lanes - 1)) == 0;
      for (uint32_t bits = is_one ? lanes : still_possible(s, ref); bits != 0;)
        confirmations_.add(s.index, tree_.leaf(ref), take_lowest(bits), size_of(ref));
    }
    s.waiting = 0;
  }

 private:
  struct Popped {
    ChildRef child;
    size_t size;
  };

  /// Of a leaf's triangles those that may still matter, all hits of other leaves considered.
  HWY_NOINLINE uint32_t still_possible(const Slot& s, ChildRef ref) const {
    Candidates found;
    return s.triangles.test<false>(tree_.leaf(ref), ref, s.bound, found);
  }

  /// The topmost that begins in time; the lowest always do.
  static HWY_INLINE Popped pop(const StreamStack& stack, float bound) {
    size_t base = stack.size - kWidth;
    uint32_t bits = less_equal(load_unaligned(stack.entry + base), broadcast(bound));
    while (bits == 0) {
      base -= kWidth;
      bits = less_equal(load_unaligned(stack.entry + base), broadcast(bound));
    }
    const size_t top = base + 31 - static_cast<size_t>(std::countl_zero(bits));
    return {stack.child[top], top};
  }

  /// The lane in `bits` that is entered first, as far as all but three bits of the entries tell; any without bits.
  /// Entries below zero count as late: that costs time at most.
  static HWY_INLINE uint32_t nearest_of(hn::Vec<Tag> enter, uint32_t bits) {
    const KeyTag tag;
    const auto all = hn::Or(hn::And(hn::BitCast(tag, enter), hn::Set(tag, ~7u)), hn::Iota(tag, 0));
    const auto keys = hn::IfThenElse(hn::RebindMask(tag, mask_of(bits)), all, hn::Set(tag, ~0u));
    return hn::GetLane(hn::MinOfLanes(tag, keys)) & 7;
  }

  const WideTree& tree_;
  const Ray* rays_;
  Hit* hits_;
  size_t count_, next_ = 0;
  Confirmations confirmations_;
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

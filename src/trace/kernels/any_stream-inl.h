// Whether many rays in flight hit anything. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_ANY_STREAM_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_ANY_STREAM_INL_H
#undef RAYGRAIN_TRACE_KERNELS_ANY_STREAM_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_ANY_STREAM_INL_H
#endif

#include "trace/kernels/streams-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

class AnyStream {
 public:
  struct Slot {
    BoxFilter<float> boxes;
    TriangleFilter<float> triangles;
    ChildRef current;
    float tmax;
    size_t index;  // of the ray
    StreamStack stack;
  };

  AnyStream(const WideTree& tree, const Ray* rays, uint8_t* flags, size_t count)
      : tree_(tree), rays_(rays), flags_(flags), count_(count) {}

  void run() { Stream<AnyStream>(*this).run(); }

  HWY_INLINE bool start(Slot& s) {
    while (next_ < count_) {
      const Ray& ray = rays_[next_];
      s.index = next_++;
      flags_[s.index] = 0;
      if (!(ray.tmin <= ray.tmax)) continue;
      if (!s.boxes.prepare(tree_, ray, -kInf)) [[unlikely]] {
        flags_[s.index] = is_valid(ray) && any_carefully(tree_, ray, {}, nullptr) ? 1 : 0;
        continue;
      }
      s.triangles.prepare(ray);
      s.tmax = ray.tmax;
      s.current = node_ref(0);
      s.stack.clear();
      return true;
    }
    return false;
  }

  /// The most probable child, which is the last, is next.
  HWY_INLINE void visit_node(Slot& s) {
    const WideNode& node = tree_.node(s.current);
    alignas(32) float entry[kWidth];
    const uint32_t bits = s.boxes(node, s.tmax, entry);
    const ChildRef popped = s.stack.child[s.stack.size - 1];
    store_children(s.stack, node, bits);
    const size_t size = s.stack.size + static_cast<size_t>(std::popcount(bits)) - 1;
    const auto last = static_cast<size_t>(31 - std::countl_zero(bits | 1));
    s.current = choose(bits != 0, node.child[last], popped);
    s.stack.size = size;
    fetch(tree_, s.current);
  }

  HWY_INLINE void visit_leaf(Slot& s) {
    const WideLeaf leaf = tree_.leaf(s.current);
    const AnyHits found = meet_any<false>(s.triangles.pairs(leaf, s.current, s.tmax));
    bool is_hit = found.sure != 0;
    const uint64_t unsure = choose(is_hit, 0, found.possible);
    if (unsure != 0) [[unlikely]]
      is_hit = confirm_one_of(leaf, static_cast<uint32_t>(unsure), rays_[s.index]);
    flags_[s.index] = is_hit ? 1 : 0;
    s.current = choose(is_hit, kDone, s.stack.child[--s.stack.size]);
    fetch(tree_, s.current);
  }

  HWY_INLINE void finish(Slot&) {}

 private:
  static HWY_NOINLINE bool confirm_one_of(const WideLeaf& leaf, uint32_t lanes, const Ray& ray) {
    Hit hit;
    while (lanes != 0)
      if (confirm(leaf, take_lowest(lanes), ray, hit)) return true;
    return false;
  }

  const WideTree& tree_;
  const Ray* rays_;
  uint8_t* flags_;
  size_t count_, next_ = 0;
};

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Columns of one cell and its triangles, as many columns at once as a vector holds. The same tests as for one column,
// and the same counts. Included once per instruction set.
#if defined(RAYGRAIN_TRACE_KERNELS_COVERAGE_PACKETS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef RAYGRAIN_TRACE_KERNELS_COVERAGE_PACKETS_INL_H
#undef RAYGRAIN_TRACE_KERNELS_COVERAGE_PACKETS_INL_H
#else
#define RAYGRAIN_TRACE_KERNELS_COVERAGE_PACKETS_INL_H
#endif

#include <bit>

#include "trace/kernels/columns-inl.h"

HWY_BEFORE_NAMESPACE();
namespace raygrain::HWY_NAMESPACE {
namespace {

constexpr size_t kPacket = hn::MaxLanes(ColumnTag());
using PacketMask = hn::Mask<ColumnTag>;

HWY_INLINE uint32_t bits_of(PacketMask mask) {
  return bits_of(ColumnTag(), mask);
}
HWY_INLINE ColumnFloats broadcast_column(float a) {
  return hn::Set(ColumnTag(), a);
}

/// Some columns of one cell, and the points (or directions) of their rays. Lanes beyond `lanes` hold anything.
struct Packet {
  ColumnFloats x, y, s, px, py, pz;
  uint32_t lanes;  // bits

  /// Neighbours in a block.
  HWY_INLINE Packet(const Block& block, size_t first, size_t count)
      : x(hn::LoadU(ColumnTag(), block.x + first)),
        y(hn::LoadU(ColumnTag(), block.y + first)),
        s(hn::LoadU(ColumnTag(), block.s + first)),
        lanes((1u << count) - 1) {
    hn::LoadInterleaved3(ColumnTag(), &block.points[first].x, px, py, pz);
  }
  HWY_INLINE Packet(const ColumnVectors& columns, ColumnFloats x_of_point, ColumnFloats y_of_point,
                    ColumnFloats z_of_point, size_t count)
      : x(columns.x),
        y(columns.y),
        s(columns.s),
        px(x_of_point),
        py(y_of_point),
        pz(z_of_point),
        lanes((1u << count) - 1) {}

  HWY_INLINE ColumnFloats lane(const CoverageTriangle& triangle, size_t i) const {
    const ColumnTag d;
    return hn::MulAdd(hn::Set(d, triangle.a[i]), x,
                      hn::MulAdd(hn::Set(d, triangle.b[i]), y, hn::Set(d, triangle.c[i])));
  }
  /// The least of the distances to the edges.
  HWY_INLINE ColumnFloats inside(const CoverageTriangle& triangle) const {
    return hn::Min(hn::Min(lane(triangle, 0), lane(triangle, 1)), lane(triangle, 2));
  }
  /// Of the triangle's plane, which it must have.
  HWY_INLINE ColumnFloats depth(const CoverageTriangle& triangle) const {
    const ColumnFloats sum =
        hn::Add(hn::Mul(broadcast_column(triangle.a[3]), x), hn::Mul(broadcast_column(triangle.b[3]), y));
    return hn::Mul(hn::Add(sum, broadcast_column(triangle.c[3])), broadcast_column(triangle.per_ahead));
  }
  HWY_INLINE ColumnFloats ahead(const CoverageTriangle& triangle) const {
    return hn::Add(lane(triangle, 3), hn::Mul(broadcast_column(triangle.ahead), s));
  }
};

/// As code_of.
HWY_INLINE ColumnFloats codes_of(const CoverageTile& tile, ColumnFloats s) {
  const ColumnFloats code =
      hn::Add(hn::Mul(hn::Sub(s, broadcast_column(tile.lowest)), broadcast_column(tile.per_depth)),
              broadcast_column(kFirstCode));
  return hn::Trunc(hn::Min(hn::Max(code, broadcast_column(0)), broadcast_column(65535)));
}

/// Which of the packet's `open` columns have any triangle of the list ahead? asks(id, lane) decides where margins do
/// not.
template <class Asks>
HWY_INLINE uint32_t meet_any(const CoverageGrid& grid, const Packet& packet, const CoverageCell& cell,
                             ColumnFloats codes, uint32_t open, const Asks& asks, uint64_t& tests) {
  const CoverageReference* reference = grid.references.data() + cell.first;
  const CoverageReference* end = grid.references.data() + (&cell)[1].first;
  uint32_t met = 0;
  for (; reference != end; ++reference) {
    open &= ~bits_of(hn::Lt(broadcast_column(reference->top), codes));  // and all that follow are lower
    if (open == 0) break;
    const CoverageTriangle& triangle = grid.triangles[reference->triangle()];
    tests += static_cast<uint64_t>(std::popcount(open));
    const ColumnFloats least = hn::Min(packet.inside(triangle), packet.ahead(triangle));
    const uint32_t possible = open & bits_of(hn::Ge(least, broadcast_column(-triangle.margin)));
    if (possible == 0) continue;
    uint32_t now = possible & bits_of(hn::Gt(least, broadcast_column(triangle.margin)));
    for (uint32_t unsure = possible & ~now; unsure != 0; unsure &= unsure - 1)
      if (asks(triangle.id, static_cast<size_t>(std::countr_zero(unsure)))) now |= unsure & (0u - unsure);
    met |= now;
    open &= ~now;
  }
  return met;
}

/// What first_hits would tell of each column: lanes that have one candidate, and its id; lanes that have several.
struct FirstHits {
  alignas(64) uint32_t ids[kPacket];
  uint32_t one, several;
};

/// Of each column: the candidates that reach highest, and the depth below which its first hit surely is not.
struct Leaders {
  ColumnFloats sure, sure_code, highest, second;
  ColumnFloats count;  // of candidates
  hn::Vec<hn::RebindToUnsigned<ColumnTag>> ids;

  HWY_INLINE Leaders()
      : sure(broadcast_column(-kInf)),
        sure_code(broadcast_column(0)),
        highest(sure),
        second(sure),
        count(sure_code),
        ids(hn::Zero(hn::RebindToUnsigned<ColumnTag>())) {}

  /// A triangle that may lie as high as `high`.
  HWY_INLINE void add(uint32_t id, PacketMask possible, ColumnFloats high) {
    const hn::RebindToUnsigned<ColumnTag> du;
    count = hn::IfThenElse(possible, hn::Add(count, broadcast_column(1)), count);
    second = hn::IfThenElse(possible, hn::Max(second, hn::Min(high, highest)), second);
    const PacketMask higher = hn::And(possible, hn::Gt(high, highest));
    highest = hn::IfThenElse(higher, high, highest);
    ids = hn::IfThenElse(hn::RebindMask(du, higher), hn::Set(du, id), ids);
  }

  HWY_INLINE FirstHits result(uint32_t lanes) const {
    const uint32_t any = lanes & bits_of(hn::Gt(count, broadcast_column(0)));
    const PacketMask rivals = hn::And(hn::Gt(count, broadcast_column(1)), hn::Ge(second, sure));
    const PacketMask too_many = hn::Gt(count, broadcast_column(static_cast<float>(kMostCandidates)));
    FirstHits found;  // NOLINT: written now
    found.several = any & bits_of(hn::Or(rivals, too_many));
    found.one = any & ~found.several;
    hn::Store(ids, hn::RebindToUnsigned<ColumnTag>(), found.ids);
    return found;
  }
};

/// For columns that start before all triangles.
HWY_INLINE FirstHits find_first(const CoverageGrid& grid, const Packet& packet, uint32_t lanes,
                                const CoverageCell& cell, const CoverageTile& tile, uint64_t& tests) {
  const CoverageReference* reference = grid.references.data() + cell.first;
  const CoverageReference* end = grid.references.data() + (&cell)[1].first;
  Leaders leaders;
  uint32_t open = lanes;
  for (; reference != end; ++reference) {
    open &= ~bits_of(hn::Lt(broadcast_column(reference->top), leaders.sure_code));
    if (open == 0) break;
    const CoverageTriangle& triangle = grid.triangles[reference->triangle()];
    tests += static_cast<uint64_t>(std::popcount(open));
    const ColumnFloats inside = packet.inside(triangle);
    const uint32_t met = open & bits_of(hn::Ge(inside, broadcast_column(-triangle.margin)));
    if (met == 0) continue;
    ColumnFloats high = broadcast_column(kInf);
    PacketMask possible = mask_of(ColumnTag(), met);
    if (triangle.per_ahead > 0) {
      const ColumnFloats depth = packet.depth(triangle);
      const ColumnFloats radius = broadcast_column(2 * triangle.margin * triangle.per_ahead);
      const ColumnFloats low = hn::Sub(depth, radius);
      high = hn::Add(depth, radius);
      possible = hn::And(possible, hn::Ge(high, leaders.sure));
      const auto is_sure = hn::And(hn::Gt(low, leaders.sure), hn::Gt(inside, broadcast_column(triangle.margin)));
      const PacketMask surer = hn::And(possible, is_sure);
      leaders.sure = hn::IfThenElse(surer, low, leaders.sure);
      leaders.sure_code = hn::IfThenElse(surer, hn::Sub(codes_of(tile, low), broadcast_column(2)), leaders.sure_code);
    }
    leaders.add(triangle.id, possible, high);
  }
  return leaders.result(lanes);
}

}  // namespace
}  // namespace raygrain::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif

// Sorting rays for a tracer that does not do so itself: what its user would do before a call and after it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "structured_rays.h"

namespace raygrain::bench {

/// The rays in the order of the Morton code of where they cross their frame, which suits anybody's tree: by a radix
/// sort on all threads, in memory that is there before.
class RaySorter {
 public:
  /// Keeps the rays by reference.
  RaySorter(const StructuredRays& rays, unsigned threads);

  /// Sorts afresh.
  const BenchRays& sort();
  /// The answers to sorted rays, in the order in which the rays were given.
  void unsort(const Answers& found, Answers& answers) const;

 private:
  static constexpr unsigned kDigitBits = 11, kDigits = 2, kBuckets = 1u << kDigitBits;

  struct Keyed {
    uint32_t key, number;
  };

  void make_keys();
  void sort_by_digit(unsigned shift);
  /// body(part, begin, end) for one part a thread.
  template <class Body>
  void for_parts(const Body& body) const;

  const StructuredRays& rays_;
  AreaGeometry geometry_;
  unsigned threads_;
  std::vector<Keyed> items_, others_;
  std::vector<std::array<uint32_t, kBuckets>> places_;  // of each part: where its next item of a bucket goes
  BenchRays sorted_;
};

}  // namespace raygrain::bench

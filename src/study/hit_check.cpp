#include "study/hit_check.h"

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"
#include "geometry/same_bits.h"

namespace raygrain {

std::vector<Hit> find_hits(std::span<const Ray> rays, const Search& search, unsigned threads,
                           const std::function<void(double part)>& tell) {
  std::vector<Hit> hits(rays.size());
  const size_t piece = tell ? 256 : rays.size(), grain = tell ? 8 : 64;
  for (size_t start = 0; start < rays.size(); start += piece) {
    if (tell) tell(static_cast<double>(start) / static_cast<double>(rays.size()));
    parallel_for(std::min(piece, rays.size() - start), grain, threads, [&](size_t begin, size_t end) {
      for (size_t i = start + begin; i < start + end; ++i) hits[i] = search(rays[i]);
    });
  }
  return hits;
}

size_t count_mismatches(std::span<const Hit> hits, std::span<const std::vector<Hit>> expected) {
  size_t count = 0;
  for (size_t i = 0; i < hits.size(); ++i) {
    const bool same = std::all_of(expected.begin(), expected.end(), [&](const std::vector<Hit>& list) {
      RAYGRAIN_CHECK_EQ(list.size(), hits.size());
      return same_bits(hits[i], list[i]);
    });
    count += same ? 0 : 1;
  }
  return count;
}

}  // namespace raygrain

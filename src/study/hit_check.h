// Are hits right? Compared bit for bit with independent searches.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "raygrain/ray.h"

namespace raygrain {

using Search = std::function<Hit(const Ray&)>;  // safe to call from several threads

/// The hit of each ray. For slow searches `tell` hears which part is done, from this thread; without it all rays are
/// searched in one go.
std::vector<Hit> find_hits(std::span<const Ray> rays, const Search& search, unsigned threads,
                           const std::function<void(double part)>& tell = {});

/// Rays whose hit differs from at least one of the expected lists (each as long as `hits`).
size_t count_mismatches(std::span<const Hit> hits, std::span<const std::vector<Hit>> expected);

}  // namespace raygrain

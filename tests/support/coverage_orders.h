#pragma once

#include "raygrain/coverage.h"

namespace raygrain::test {

inline constexpr CoverageOrder kCoverageOrders[] = {CoverageOrder::kChosen, CoverageOrder::kAsGiven,
                                                    CoverageOrder::kRuns,   CoverageOrder::kOpenByTile,
                                                    CoverageOrder::kByTile, CoverageOrder::kByCell};

}  // namespace raygrain::test

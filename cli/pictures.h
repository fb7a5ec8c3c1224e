// The pictures of a comparison.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "raygrain/compare.h"
#include "raygrain/report.h"

namespace raygrain::cli {

/// The rows of one area in a comparison: which is the best, and which it is compared with.
struct AreaResult {
  InfluenceArea area;
  size_t best = 0, baseline = 0;  // indices into Comparison::rows
  size_t rival = 0;               // the best row but the baseline: what the baseline stands beside in pictures
};

/// One entry per area, in order. The baseline is SAH+LSPH, or else the area's first row.
std::vector<AreaResult> area_results(const Comparison& comparison);

/// Writes NAME-depth.png and NAME-cost.png of every area into `folder` and returns their paths. `begin` is told what
/// comes next and which share of the pictures is done.
std::vector<std::string> save_pictures(const Comparison& comparison, std::span<const AreaResult> results,
                                       const std::string& folder, unsigned threads,
                                       const std::function<void(const std::string&, double)>& begin);

ReportRow report_row(const ComparisonRow& row);

}  // namespace raygrain::cli

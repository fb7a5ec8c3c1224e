// Results of the paper's 64 tests that say what the paper says, as a study would write them.
#pragma once

#include <string>
#include <vector>

#include "raygrain/study_report.h"

namespace raygrain::test {

/// A table of the paper's four recipes and `own`, whose costs are 0.8 times those of SAH+LSPH. With `published` costs
/// the means of the figures are the printed ones.
ResultTable paper_results(const std::vector<std::string>& own = {});

/// The chart with this label or title; fails the test and gives an empty one where there is none.
Chart chart_of(const StudyReport& report, const std::string& label);

/// The value of a series in a group; NaN where there is none.
double value_of(const std::vector<ChartPoint>& points, const std::string& series, const std::string& group);

}  // namespace raygrain::test

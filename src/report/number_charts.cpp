// Charts over a number: areas, triangles, thresholds, hit ratios.
#include "report/charts.h"

namespace raygrain {

std::vector<Chart> number_charts(const StudyResults&) {
  return {};
}

}  // namespace raygrain

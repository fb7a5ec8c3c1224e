// One function per ready-made study.
#pragma once

#include "raygrain/study.h"

namespace raygrain::study {

StudyGrid paper_grid(const StudySources& sources);
StudyGrid published_grid(const StudySources& sources);
StudyGrid corrected_grid(const StudySources& sources);
StudyGrid parameters_grid(const StudySources& sources);
StudyGrid scaling_grid(const StudySources& sources);
Study areas_study(const StudySources& sources);
Study memory_study(const StudySources& sources);
Study stress_study(const StudySources& sources);
Study visibility_study(const StudySources& sources);

}  // namespace raygrain::study

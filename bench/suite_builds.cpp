// How the time of builds grows: one city in three sizes, every preset against Embree's quality.
#include "presets.h"
#include "suite.h"

namespace raygrain::bench {

void run_builds(const Settings& settings, Results& results) {
  std::vector<std::string> sources{"procedural:city?size=15", "procedural:city?size=48"};
  if (!settings.quick) sources.emplace_back("procedural:city?size=96");
  for (const std::string& source : sources)
    if (source.find(settings.filter) != std::string::npos) measure_builds(load_bench_scene(source), settings, results);
}

}  // namespace raygrain::bench

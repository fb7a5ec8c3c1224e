// CSV files: rays, results.
#include <algorithm>
#include <bit>
#include <cstring>

#include "raygrain/io.h"
#include "raygrain/study_report.h"

#include "files.h"

namespace raygrain::fuzz {

namespace {

bool same_bits(float a, float b) {
  return std::bit_cast<uint32_t>(a) == std::bit_cast<uint32_t>(b) || (std::isnan(a) && std::isnan(b));
}

bool same_ray(const Ray& a, const Ray& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!same_bits(a.origin[axis], b.origin[axis]) || !same_bits(a.direction[axis], b.direction[axis])) return false;
  return same_bits(a.tmin, b.tmin) && same_bits(a.tmax, b.tmax);
}

}  // namespace

void rays(Bytes bytes) {
  static const MemoryFile file, written;
  file.set(bytes);
  std::vector<Ray> rays;
  if (!accepts([&] { rays = load_rays(file.path()); })) return;
  written.set({});
  save_rays(rays, written.path());
  const std::vector<Ray> again = load_rays(written.path());
  require(std::equal(rays.begin(), rays.end(), again.begin(), again.end(), same_ray), "written rays are others");
}

void results(Bytes bytes) {
  static const MemoryFile file;
  file.set(bytes);
  accepts([&] {
    const std::vector<ResultTable> tables{load_results(file.path())};
    const StudyReport report = make_study_report(tables);
    require(!study_report_json(report).empty(), "no JSON");
    require(static_page(report, "").find("</html>") != std::string::npos, "no page");
    report_markdown(report, [](const Chart&, size_t) { return std::string(); });
    for (const ChartSection& section : report.sections)
      for (const Chart& chart : section.charts)
        for (const ChartPanel& panel : chart.panels) require(chart_image(panel).width > 0, "an empty picture");
  });
}

}  // namespace raygrain::fuzz

// Tables and pictures for people, JSON and CSV for programs.
#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/accelerator.h"
#include "raygrain/build.h"
#include "raygrain/fields.h"
#include "raygrain/io.h"

namespace raygrain {

/// One line of a report: a named thing and its values.
struct ReportRow {
  std::string name, area;
  FieldValues values;
};

/// An aligned text table, numbers right-aligned, with a header of field names. Columns without any value are left out.
std::string text_table(std::span<const ReportRow> rows, std::span<const FieldId> columns);

/// A value for people: costs with 2 decimals, ratios with 3, counts whole, seconds with 3 significant digits, bytes as
/// KiB or MiB; "-" for NaN.
std::string value_text(FieldId id, double value);

/// One line: what the best row costs, with pruning, against the baseline of the same area.
std::string verdict(const ReportRow& best, const ReportRow& baseline);

/// RFC 4180 CSV: name, area, then every field that any row has.
std::string csv_table(std::span<const ReportRow> rows, std::span<const FieldId> columns);

/// What a figure was measured on; everything here may differ between two runs of the same input.
struct Environment {
  std::string commit, compiler, cpu;
  unsigned threads = 0;
};
Environment current_environment(unsigned threads);

/// {"scene", "triangles", "seed", "environment", "rows": [{"name", "area", field: value ...}]}, indented, keys in
/// order. NaN becomes null.
std::string report_json(const std::string& scene, size_t triangles, uint64_t seed, const Environment& environment,
                        std::span<const ReportRow> rows, std::span<const FieldId> columns);

/// Width and height in the proportions of the area's window, the longer side `longest` pixels (at least 16 each).
struct PictureSize {
  uint32_t width = 0, height = 0;
};
PictureSize picture_size(const InfluenceArea& area, uint32_t longest);

/// A grey picture of the nearest surfaces: brightness by facing and depth; misses in a dark blue.
Image shaded_depth(const TriangleMesh& mesh, const Bvh& bvh, const InfluenceArea& area, uint32_t width, uint32_t height,
                   unsigned threads = 0);

/// The picture in a frame, with a line of text above and one below.
Image captioned(const Image& picture, const std::string& title, const std::string& caption);

/// Pruned cost per pixel of a tree, as numbers.
struct CostImage {
  uint32_t width = 0, height = 0;
  std::vector<float> cost;
};
CostImage cost_image(const Bvh& bvh, const TriangleMesh& mesh, const InfluenceArea& area, uint32_t width,
                     uint32_t height, const CostModel& costs = {}, unsigned threads = 0);

/// Heat maps side by side under one scale, titled, each with its mean and highest cost below, and one labelled colour
/// bar. Lightness rises evenly with cost, so the colours are safe for colour-blind readers. The scale ends at the 99th
/// percentile of all pixels; what lies above has the colour of its end.
Image heat_maps(std::span<const std::pair<std::string, CostImage>> maps);

}  // namespace raygrain

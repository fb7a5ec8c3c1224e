// A chart as data: what it shows, its values, and what it says of the paper. Drawn by the interactive page, or as SVG
// and pixels without one.
#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include "raygrain/io.h"

namespace raygrain {

inline constexpr double kNotMeasured = std::numeric_limits<double>::quiet_NaN();

/// How a panel shows its points.
enum class ChartKind {
  kBars,     // upright bars: one per series in each group
  kRanking,  // the same lying down: for long names
  kDots,     // one line per group, a dot per series on it
  kPoints,   // a dot at (x, y)
  kLines,    // dots at (x, y), those of a series joined in the order of x
  kMatrix,   // a row per series, a column per group: values as numbers, coloured by their ratio to `reference`
};

/// One value; for a mean also what it is the mean of.
struct ChartPoint {
  std::string series{};
  std::string group{};                             // kBars, kRanking, kDots
  double x = kNotMeasured;                         // kPoints, kLines
  double y = kNotMeasured;                         // the value
  double low = kNotMeasured, high = kNotMeasured;  // least and greatest of the values behind a mean
  size_t count = 1;                                // number of values behind a mean
  std::string label{};                             // what it is, in words; may be empty
};

struct ChartSeries {
  std::string name{};
  std::string colour{};  // #rrggbb, readable on white and on black
};

struct ChartAxis {
  std::string title{};
  bool logarithmic = false;
};

/// One pair of axes.
struct ChartPanel {
  std::string title{};
  ChartKind kind = ChartKind::kBars;
  ChartAxis x{}, y{};  // of the chart lying down: y is the axis of the values in every kind
  std::vector<std::string> groups{};
  std::vector<ChartSeries> series{};
  std::vector<ChartPoint> measured{};
  std::vector<ChartPoint> published{};  // the paper's values of the same series and groups
  double reference = kNotMeasured;      // a line across at this value, e.g. 1 for ratios
};

struct ChartTable {
  std::vector<std::string> columns{};
  std::vector<std::vector<std::string>> rows{};
};

/// What the measured values say of the paper.
enum class Verdict {
  kConfirms,
  kPartly,
  kContradicts,
  kExtends,       // the paper has no such experiment
  kIncomparable,  // measured, but not on what the paper's values are of
  kMissing,       // the files hold nothing to judge by
};
/// "confirms", "partly confirms", "contradicts", "goes beyond the paper", "not comparable", "not measured".
const char* name(Verdict verdict);

/// One figure or table: panels, the one that shows what users pay first, and one sentence.
struct Chart {
  std::string id{};     // letters, digits and -: for links and file names
  std::string label{};  // "Figure 16", or empty
  std::string title{};
  std::string finding{};  // one sentence: what it shows and whether that confirms the paper
  Verdict verdict = Verdict::kExtends;
  std::vector<std::string> notes{};
  std::vector<ChartPanel> panels{};
  ChartTable table{};
};

/// The panel as a picture, 960 wide: SVG 1.1, one element, text as text.
std::string chart_svg(const ChartPanel& panel);
/// The same in pixels.
Image chart_image(const ChartPanel& panel);

}  // namespace raygrain

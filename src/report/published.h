// What the paper published, as data: Ray Distribution Aware Heuristics for Bounding Volume Hierarchies Construction in
// Ray Tracing (2024), section 9 and its supplemental results.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "raygrain/chart.h"

namespace raygrain {

/// The groups of the paper's charts: kinds of influence areas by directions of their rays.
struct PaperGroup {
  std::string_view kind, variant;  // as in results files
  std::string_view label;
};
inline constexpr std::array<PaperGroup, 8> kPaperGroups{{
    {"plane", "parallel", "plane parallel"},
    {"plane", "15deg", "plane 15°"},
    {"plane", "45deg", "plane 45°"},
    {"plane", "oblique", "plane oblique"},
    {"point", "parallel", "point parallel"},
    {"point", "15deg", "point 15°"},
    {"point", "45deg", "point 45°"},
    {"point", "oblique", "point oblique"},
}};
/// Values in the order of kPaperGroups; NaN where there is none.
using PaperValues = std::array<double, 8>;

/// The scenes of the study; the models of the first six are the authors' own.
inline constexpr std::array<std::string_view, 8> kPaperScenes{"Wood",      "Suzanne",    "Cottage", "CottageWalls",
                                                              "Random100", "Random1000", "Crowd",   "Sponza"};
inline constexpr size_t kOwnModels = 6;

/// Mean cost in full traversal of a recipe's trees.
struct PublishedCost {
  std::string_view recipe;
  PaperValues eight_scenes;  // as printed in figures 16, 17 and 18
  PaperValues six_scenes;    // of the authors' raw results, the first six scenes alone
};
/// Null for recipes that the paper does not have.
const PublishedCost* published_cost(std::string_view recipe);

/// The recipe that the point half of figure 17 really shows: SAH+SPFH with threshold 0.99.
inline constexpr std::string_view kMislabelledRecipe = "PAH+LSPH-as-published";

inline constexpr PaperValues kErrorOfPah{0.0125, 0.008, 0.011, 0.013, 0.070, 0.107, 0.158, 0.176};  // figure 14
inline constexpr PaperValues kErrorOfSah{0.400, 0.322, 0.218, 0.503, 0.225, 0.192, 0.245, 0.303};   // figure 14
inline constexpr PaperValues kSplitTimeOfSpfh{8.0, 10.0, 11.0, 8.7, 9.3, 9.7, 10.4, 8.3};           // figure 19, ms
inline constexpr PaperValues kSplitTimeOfLsph{10.4, 10.5, 10.8, 8.5, 9.6, 10.2, 11.8, 8.9};         // figure 19, ms
inline constexpr double kOrientationsOfSpfh = 2.1, kOrientationsOfLsph = 1.5;                       // section 9.4
inline constexpr double kOverlapCorrelation = 0.39;  // of figure 20's points
/// Figure 22 from the raw results; the printed values differ by up to 10 %.
inline constexpr PaperValues kOverlapOfStandard{0.611, 0.668, 0.643, 0.688, 0.670, 0.691, 0.701, 0.671};
inline constexpr PaperValues kOverlapOfFull{0.387, 0.613, 0.625, 0.687, 0.590, 0.587, 0.687, 0.631};
inline constexpr PaperValues kPrintedOverlapOfStandard{0.622, 0.646, 0.633, 0.672, 0.665, 0.698, 0.678, 0.663};
inline constexpr PaperValues kPrintedOverlapOfFull{0.374, 0.601, 0.622, 0.683, 0.574, 0.590, 0.695, 0.623};

/// A row of table 2: three thresholds and what PAH+SPFH gave with them, mean of 64 tests.
struct PublishedTuning {
  double quality, acceptable, excellent;
  double cost, orientations, fallback_share;
};
inline constexpr std::array<PublishedTuning, 5> kTable2{{
    {0.4, 1.3, 0.9, 110.5, 1.8, 0.34},
    {0.1, 1.3, 0.9, 88.4, 2.4, 0.13},
    {0.8, 1.3, 0.9, 148.3, 1.5, 0.68},
    {0.4, 1.1, 0.7, 69.1, 2.0, 0.41},
    {0.4, 1.5, 1.1, 124.6, 1.7, 0.29},
}};

/// Published values as points of a series, in the paper's groups.
std::vector<ChartPoint> published_points(std::string_view series, const PaperValues& values, std::string_view label);

}  // namespace raygrain

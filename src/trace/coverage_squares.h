// One triangle against the cells that it may meet.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "trace/coverage_triangle.h"

namespace raygrain {

/// The middle of a cell and half its width.
struct CellSquare {
  double x, y, half;
};

/// A triangle that a cell may meet.
struct InCell {
  float highest, lowest;  // depths there, widened by errors
  uint32_t slot;          // of the tile's triangles
  uint16_t cell;          // of the tile's cells
  uint8_t edges;          // those that a column of the cell may come near: a bit each
  bool is_filled;         // every column of the cell meets the triangle, strictly
};

/// Tests against squares of one size: what does not depend on their places is known beforehand.
class SquareTests {
 public:
  SquareTests(const SeenTriangle& seen, double half) : seen_(seen), room_(half + 2 * seen.margin) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    reach_.fill(kInfinity);
    if (seen.is_clear) {
      lines_ = seen.edges;
      for (size_t i = 0; i < 3; ++i)
        reach_[i] = (std::abs(lines_[i][0]) + std::abs(lines_[i][1])) * (half + seen.margin) + seen.margin;
    }
    depth_reach_ = kInfinity;
    if (!seen.has_plane) return;
    slope_x_ = seen.slope_x, slope_y_ = seen.slope_y, offset_ = seen.offset;
    depth_reach_ = (std::abs(slope_x_) + std::abs(slope_y_)) * (half + seen.margin) + seen.plane_error;
  }

  /// The edges, a bit each, whose boxes come near columns of these x, or of these y.
  unsigned edges_near_x(double x) const { return edges_near<0>(x); }
  unsigned edges_near_y(double y) const { return edges_near<2>(y); }

  /// False where an edge tells that neither the square about (x, y) nor those at lesser x meet the triangle: rounding
  /// keeps the order of values along a line of cells.
  bool goes_on_at(double x, double y) const {
    return !(bit(lines_[0][0] > 0) & bit(at(0, x, y) < -reach_[0])) &&
           !(bit(lines_[1][0] > 0) & bit(at(1, x, y) < -reach_[1])) &&
           !(bit(lines_[2][0] > 0) & bit(at(2, x, y) < -reach_[2]));
  }

  /// False where no column within the square about (x, y), or within margins of that, can meet the triangle, by its
  /// edges; that is so for all squares of a line but for some in a row. Otherwise sets all of `one` but its numbers.
  /// `edges_near` are those near both x and y.
  bool meet(double x, double y, unsigned edges_near, InCell& one) const {
    const double a = at(0, x, y), b = at(1, x, y), c = at(2, x, y);
    if (a < -reach_[0] || b < -reach_[1] || c < -reach_[2]) return false;
    const unsigned inside = bit(a > reach_[0]) | bit(b > reach_[1]) << 1 | bit(c > reach_[2]) << 2;
    one.is_filled = inside == 7;
    one.edges = static_cast<uint8_t>(edges_near & ~inside);
    const double s = slope_x_ * x + slope_y_ * y + offset_;
    one.highest = static_cast<float>(std::min(seen_.s_hi, s + depth_reach_));
    one.lowest = static_cast<float>(std::max(seen_.s_lo, s - depth_reach_));
    return true;
  }

 private:
  double at(size_t edge, double x, double y) const {
    return lines_[edge][0] * x + lines_[edge][1] * y + lines_[edge][2];
  }

  static unsigned bit(bool value) { return value; }

  template <size_t kLo>
  unsigned edges_near(double at) const {
    unsigned edges = 0;
    for (size_t i = 0; i < 3; ++i) {
      const auto& box = seen_.edge_boxes[i];
      edges |= (bit(!(at + room_ < box[kLo])) & bit(!(at - room_ > box[kLo + 1]))) << i;
    }
    return edges;
  }

  const SeenTriangle& seen_;
  double room_;
  std::array<std::array<double, 3>, 3> lines_ = {};  // zero, within reach, where edges tell nothing
  std::array<double, 3> reach_;
  double slope_x_ = 0, slope_y_ = 0, offset_ = 0, depth_reach_;
};

}  // namespace raygrain

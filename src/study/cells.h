// The cells of one row, set by name.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "raygrain/study.h"

#include "base/check.h"

namespace raygrain::study {

class Cells {
 public:
  /// Refers to the columns. What is never set stays empty.
  explicit Cells(const std::vector<StudyColumn>& columns) : columns_(columns), cells_(columns.size()) {}

  void set(std::string_view column, std::string text) {
    size_t i = 0;
    while (i < columns_.size() && columns_[i].name != column) ++i;
    RAYGRAIN_CHECK_LT(i, columns_.size());  // a column of this study
    if (i < columns_.size()) cells_[i] = std::move(text);
  }
  void set(std::string_view column, double value) { set(column, study_cell(value)); }

  std::vector<std::string> take() { return std::move(cells_); }

 private:
  const std::vector<StudyColumn>& columns_;
  std::vector<std::string> cells_;
};

}  // namespace raygrain::study

// The append-only file of a study in progress: every finished row is on the disk before the next one counts.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "raygrain/study.h"

namespace raygrain::study {

class Journal {
 public:
  /// Opens or creates FOLDER/results.partial.csv for this study alone, and says so in FOLDER/study.txt. A last line
  /// without its end, which a kill leaves, is cut off. Throws Error: kUsage (rows or finished results of another study,
  /// another run is writing), kMalformed, kUnwritable; nothing is changed then.
  Journal(const Study& study, const std::string& folder);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// Rows that were there, and those appended since, sorted by key.
  const std::map<StudyKey, std::vector<std::string>>& rows() const { return rows_; }

  /// One write, then brought to the disk. Not for two threads at once.
  void append(const StudyKey& key, std::vector<std::string> row);

  /// Writes FOLDER/results.csv and removes the journal.
  void finish(const std::vector<std::string>& header);

 private:
  void check_finished(const Study& study) const;
  void read_rows(const Study& study);
  void write(const std::string& text);

  std::string folder_, path_;
  int descriptor_ = -1;
  std::map<StudyKey, std::vector<std::string>> rows_;
};

}  // namespace raygrain::study

// One line on the terminal that says what is being done and how much of it is done; erased at the end.
#pragma once

#include <string>

#include "base/timer.h"

namespace raygrain::cli {

inline constexpr char kEraseLine[] = "\r\033[K";

/// Shows nothing in the first second, where standard error is no terminal, or when not wanted. Not for several threads
/// at once.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress() { erase(); }
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` in [0, 1].
  void show(const std::string& step, double done);
  /// Shown at once: for steps that are known to be long and cannot report.
  void announce(const std::string& step);
  void erase();

 private:
  void draw(const std::string& line);

  bool enabled_;
  bool shown_ = false;
  double last_drawn_ = 0;
  Timer timer_;
};

}  // namespace raygrain::cli

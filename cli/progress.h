// One line on the terminal that says what is being done and how much of it is done; erased at the end.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/timer.h"

namespace raygrain::cli {

inline constexpr char kEraseLine[] = "\r\033[K";

/// Shows nothing in the first second, where standard error is no terminal, or when not wanted. A thread of its own
/// draws the latest step, so that a long one is seen however early it began. Not for several threads at once.
class Progress {
 public:
  explicit Progress(bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` in [0, 1]. Starts a thread: nothing may fork afterwards.
  void show(const std::string& step, double done);
  /// Shown at once, without a thread: for steps that are known to be long and cannot report.
  void announce(const std::string& step);
  void erase();

 private:
  void draw_repeatedly();
  void draw(const std::string& line);

  bool enabled_;
  Timer timer_;
  std::mutex mutex_;  // for all below
  std::condition_variable wake_;
  bool stopping_ = false;
  std::string wanted_, drawn_;  // lines; empty: none
  std::thread thread_;
};

}  // namespace raygrain::cli

// Tells a callback how far a job is, and lets it cancel.
#pragma once

#include <functional>
#include <string>

#include "raygrain/error.h"

namespace raygrain {

class Progress {
 public:
  using Callback = std::function<bool(const std::string& step, double done)>;

  Progress(const Callback& callback, size_t steps) : callback_(callback), steps_(steps) {}

  /// Announces the next step. Throws Error (kCancelled) when the callback returns false.
  void begin(const std::string& step) {
    step_ = step;
    ++begun_;
    advance(0);
  }
  /// A part of the current step is done, in [0, 1]. Throws Error (kCancelled) as begin does.
  void advance(double part) {
    const double done = (static_cast<double>(begun_) - 1 + part) / static_cast<double>(steps_);
    if (callback_ && !callback_(step_, done)) throw Error(ErrorCode::kCancelled, step_, "cancelled");
  }
  /// All steps are done.
  void finish() {
    begun_ = steps_;
    begin("done");
  }

 private:
  const Callback& callback_;
  size_t steps_, begun_ = 0;
  std::string step_;
};

}  // namespace raygrain

// One progress out of that of several builds which run at the same time.
#pragma once

#include <functional>
#include <mutex>
#include <vector>

#include "raygrain/error.h"

namespace raygrain {

class JointProgress {
 public:
  using Tell = std::function<bool(double done)>;

  /// All parts count alike. An empty `tell` is never called.
  JointProgress(const Tell& tell, size_t parts) : tell_(tell), done_(parts) {}

  /// What part `i` reports to, scaled to [from, to] of it; empty where nobody listens.
  Tell part(size_t i, double from, double to) {
    if (!tell_) return {};
    return [this, i, from, to](double done) { return report(i, from + done * (to - from)); };
  }

  /// Part `i` is so far by its own account; throws Error kCancelled when the listener says so.
  void reach(size_t i, double done) {
    if (tell_ && !report(i, done)) throw Error(ErrorCode::kCancelled, "build", "cancelled by its caller");
  }

 private:
  bool report(size_t i, double done) {
    const std::lock_guard lock(mutex_);
    if (cancelled_) return false;
    if (done > done_[i]) {
      sum_ += done - done_[i];
      done_[i] = done;
    }
    const double share = sum_ / static_cast<double>(done_.size());
    cancelled_ = !tell_(share < 1 ? share : 1);
    return !cancelled_;
  }

  const Tell& tell_;
  std::mutex mutex_;
  std::vector<double> done_;
  double sum_ = 0;
  bool cancelled_ = false;
};

}  // namespace raygrain

// Progress and cancellation of a build, from any thread.
#pragma once

#include <mutex>

#include "raygrain/build.h"
#include "raygrain/error.h"

namespace raygrain::builder {

/// Counts finished primitives and tells the user's callback; throws Error kCancelled when it says so.
class Monitor {
 public:
  Monitor(const std::function<bool(double)>& progress, size_t total) : progress_(progress), total_(total) {}

  /// `more` primitives are in leaves now.
  void finish(size_t more) {
    if (!progress_) return;
    const std::lock_guard lock(mutex_);
    done_ += more;
    const double share = total_ > 0 ? static_cast<double>(done_) / static_cast<double>(total_) : 1;
    if (!cancelled_) cancelled_ = !progress_(share < 1 ? share : 1);
    if (cancelled_) throw Error(ErrorCode::kCancelled, "build", "cancelled by its caller");
  }

 private:
  const std::function<bool(double)>& progress_;
  const size_t total_;
  std::mutex mutex_;
  size_t done_ = 0;
  bool cancelled_ = false;
};

}  // namespace raygrain::builder

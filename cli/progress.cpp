#include "cli/progress.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/signals.h"

namespace raygrain::cli {

namespace {

constexpr double kDelay = 1.0;                       // seconds before the first line
constexpr std::chrono::milliseconds kInterval{100};  // between lines
constexpr int kBarWidth = 24;

size_t terminal_width() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : size_t{80};
}

void write_error_output(const std::string& text) {
  const ssize_t ignored = ::write(STDERR_FILENO, text.data(), text.size());
  static_cast<void>(ignored);
}

}  // namespace

Progress::Progress(bool wanted) : enabled_(wanted && ::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  if (thread_.joinable()) {
    {
      const std::lock_guard lock(mutex_);
      stopping_ = true;
    }
    wake_.notify_one();
    thread_.join();
  }
  erase();
}

void Progress::show(const std::string& step, double done) {
  if (!enabled_) return;
  done = std::clamp(done, 0.0, 1.0);
  const int filled = static_cast<int>(std::lround(done * kBarWidth));
  std::string line =
      fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %  {}", "", filled, "", kBarWidth - filled, 100 * done, step);
  const std::lock_guard lock(mutex_);
  wanted_ = std::move(line);
  if (!thread_.joinable()) thread_ = start_without_signals([this] { draw_repeatedly(); });
}

void Progress::announce(const std::string& step) {
  if (!enabled_) return;
  const std::lock_guard lock(mutex_);
  wanted_ = step + " ...";
  draw(wanted_);
}

void Progress::erase() {
  const std::lock_guard lock(mutex_);
  wanted_.clear();
  if (drawn_.empty()) return;
  write_error_output(kEraseLine);
  drawn_.clear();
  set_progress_line_shown(false);
}

void Progress::draw_repeatedly() {
  std::unique_lock lock(mutex_);
  while (!stopping_) {
    wake_.wait_for(lock, kInterval);
    if (stopping_ || wanted_.empty() || wanted_ == drawn_ || timer_.seconds() < kDelay) continue;
    if (begin_drawing()) draw(wanted_);
    end_drawing();
  }
}

void Progress::draw(const std::string& line) {
  set_progress_line_shown(true);
  write_error_output(kEraseLine + line.substr(0, terminal_width() - 1));
  drawn_ = line;
}

}  // namespace raygrain::cli

#include "cli/progress.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include "cli/signals.h"

namespace raygrain::cli {

namespace {

constexpr double kDelay = 1.0, kInterval = 0.1;  // seconds before the first line, and between lines
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

void Progress::show(const std::string& step, double done) {
  const double now = timer_.seconds();
  if (!enabled_ || now < kDelay || now < last_drawn_ + kInterval) return;
  last_drawn_ = now;
  done = std::clamp(done, 0.0, 1.0);
  const int filled = static_cast<int>(std::lround(done * kBarWidth));
  draw(fmt::format("[{:#<{}}{:.<{}}] {:3.0f} %  {}", "", filled, "", kBarWidth - filled, 100 * done, step));
}

void Progress::announce(const std::string& step) {
  if (enabled_) draw(step + " ...");
}

void Progress::erase() {
  if (!shown_) return;
  write_error_output(kEraseLine);
  shown_ = false;
  set_progress_line_shown(false);
}

void Progress::draw(const std::string& line) {
  shown_ = true;
  set_progress_line_shown(true);
  write_error_output(kEraseLine + line.substr(0, terminal_width() - 1));
}

}  // namespace raygrain::cli

#include "cli/signals.h"

#include <csignal>
#include <initializer_list>

#include <unistd.h>

#include "raygrain/io.h"

#include "cli/progress.h"

namespace raygrain::cli {

namespace {

// A handler can be told things through such a variable only.
volatile std::sig_atomic_t progress_line_shown = 0;

extern "C" void stop_at_once(int signal) {
  remove_unfinished_files();
  if (progress_line_shown) {
    const ssize_t ignored = ::write(STDERR_FILENO, kEraseLine, sizeof kEraseLine - 1);
    static_cast<void>(ignored);
  }
  ::_exit(128 + signal);
}

void handle(int signal, void (*handler)(int)) {
  struct sigaction action {};
  action.sa_handler = handler;
  ::sigemptyset(&action.sa_mask);
  ::sigaction(signal, &action, nullptr);
}

/// nohup and shells without job control start programs with signals ignored; that is to stay.
bool is_ignored(int signal) {
  struct sigaction action {};
  return ::sigaction(signal, nullptr, &action) == 0 && action.sa_handler == SIG_IGN;
}

}  // namespace

void install_signal_handlers() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(signal)) handle(signal, stop_at_once);
  handle(SIGPIPE, SIG_IGN);
  handle(SIGXFSZ, SIG_IGN);
}

void set_progress_line_shown(bool shown) {
  progress_line_shown = shown ? 1 : 0;
}

}  // namespace raygrain::cli

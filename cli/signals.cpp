#include "cli/signals.h"

#include <atomic>
#include <csignal>
#include <ctime>
#include <initializer_list>

#include <unistd.h>

#include "raygrain/io.h"

#include "cli/output_folder.h"
#include "cli/progress.h"

namespace raygrain::cli {

namespace {

// A handler can be told things through such a variable only.
volatile std::sig_atomic_t progress_line_shown = 0;
std::atomic<bool> is_drawing = false, is_ending = false, is_interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free, "else no handler may use them");

/// Either the drawing thread sees that the end has come, or it is waited for here; not for ever, should the terminal
/// have stopped.
void stop_drawing() {
  is_ending = true;
  constexpr timespec kMillisecond{0, 1'000'000};
  for (int i = 0; i < 200 && is_drawing; ++i) ::nanosleep(&kMillisecond, nullptr);
}

extern "C" void stop_at_once(int signal) {
  remove_unfinished_files();
  remove_empty_new_folders();
  stop_drawing();
  if (progress_line_shown) {
    const ssize_t ignored = ::write(STDERR_FILENO, kEraseLine, sizeof kEraseLine - 1);
    static_cast<void>(ignored);
  }
  ::_exit(128 + signal);
}

extern "C" void stop_at_second(int signal) {
  if (is_interrupted.exchange(true)) stop_at_once(signal);
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

void finish_on_interrupt() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP})
    if (!is_ignored(signal)) handle(signal, stop_at_second);
}

bool was_interrupted() {
  return is_interrupted;
}

void set_progress_line_shown(bool shown) {
  progress_line_shown = shown ? 1 : 0;
}

bool begin_drawing() {
  is_drawing = true;
  return !is_ending;
}

void end_drawing() {
  is_drawing = false;
}

std::thread start_without_signals(const std::function<void()>& run) {
  sigset_t all, before;
  ::sigfillset(&all);
  ::pthread_sigmask(SIG_SETMASK, &all, &before);  // a thread begins with the mask of the one that made it
  std::thread thread(run);
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  return thread;
}

}  // namespace raygrain::cli

// Interruption: Ctrl-C leaves no half-written file and a clean terminal line.
#pragma once

#include <functional>
#include <thread>

namespace raygrain::cli {

/// SIGINT, SIGTERM and SIGHUP remove unfinished files, erase the progress line and exit with 128 + signal. A reader
/// that goes (SIGPIPE) and a file size limit (SIGXFSZ) become errors of the writes themselves.
void install_signal_handlers();

/// From now on a first SIGINT, SIGTERM or SIGHUP only makes was_interrupted() true: for work whose result so far is
/// worth having. A second one ends the program as above.
void finish_on_interrupt();
bool was_interrupted();

/// Tells the handlers whether a progress line stands on standard error.
void set_progress_line_shown(bool shown);

/// Around what another thread than the main one draws, so that it never draws after a handler has erased the line. Not
/// to be drawn when false; end in both cases.
bool begin_drawing();
void end_drawing();

/// A thread that never runs a handler, for handlers wait until it has drawn.
std::thread start_without_signals(const std::function<void()>& run);

}  // namespace raygrain::cli

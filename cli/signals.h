// Interruption: Ctrl-C leaves no half-written file and a clean terminal line.
#pragma once

namespace raygrain::cli {

/// SIGINT, SIGTERM and SIGHUP remove unfinished files, erase the progress line and exit with 128 + signal. A reader
/// that goes (SIGPIPE) and a file size limit (SIGXFSZ) become errors of the writes themselves.
void install_signal_handlers();

/// Tells the handlers whether a progress line stands on standard error.
void set_progress_line_shown(bool shown);

}  // namespace raygrain::cli

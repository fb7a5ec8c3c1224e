// Where results go: standard output for people, or JSON for programs.
#pragma once

#include <cstdint>
#include <string>

#include "cli/arguments.h"

namespace raygrain::cli {

/// What every command accepts.
struct CommonOptions {
  bool quiet = false;
  uint64_t threads = 0;  // 0 = all
  std::string json;      // a file, or - for standard output; empty: none

  unsigned thread_count() const { return static_cast<unsigned>(threads); }
};
void add_common(Arguments& arguments, CommonOptions& options);

/// Thrown when the reader of standard output has gone (raygrain ... | head): not an error, but nothing is left to do.
struct ReaderGone {};

/// Writes all of it to standard output now. Throws Error (kUnwritable), or ReaderGone.
void write_standard_output(const std::string& text);

/// Throws Error (kUnwritable) where a file could not be made later; makes none. "-" and "" are always good.
void require_writable(const std::string& path);

/// Results of one command. With --json - standard output holds the JSON and nothing else.
class Output {
 public:
  /// Checks at once that the JSON can be written later.
  explicit Output(const CommonOptions& options);

  /// Results for people.
  void print(const std::string& text) const;
  /// What is good to know but no result; --quiet leaves it out.
  void note(const std::string& text) const;
  void save_json(const std::string& json) const;

 private:
  bool quiet_;
  std::string json_path_;
};

}  // namespace raygrain::cli

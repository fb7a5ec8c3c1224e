// What a command accepts: a thin face over CLI11, so that only two files compile it and every value is checked the same
// way.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/vec.h"

#include "cli/separate_files.h"

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace raygrain::cli {

/// What a chosen command does after parsing; returns the exit code.
using Action = std::function<int()>;

/// The operands and options of one command. Targets must outlive parsing. Values that do not fit throw Error (kUsage).
class Arguments {
 public:
  explicit Arguments(CLI::App& app);

  /// Something to read: a file, or what is none.
  void operand(const std::string& name, std::string& target, const std::string& help);
  /// One or more, the last operands of the command.
  void operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);
  /// None or more, the last operands of the command.
  void optional_operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);
  void text(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  /// The name of a file or folder to read. "-" is refused, here and below, so that none of that name is made.
  void file(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  /// Files to read, comma-separated, may be repeated.
  void files(const std::string& flags, const std::string& value_name, std::vector<std::string>& targets,
             const std::string& help);
  /// The name of a file to write. No command runs that would write over a file it reads or writes (require_separate).
  void output(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  /// The name of a folder for files of these names.
  void output_folder(const std::string& flags, const std::string& value_name, std::string& target,
                     std::vector<std::string> names, const std::string& help);
  /// One more file that the option `name` writes; none where `path` gives "" or "-". Asked once all is parsed.
  void writes(const std::string& name, std::function<std::string()> path);
  /// The option with these flags must be given.
  void require(const std::string& flags);
  /// Comma-separated, may be repeated.
  void list(const std::string& flags, const std::string& value_name, std::vector<std::string>& target,
            const std::string& help);
  void flag(const std::string& flags, bool& target, const std::string& help);
  /// A whole number in [lo, hi]. Where it is none, the message gives an example.
  struct Limits {
    uint64_t lo = 0, hi = UINT64_MAX, example = 1000;
  };
  void whole(const std::string& flags, uint64_t& target, Limits limits, const std::string& help);
  void optional_whole(const std::string& flags, std::optional<uint64_t>& target, Limits limits,
                      const std::string& help);
  /// A number strictly between lo and hi.
  void real(const std::string& flags, const std::string& value_name, std::optional<float>& target,
            std::pair<float, float> between, const std::string& help);
  /// `example`: a value for messages, here and below.
  void vector(const std::string& flags, std::optional<Vec3>& target, const std::string& example,
              const std::string& help);
  void two_vectors(const std::string& flags, const std::string& value_names,
                   std::optional<std::pair<Vec3, Vec3>>& target, const std::string& example, const std::string& help);

  /// Options added from now on stand under this title in the help.
  void group(const std::string& title) { group_ = title; }
  /// Text below the help.
  void footer(const std::string& text);

  /// A command below this one, of which exactly one must be given.
  Arguments command(const std::string& name, const std::string& help);
  /// Runs when this command was chosen, after the check of its files.
  void action(std::function<void()> on_chosen);

 private:
  struct Files;  // what the command reads and writes

  void add_file(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  CLI::Option* add_operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);

  CLI::App* app_;
  std::shared_ptr<Files> files_;
  std::string group_;
};

}  // namespace raygrain::cli

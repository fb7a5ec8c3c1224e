// What a command accepts: a thin face over CLI11, so that only two files compile it and every value is checked the same
// way.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "raygrain/vec.h"

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
  explicit Arguments(CLI::App& app) : app_(&app) {}

  void operand(const std::string& name, std::string& target, const std::string& help);
  /// One or more, the last operands of the command.
  void operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);
  /// None or more, the last operands of the command.
  void optional_operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);
  void text(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  /// The name of a file or folder. "-" is refused, so that none of that name is made.
  void file(const std::string& flags, const std::string& value_name, std::string& target, const std::string& help);
  /// The option with these flags must be given.
  void require(const std::string& flags);
  /// Comma-separated, may be repeated.
  void list(const std::string& flags, const std::string& value_name, std::vector<std::string>& target,
            const std::string& help);
  void flag(const std::string& flags, bool& target, const std::string& help);
  /// A whole number in [lo, hi].
  struct Limits {
    uint64_t lo = 0, hi = UINT64_MAX;
  };
  void whole(const std::string& flags, uint64_t& target, Limits limits, const std::string& help);
  void optional_whole(const std::string& flags, std::optional<uint64_t>& target, Limits limits,
                      const std::string& help);
  /// A number strictly between lo and hi.
  void real(const std::string& flags, const std::string& value_name, std::optional<float>& target,
            std::pair<float, float> between, const std::string& help);
  void vector(const std::string& flags, std::optional<Vec3>& target, const std::string& help);
  void two_vectors(const std::string& flags, const std::string& value_names,
                   std::optional<std::pair<Vec3, Vec3>>& target, const std::string& help);

  /// Options added from now on stand under this title in the help.
  void group(const std::string& title) { group_ = title; }
  /// Text below the help.
  void footer(const std::string& text);

  /// A command below this one, of which exactly one must be given.
  Arguments command(const std::string& name, const std::string& help);
  /// Runs when this command was chosen.
  void action(std::function<void()> on_chosen);

 private:
  CLI::Option* add_operands(const std::string& name, std::vector<std::string>& targets, const std::string& help);

  CLI::App* app_;
  std::string group_;
};

}  // namespace raygrain::cli

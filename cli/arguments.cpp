#include "cli/arguments.h"

#include <CLI/CLI.hpp>

#include "cli/values.h"

namespace raygrain::cli {

namespace {

/// "-o,--output" -> "--output": the name that messages use.
std::string long_name(const std::string& flags) {
  const size_t start = flags.find("--");
  return start == std::string::npos ? flags : flags.substr(start);
}

void describe(CLI::Option* option, const std::string& value_name, const std::string& group) {
  option->type_name(value_name);
  if (!group.empty()) option->group(group);
}

CLI::Option* add_text(CLI::App& app, const std::string& flags, const std::function<void(const std::string&)>& take,
                      const std::string& help) {
  return app.add_option_function<std::string>(flags, take, help);
}

}  // namespace

void Arguments::operand(const std::string& name, std::string& target, const std::string& help) {
  const auto take = [&target, name](const std::string& value) {
    if (value.empty()) fail_usage(name, "is empty", "Give its name, or see --help");
    target = value;
  };
  describe(add_text(*app_, name, take, help)->required(), "", group_);
}

CLI::Option* Arguments::add_operands(const std::string& name, std::vector<std::string>& targets,
                                     const std::string& help) {
  const auto take = [&targets, name](const std::vector<std::string>& values) {
    for (const std::string& value : values)
      if (value.empty()) fail_usage(name, "is empty", "Give its name, or see --help");
    targets = values;
  };
  CLI::Option* option = app_->add_option_function<std::vector<std::string>>(name, take, help);
  describe(option, "", group_);
  return option;
}

void Arguments::operands(const std::string& name, std::vector<std::string>& targets, const std::string& help) {
  add_operands(name, targets, help)->required();
}

void Arguments::optional_operands(const std::string& name, std::vector<std::string>& targets, const std::string& help) {
  add_operands(name, targets, help);
}

void Arguments::text(const std::string& flags, const std::string& value_name, std::string& target,
                     const std::string& help) {
  const auto take = [&target, name = long_name(flags)](const std::string& value) {
    if (value.empty()) fail_usage(name, "is empty", "Give a value after it");
    target = value;
  };
  describe(add_text(*app_, flags, take, help), value_name, group_);
}

void Arguments::file(const std::string& flags, const std::string& value_name, std::string& target,
                     const std::string& help) {
  const auto take = [&target, name = long_name(flags)](const std::string& value) {
    if (value.empty()) fail_usage(name, "is empty", "Give a name after it");
    if (value == "-") fail_usage(name, "needs a file: only --json takes - for standard output", "Give a name after it");
    target = value;
  };
  describe(add_text(*app_, flags, take, help), value_name, group_);
}

void Arguments::require(const std::string& flags) {
  app_->get_option(long_name(flags))->required();
}

void Arguments::list(const std::string& flags, const std::string& value_name, std::vector<std::string>& target,
                     const std::string& help) {
  CLI::Option* option = app_->add_option(flags, target, help);
  describe(option->delimiter(',')->expected(1, 1000)->allow_extra_args(false)->take_all(), value_name, group_);
}

void Arguments::flag(const std::string& flags, bool& target, const std::string& help) {
  describe(app_->add_flag(flags, target, help), "", group_);
}

void Arguments::whole(const std::string& flags, uint64_t& target, Limits limits, const std::string& help) {
  const auto take = [&target, limits, name = long_name(flags)](const std::string& value) {
    target = parse_whole(name, value, limits.lo, limits.hi);
  };
  describe(add_text(*app_, flags, take, help)->default_str(std::to_string(target)), "N", group_);
}

void Arguments::optional_whole(const std::string& flags, std::optional<uint64_t>& target, Limits limits,
                               const std::string& help) {
  const auto take = [&target, limits, name = long_name(flags)](const std::string& value) {
    target = parse_whole(name, value, limits.lo, limits.hi);
  };
  describe(add_text(*app_, flags, take, help), "N", group_);
}

void Arguments::real(const std::string& flags, const std::string& value_name, std::optional<float>& target,
                     std::pair<float, float> between, const std::string& help) {
  const auto take = [&target, between, name = long_name(flags)](const std::string& value) {
    target = parse_real_between(name, value, between.first, between.second);
  };
  describe(add_text(*app_, flags, take, help), value_name, group_);
}

void Arguments::vector(const std::string& flags, std::optional<Vec3>& target, const std::string& help) {
  const auto take = [&target, name = long_name(flags)](const std::string& value) {
    target = parse_vector(name, value);
  };
  describe(add_text(*app_, flags, take, help), "X,Y,Z", group_);
}

void Arguments::two_vectors(const std::string& flags, const std::string& value_names,
                            std::optional<std::pair<Vec3, Vec3>>& target, const std::string& help) {
  const auto take = [&target, name = long_name(flags)](const std::vector<std::string>& values) {
    target = {parse_vector(name, values.at(0)), parse_vector(name, values.at(1))};
  };
  CLI::Option* option = app_->add_option_function<std::vector<std::string>>(flags, take, help);
  describe(option->type_size(2)->expected(1)->allow_extra_args(false), value_names, group_);
}

void Arguments::footer(const std::string& text) {
  app_->footer(text);
}

Arguments Arguments::command(const std::string& name, const std::string& help) {
  app_->require_subcommand(1);
  return Arguments(*app_->add_subcommand(name, help));
}

void Arguments::action(std::function<void()> on_chosen) {
  app_->callback(std::move(on_chosen));
}

}  // namespace raygrain::cli

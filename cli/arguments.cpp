#include "cli/arguments.h"

#include <filesystem>

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

std::vector<NamedFile> named(const std::string& name, const std::vector<std::string>& paths) {
  std::vector<NamedFile> files;
  files.reserve(paths.size());
  for (const std::string& path : paths) files.push_back({name, path});
  return files;
}

CLI::Option* add_text(CLI::App& app, const std::string& flags, const std::function<void(const std::string&)>& take,
                      const std::string& help) {
  return app.add_option_function<std::string>(flags, take, help);
}

}  // namespace

/// Names and where their values will be once parsing is done.
struct Arguments::Files {
  using Values = std::function<std::vector<NamedFile>()>;
  std::vector<Values> inputs, outputs;

  static std::vector<NamedFile> all(const std::vector<Values>& list) {
    std::vector<NamedFile> files;
    for (const Values& values : list)
      for (NamedFile& file : values()) files.push_back(std::move(file));
    return files;
  }
};

Arguments::Arguments(CLI::App& app) : app_(&app), files_(std::make_shared<Files>()) {}

void Arguments::operand(const std::string& name, std::string& target, const std::string& help) {
  const auto take = [&target, name](const std::string& value) {
    if (value.empty()) fail_usage(name, "is empty", "Give its name, or see --help");
    target = value;
  };
  describe(add_text(*app_, name, take, help)->required(), "", group_);
  files_->inputs.emplace_back([&target, name] { return std::vector<NamedFile>{{name, target}}; });
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
  files_->inputs.emplace_back([&targets, name] { return named(name, targets); });
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

void Arguments::add_file(const std::string& flags, const std::string& value_name, std::string& target,
                         const std::string& help) {
  const auto take = [&target, name = long_name(flags)](const std::string& value) {
    if (value.empty()) fail_usage(name, "is empty", "Give a name after it");
    if (value == "-") fail_usage(name, "needs a file: only --json takes - for standard output", "Give a name after it");
    target = value;
  };
  describe(add_text(*app_, flags, take, help), value_name, group_);
}

void Arguments::file(const std::string& flags, const std::string& value_name, std::string& target,
                     const std::string& help) {
  add_file(flags, value_name, target, help);
  files_->inputs.emplace_back([&target, name = long_name(flags)] { return std::vector<NamedFile>{{name, target}}; });
}

void Arguments::files(const std::string& flags, const std::string& value_name, std::vector<std::string>& targets,
                      const std::string& help) {
  list(flags, value_name, targets, help);
  files_->inputs.emplace_back([&targets, name = long_name(flags)] { return named(name, targets); });
}

void Arguments::output(const std::string& flags, const std::string& value_name, std::string& target,
                       const std::string& help) {
  add_file(flags, value_name, target, help);
  writes(long_name(flags), [&target] { return target; });
}

void Arguments::output_folder(const std::string& flags, const std::string& value_name, std::string& target,
                              std::vector<std::string> names, const std::string& help) {
  add_file(flags, value_name, target, help);
  files_->outputs.emplace_back([&target, names = std::move(names), flag = long_name(flags)] {
    std::vector<std::string> paths;
    for (const std::string& name : names)
      if (!target.empty()) paths.push_back((std::filesystem::path(target) / name).string());
    return named(flag, paths);
  });
}

void Arguments::writes(const std::string& name, std::function<std::string()> path) {
  files_->outputs.emplace_back([path = std::move(path), name] { return std::vector<NamedFile>{{name, path()}}; });
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
    target = parse_whole(name, value, limits);
  };
  describe(add_text(*app_, flags, take, help)->default_str(std::to_string(target)), "N", group_);
}

void Arguments::optional_whole(const std::string& flags, std::optional<uint64_t>& target, Limits limits,
                               const std::string& help) {
  const auto take = [&target, limits, name = long_name(flags)](const std::string& value) {
    target = parse_whole(name, value, limits);
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

void Arguments::vector(const std::string& flags, std::optional<Vec3>& target, const std::string& example,
                       const std::string& help) {
  const auto take = [&target, example, name = long_name(flags)](const std::string& value) {
    target = parse_vector(name, value, example);
  };
  describe(add_text(*app_, flags, take, help), "X,Y,Z", group_);
}

void Arguments::two_vectors(const std::string& flags, const std::string& value_names,
                            std::optional<std::pair<Vec3, Vec3>>& target, const std::string& example,
                            const std::string& help) {
  const auto take = [&target, example, name = long_name(flags)](const std::vector<std::string>& values) {
    target = {parse_vector(name, values.at(0), example), parse_vector(name, values.at(1), example)};
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
  app_->callback([files = files_, on_chosen = std::move(on_chosen)] {
    require_separate(Files::all(files->inputs), Files::all(files->outputs));
    on_chosen();
  });
}

}  // namespace raygrain::cli

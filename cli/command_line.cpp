#include "cli/command_line.h"

#include <algorithm>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "raygrain/report.h"

#include "base/nearest_name.h"
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/output.h"
#include "cli/values.h"

namespace raygrain::cli {
namespace {

struct Command {
  const char* name;
  const char* help;
  Action (*declare)(Arguments&);
};

constexpr Command kCommands[] = {
    {"compare", "Compare trees of several recipes for the same areas and rays: the main job", declare_compare},
    {"study", "Run the paper's evaluation, or a grid of experiments of one's own", declare_study},
    {"build", "Build one tree and write it as a tree file or as JSON", declare_build},
    {"analyze", "Print all metrics of one tree", declare_analyze},
    {"trace", "Find nearest or any hits of given rays, and check them", declare_trace},
    {"explain", "Say what influence areas cost, what they save, and after how many rays they pay", declare_explain},
    {"refit", "Fit a tree file to vertices that moved", declare_refit},
    {"report", "Draw the results of studies as a page of charts", declare_report},
    {"view", "Show scene, areas, trees, rays and costs in a browser", declare_view},
    {"verify", "Compare every structure's answers with brute force on random scenes, bit by bit", declare_verify},
    {"recipes", "List the measures, orientations and builders that recipes are made of", declare_recipes},
};
constexpr Command kSceneCommands[] = {
    {"generate", "Make a procedural scene", declare_generate},
    {"convert", "Write a scene in another format", declare_convert},
    {"info", "Say what a scene holds", declare_info},
};

void add_command(Arguments& parent, const Command& command, Action& chosen) {
  Arguments arguments = parent.command(command.name, command.help);
  arguments.action([&chosen, action = command.declare(arguments)] { chosen = action; });
}

std::string one_line(std::string text) {
  for (char& c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == 0x7f) c = ' ';
  return text;
}

/// What helps in general, where nothing better is known.
std::string default_hint(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return "See raygrain --help";
    case ErrorCode::kNotFound:
      return "Check the name";
    case ErrorCode::kUnreadable:
      return "Check that it is a file that you may read";
    case ErrorCode::kUnwritable:
      return "Choose another place or free some space";
    case ErrorCode::kLimit:
      return "Use a smaller scene or raise the limit";
    default:
      return "Check the file in the program that made it";
  }
}

/// Begins with a capital, but for names like half_width, which are to be found as they are.
std::string sentence(std::string text) {
  const bool name = text.substr(0, text.find(' ')).find('_') != std::string::npos;
  if (!name && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

/// The command that was being read when parsing ended.
const CLI::App* deepest(const CLI::App& program) {
  const CLI::App* app = &program;
  while (!app->get_subcommands().empty()) app = app->get_subcommands().front();
  return app;
}

std::string full_name(const CLI::App& app) {
  const CLI::App* parent = app.get_parent();
  return parent ? full_name(*parent) + " " + app.get_name() : app.get_name();
}

/// Options without their dashes, which would make any two look alike.
std::vector<std::string> known_words(const CLI::App& app, bool options) {
  std::vector<std::string> words;
  if (options)
    for (const CLI::Option* option : app.get_options())
      for (const std::string& name : option->get_lnames()) words.push_back(name);
  else
    for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
      words.push_back(command->get_name());
  return words;
}

/// A word that nothing expects: an option or a command that is not known, or too many operands.
Error unexpected_word(const CLI::App& app, const std::string& word) {
  const bool option = word.starts_with('-');
  const std::vector<std::string> words = known_words(app, option);
  const std::vector<std::string_view> names(words.begin(), words.end());
  const size_t dashes = option ? std::min(word.find_first_not_of('-'), word.size()) : 0;
  const std::string_view near = nearest_name(word.substr(dashes, word.find('=') - dashes), names);
  const std::string hint = near.empty() ? "" : fmt::format("Did you mean {}{}? ", option ? "--" : "", near);
  const char* what = option ? "is no option here" : (words.empty() ? "is one operand too many" : "is no command");
  return Error(ErrorCode::kUsage, word.empty() ? "''" : word, what, hint + "See " + full_name(app) + " --help");
}

Error usage_error(const CLI::App& program, const CLI::ParseError& error) {
  const CLI::App& app = *deepest(program);
  // A word that nothing expects is the likelier mistake than what it leaves missing.
  const CLI::App* level = &app;
  do {
    if (const std::vector<std::string> extras = level->remaining(); !extras.empty())
      return unexpected_word(*level, extras.front());
    level = level->get_parent();
  } while (level != nullptr);
  std::string what = error.what();
  if (what == "A subcommand is required") what = "a command is required";
  return Error(ErrorCode::kUsage, full_name(app), what, "See " + full_name(app) + " --help");
}

std::string version() {
  const Environment environment = current_environment(1);
  return "raygrain " RAYGRAIN_VERSION " (" + environment.commit + ", " + environment.compiler + ")\n";
}

struct Choice {
  bool version = false;
  Action action;
};

void declare(CLI::App& program, Choice& choice) {
  program.add_flag("--version", choice.version, "Print the version and exit");
  program.get_formatter()->column_width(34);
  Arguments top(program);
  for (const Command& command : kCommands) add_command(top, command, choice.action);
  Arguments scene = top.command("scene", "Make, convert and describe scenes");
  for (const Command& command : kSceneCommands) add_command(scene, command, choice.action);
  top.footer(
      "First steps:\n"
      "  raygrain compare 'procedural:city?size=8' --out result\n"
      "  raygrain compare model.obj --sun 0.35,-0.8,0.48 --out result\n"
      "Exit codes: 0 success, 1 bad data or a failed write, 2 bad usage.");
  program.require_subcommand(0, 1);
}

}  // namespace

int run(int argument_count, char** arguments) {
  CLI::App program("Ray-tracing structures specialised to known rays: built, compared, and exact for every ray.",
                   "raygrain");
  Choice choice;
  declare(program, choice);
  try {
    program.parse(argument_count, arguments);
  } catch (const CLI::CallForHelp&) {
    const CLI::App& app = *deepest(program);
    const CLI::App* parent = app.get_parent();
    write_standard_output(app.help(parent ? full_name(*parent) : ""));
    return kSuccess;
  } catch (const CLI::ParseError& error) {
    throw usage_error(program, error);
  }
  if (choice.version) {
    write_standard_output(version());
    return kSuccess;
  }
  if (!choice.action) fail_usage("raygrain", "a command is required", "See raygrain --help");
  return choice.action();
}

std::string error_line(const Error& error) {
  std::string message = error.message;
  while (message.ends_with('.') || message.ends_with(' ')) message.pop_back();
  const std::string hint = sentence(error.hint.empty() ? default_hint(error.code) : error.hint);
  return one_line("raygrain: error: " + error.where + ": " + message + ". " + hint) + "\n";
}

}  // namespace raygrain::cli

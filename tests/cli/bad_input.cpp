#include "cli/bad_input.h"

#include <gtest/gtest.h>

#include "support/shared.h"

namespace raygrain::test {

namespace {

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

}  // namespace

void check(const BadInput& row) {
  SCOPED_TRACE(row.name);
  const TemporaryFolder folder;
  const auto path = [&](const std::string& text) {
    std::string result = replaced(text, "SCENE", folder.file(row.scene_name));
    result = replaced(result, "AREAS", folder.file("areas.json"));
    result = replaced(result, "RAYS", folder.file("rays.csv"));
    return replaced(result, "OUT", folder.file("out"));
  };
  write_file(folder.file(row.scene_name), row.scene);
  write_file(folder.file("areas.json"), row.areas);
  write_file(folder.file("rays.csv"), row.rays);
  const std::vector<std::string> before = names_in(folder.path());
  std::vector<std::string> arguments;
  for (const std::string& argument : row.arguments) arguments.push_back(path(argument));

  const RunResult result = run_program(arguments, row.options);
  EXPECT_EQ(result.exit_code, row.exit_code) << result.errors;
  EXPECT_TRUE(result.errors.starts_with("raygrain: error: ")) << result.errors;
  EXPECT_EQ(result.errors.find('\n'), result.errors.size() - 1) << "one line: " << result.errors;
  // "WHERE: WHAT. HINT", the hint a sentence of its own.
  EXPECT_NE(result.errors.find(": ", 17), std::string::npos) << result.errors;
  const size_t stop = result.errors.rfind(". ");
  ASSERT_NE(stop, std::string::npos) << "no hint: " << result.errors;
  EXPECT_GT(result.errors.size(), stop + 8) << "no hint: " << result.errors;
  const std::string expected =
      row.expected.starts_with("SCENE is") || row.expected.starts_with("SCENE: is") ? row.expected : path(row.expected);
  EXPECT_NE(result.errors.find(expected), std::string::npos) << result.errors << "lacks: " << expected;

  EXPECT_EQ(names_in(folder.path()), before);  // nothing beside the inputs
}

}  // namespace raygrain::test

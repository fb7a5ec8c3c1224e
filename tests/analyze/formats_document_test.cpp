// docs/formats.md lists every metric with its unit and meaning.
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "raygrain/fields.h"

#include "support/shared.h"

namespace raygrain {
namespace {

TEST(FormatsDocument, ListsEveryField) {
  std::ifstream file(test::source_folder() / "docs" / "formats.md");
  const std::string document{std::istreambuf_iterator<char>(file), {}};
  for (const Field& field : fields()) {
    const std::string begin = "\n| `" + std::string(field.name) + "` | " + std::string(field.unit) + " | ";
    const size_t row = document.find(begin);
    ASSERT_NE(row, std::string::npos) << field.name;
    const std::string line = document.substr(row + 1, document.find('\n', row + 1) - row - 1);
    EXPECT_TRUE(line.ends_with("| " + std::string(field.meaning) + " |")) << line;
  }
}

}  // namespace
}  // namespace raygrain

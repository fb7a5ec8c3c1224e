// What is shown for people besides bare values: verdicts, and defaults in the help.
#include "cli/rows.h"

#include <sstream>

#include <gtest/gtest.h>

#include "cli/program.h"

namespace raygrain::test {
namespace {

TEST(RowListing, SaysWhereNoHitRatioIsWorthATree) {
  const auto listed = [](double ratio) {
    ReportRow row;
    row.values[FieldId::kBreakEvenHitRatio] = ratio;
    return cli::row_listing(row);
  };
  EXPECT_NE(listed(1.188).find(" 1.188  never: Hit ratio above"), std::string::npos) << listed(1.188);
  EXPECT_NE(listed(-0.66).find(" -0.660  always: Hit ratio above"), std::string::npos) << listed(-0.66);
  for (const double ratio : {0.0, 0.5, 1.0})
    EXPECT_NE(listed(ratio).find(std::to_string(ratio).substr(0, 5) + "  Hit ratio above"), std::string::npos)
        << listed(ratio);
}

TEST(Help, ShowsEveryDefaultOnce) {
  for (const std::string command : {"compare", "study", "analyze", "trace", "explain", "view", "verify"}) {
    std::istringstream help(run_program({command, "--help"}).output);
    size_t defaults = 0;
    for (std::string line; std::getline(help, line);) {  // options begin lines, as "  --samples N=4096 ..."
      const bool shown = line.find(" N=") != std::string::npos;
      defaults += shown ? 1 : 0;
      EXPECT_TRUE(!shown || line.find(" [") == std::string::npos) << command << ": " << line;
    }
    EXPECT_GT(defaults, 0u) << command;
  }
}

}  // namespace
}  // namespace raygrain::test

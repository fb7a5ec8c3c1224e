#include "raygrain/error.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace raygrain {
namespace {

TEST(Error, SaysWhereWhatAndHowToMend) {
  const Error error(ErrorCode::kMalformed, "a.obj:3:1", "not a number", "write 1.5");
  EXPECT_STREQ(error.what(), "a.obj:3:1: not a number. write 1.5");
  EXPECT_EQ(error.code, ErrorCode::kMalformed);
  EXPECT_STREQ(Error(ErrorCode::kUsage, "", "no scene").what(), "no scene");
}

TEST(Error, EveryCodeHasItsOwnName) {
  std::set<std::string> names;
  for (int code = 0; code <= static_cast<int>(ErrorCode::kCancelled); ++code)
    names.insert(name(static_cast<ErrorCode>(code)));
  EXPECT_EQ(names.size(), static_cast<size_t>(ErrorCode::kCancelled) + 1);
  EXPECT_FALSE(names.contains("unknown"));
}

}  // namespace
}  // namespace raygrain

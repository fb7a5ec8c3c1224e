#include "base/nearest_name.h"

#include <array>

#include <gtest/gtest.h>

namespace raygrain {
namespace {

constexpr std::array<std::string_view, 4> kNames{"LSPH", "SPFH", "ALL", "ROBIN"};

TEST(NearestName, FindsTheUsualSlips) {
  EXPECT_EQ(nearest_name("SPHF", kNames), "SPFH");    // neighbours swapped
  EXPECT_EQ(nearest_name("robin", kNames), "ROBIN");  // another case
  EXPECT_EQ(nearest_name("ROBN", kNames), "ROBIN");   // one letter lost
  EXPECT_EQ(nearest_name("ALLL", kNames), "ALL");     // one too many
}

TEST(NearestName, IsSilentWhenNothingIsNear) {
  EXPECT_EQ(nearest_name("quaternion", kNames), "");
  EXPECT_EQ(nearest_name("", kNames), "");
  EXPECT_EQ(nearest_name(std::string(1000, 'A'), kNames), "");
  EXPECT_EQ(nearest_name("ALL", {}), "");
  constexpr std::array<std::string_view, 2> kOptions{"out", "camera"};
  EXPECT_EQ(nearest_name("bogus", kOptions), "");       // three of five letters
  EXPECT_EQ(nearest_name("ou", kOptions), "out");       // one of three
  EXPECT_EQ(nearest_name("cmra", kOptions), "camera");  // two of six
  EXPECT_EQ(nearest_name("comrad", kOptions), "");      // three of six
}

TEST(NearestName, SuggestsOrLists) {
  EXPECT_EQ(suggestion("AL", kNames), "Did you mean \"ALL\"?");
  EXPECT_EQ(suggestion("quaternion", kNames), "Known: LSPH, SPFH, ALL, ROBIN");
}

}  // namespace
}  // namespace raygrain

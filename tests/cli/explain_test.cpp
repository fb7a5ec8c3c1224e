// What raygrain explain refuses.
#include <gtest/gtest.h>

#include "cli/bad_input.h"

namespace raygrain::test {
namespace {

constexpr int kData = 1, kUsage = 2;

std::vector<BadInput> bad_usage() {
  return {
      {"explain without areas", {"explain", "SCENE"}, kUsage, "--sun"},
      {"explain in unknown space",
       {"explain", "SCENE", "--sun", "0,0,1", "--space", "time"},
       kUsage,
       "none, world, ray"},
      {"explain an unknown density",
       {"explain", "SCENE", "--sun", "0,0,1", "--space", "ray", "--density", "2"},
       kUsage,
       "near-plane, solid-angle"},
      {"explain a density without trees in ray space",
       {"explain", "SCENE", "--sun", "0,0,1", "--density", "solid-angle"},
       kUsage,
       "--space ray"},
      {"explain with unknown ray set", {"explain", "SCENE", "--sun", "0,0,1", "--set", "moon"}, kUsage, "--set"},
      {"explain any hits of no rays", {"explain", "SCENE", "--sun", "0,0,1", "--any"}, kUsage, "--rays"},
      {"explain with two kinds of rays",
       {"explain", "SCENE", "--sun", "0,0,1", "--rays", "SCENE", "--set", "sun"},
       kUsage,
       "combined with --set"},
      {"explain by no rays", {"explain", "SCENE", "--sun", "0,0,1", "--samples", "0"}, kUsage, "--samples"},
      {"explain by too many", {"explain", "SCENE", "--sun", "0,0,1", "--samples", "1000001"}, kUsage, "to 1000000"},
      {"explain a density of a sun's rays",
       {"explain", "SCENE", "--sun", "0,0,1", "--space", "ray", "--density", "solid-angle"},
       kUsage,
       "--density: is about rays through a point"},
      {"explain areas elsewhere",
       {"explain", "SCENE", "--camera", "1000,1000,1000", "2000,2000,2000"},
       kData,
       "no triangle lies in the influence areas. Move"},
  };
}

TEST(ExplainOptions, ThatMeanNothingAreRefused) {
  for (const BadInput& row : bad_usage()) check(row);
}

}  // namespace
}  // namespace raygrain::test

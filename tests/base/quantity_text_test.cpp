#include "base/quantity_text.h"

#include <gtest/gtest.h>

namespace raygrain {
namespace {

TEST(QuantityText, OfBytes) {
  EXPECT_EQ(bytes_text(0), "0 B");
  EXPECT_EQ(bytes_text(1023), "1023 B");
  EXPECT_EQ(bytes_text(40'000), "39.1 KiB");
  EXPECT_EQ(bytes_text(3.25 * 1024 * 1024), "3.2 MiB");
}

TEST(QuantityText, OfRoughCounts) {
  EXPECT_EQ(rough_count_text(0), "0");
  EXPECT_EQ(rough_count_text(1.5), "2");
  EXPECT_EQ(rough_count_text(99), "99");
  EXPECT_EQ(rough_count_text(99.5), "100");
  EXPECT_EQ(rough_count_text(104), "100");
  EXPECT_EQ(rough_count_text(995), "1,000");
  EXPECT_EQ(rough_count_text(303'274), "300,000");
  EXPECT_EQ(rough_count_text(25'400'000), "25,000,000");
  EXPECT_EQ(rough_count_text(1e12), "1,000,000,000,000");
}

}  // namespace
}  // namespace raygrain

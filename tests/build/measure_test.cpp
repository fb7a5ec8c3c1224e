// Measures beside the type, ways to make one, and the order of axes.
#include <limits>

#include "build/build_support.h"

namespace raygrain::test {
namespace {

const Bounds kBox{{1, 2, 3}, {3, 5, 9}};  // edges 2, 3, 6; faces 18, 12, 6

TEST(Measure, DefaultIsAQuarterOfTheSurface) {
  EXPECT_EQ(RayMeasure()(kBox), 18);
  EXPECT_EQ(RayMeasure().total(kBox), 18);
}

TEST(Measure, FaceWeightsAreTheDotProductWithTheFaces) {
  EXPECT_EQ(face_weight_measure({1, 0, 0})(kBox), 18);
  EXPECT_EQ(face_weight_measure({0, 1, 0})(kBox), 12);
  EXPECT_EQ(face_weight_measure({0, 0, 1})(kBox), 6);
  EXPECT_EQ(face_weight_measure({2, 3, 5})(kBox), 102);
  EXPECT_EQ(face_weight_measure()(kBox), 18);
  EXPECT_EQ(face_weight_measure({1, 1, 1}, 7.0f).total(kBox), 7);
}

TEST(Measure, HugeBoxesSaturateAndPointsMeasureNothing) {
  constexpr float kMax = std::numeric_limits<float>::max();
  EXPECT_EQ(RayMeasure()({{-kMax, -kMax, -kMax}, {kMax, kMax, kMax}}), kMax);
  EXPECT_EQ(RayMeasure()({{1, 1, 1}, {1, 1, 1}}), 0);
  EXPECT_EQ(face_weight_measure({0, 0, 1})({{1, 1, 1}, {1, 9, 9}}), 0);
}

TEST(Measure, LambdaAndBatchAnswerForManyBoxes) {
  const RayMeasure one = [](const Bounds& box) { return box.hi.x; };
  const RayMeasure many = RayMeasure::from_batch(
      [](std::span<const Bounds> boxes, std::span<float> out) {
        for (size_t i = 0; i < boxes.size(); ++i) out[i] = boxes[i].hi.x;
      },
      100.0f);
  const std::vector<Bounds> boxes{kBox, {{0, 0, 0}, {7, 1, 1}}};
  for (const RayMeasure& measure : {one, many}) {
    std::vector<float> out(2);
    measure(boxes, out);
    EXPECT_EQ(out, (std::vector<float>{3, 7}));
    EXPECT_EQ(measure(boxes[1]), 7);
  }
  EXPECT_EQ(one.total(kBox), 3);
  EXPECT_EQ(many.total(kBox), 100);
}

TEST(Measure, ConditionalProbabilityIsClamped) {
  EXPECT_EQ(conditional_probability(1, 4), 0.25f);
  EXPECT_EQ(conditional_probability(5, 4), 1);
  EXPECT_EQ(conditional_probability(0, 4), 0);
  EXPECT_EQ(conditional_probability(0, 0), 0);
  EXPECT_EQ(conditional_probability(1, 0), 0);
}

std::vector<int> axes(const AxisOrder& order) {
  std::vector<int> result;
  for (int i = 0; i < order.count; ++i) result.push_back(order.choices[static_cast<size_t>(i)].axis);
  return result;
}

TEST(AxisOrders, AreSortedBestFirstAndStable) {
  EXPECT_EQ(axes(sorted_axes({3, 2, 1})), (std::vector{0, 1, 2}));
  EXPECT_EQ(axes(sorted_axes({3, 1, 2})), (std::vector{0, 2, 1}));
  EXPECT_EQ(axes(sorted_axes({2, 3, 1})), (std::vector{1, 0, 2}));
  EXPECT_EQ(axes(sorted_axes({1, 3, 2})), (std::vector{1, 2, 0}));
  EXPECT_EQ(axes(sorted_axes({2, 1, 3})), (std::vector{2, 0, 1}));
  EXPECT_EQ(axes(sorted_axes({1, 2, 3})), (std::vector{2, 1, 0}));
  EXPECT_EQ(axes(sorted_axes({1, 1, 1})), (std::vector{0, 1, 2}));
  EXPECT_EQ(axes(sorted_axes({1, 2, 2})), (std::vector{1, 2, 0}));
  EXPECT_EQ(axes(sorted_axes({2, 1, 2})), (std::vector{0, 2, 1}));
  EXPECT_EQ(sorted_axes({0.1f, 0.2f, 0.3f}).choices[0].quality, 0.3f);
}

TEST(AxisOrders, AllAxesAreEquallyGood) {
  const AxisOrder order = all_axes_orientation()({});
  EXPECT_EQ(axes(order), (std::vector{0, 1, 2}));
  for (const AxisChoice& choice : order.choices) EXPECT_EQ(choice.quality, 1);
}

}  // namespace
}  // namespace raygrain::test

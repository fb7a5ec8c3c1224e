#include "build/strategy.h"

#include <cmath>
#include <limits>
#include <sstream>

#include "raygrain/error.h"

namespace raygrain::builder {

namespace {

[[noreturn]] void blame(const NodeContext& node, const std::string& message, const std::string& hint) {
  throw Error(ErrorCode::kBadHeuristic, describe(node), message, hint);
}

std::string text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::ostream& operator<<(std::ostream& out, Vec3 v) {
  return out << '(' << v.x << ", " << v.y << ", " << v.z << ')';
}

}  // namespace

std::string describe(const NodeContext& node) {
  std::ostringstream out;
  out << "node at level " << node.level << " with " << node.count << (node.count == 1 ? " primitive" : " primitives")
      << " in box " << node.bounds.lo << " to " << node.bounds.hi;
  return out.str();
}

ActiveStrategy::ActiveStrategy(const BuildStrategy& strategy, const PaperParameters& parameters, const CostModel& costs)
    : strategy_(strategy),
      parameters_(parameters),
      costs_(costs),
      orientation_(strategy.orientation ? strategy.orientation : all_axes_orientation()) {}

void ActiveStrategy::set_total(const NodeContext& root) {
  total_ = strategy_.measure.total(root.bounds);
  if (!(total_ >= 0 && std::isfinite(total_)))
    blame(root, "the measure's total is " + text(total_), "a total must be finite and not negative");
}

void ActiveStrategy::measure(std::span<const Bounds> boxes, std::span<float> out, const NodeContext& node) const {
  strategy_.measure(boxes, out);
  bool good = true;
  constexpr float kMost = std::numeric_limits<float>::max();
  for (const float value : out) good &= (value >= 0 ? value : kInf) <= kMost;  // without jumps
  if (good) return;
  for (const float value : out)
    if (!(value >= 0 && std::isfinite(value)))
      blame(node, "the measure returned " + text(value), "a measure must be finite and not negative");
}

float ActiveStrategy::measure(const Bounds& box, const NodeContext& node) const {
  float result = 0;
  measure({&box, 1}, {&result, 1}, node);
  return result;
}

AxisOrder ActiveStrategy::axes(const NodeContext& node) const {
  AxisOrder order = orientation_(node);
  if (order.count < 1 || order.count > 3)
    blame(node, "the orientation gave " + std::to_string(order.count) + " axes", "give one to three axes");
  for (size_t i = 0; i < static_cast<size_t>(order.count); ++i) {
    const AxisChoice& choice = order.choices[i];
    if (choice.axis < 0 || choice.axis > 2)
      blame(node, "the orientation gave axis " + std::to_string(choice.axis), "axes are 0, 1 and 2");
    if (!std::isfinite(choice.quality))
      blame(node, "the orientation gave quality " + text(choice.quality), "qualities lie in [0, 1]");
  }
  return order;
}

double ActiveStrategy::cost(float measure, uint32_t count, const NodeContext& node) const {
  // In double, so that huge measures keep their order.
  if (!strategy_.cost) return static_cast<double>(measure) * count;
  const double cost = static_cast<double>(strategy_.cost(measure, count));
  if (std::isnan(cost)) blame(node, "the node cost is NaN", "a cost must be a number");
  return cost;
}

bool ActiveStrategy::stops(const NodeContext& node, float measure) const {
  StopState state{node, measure, conditional_probability(measure, total_), 0};
  if (total_ > 0)
    state.cost = static_cast<float>(cost(measure, node.count, node) / static_cast<double>(total_) *
                                    static_cast<double>(costs_.triangle));
  return strategy_.stop ? strategy_.stop(state, parameters_) : stop_by_parameters(state, parameters_);
}

SplitVerdict ActiveStrategy::decide(const SplitState& state) const {
  return strategy_.decision ? strategy_.decision(state, parameters_) : decide_split(state, parameters_);
}

std::pair<float, float> ActiveStrategy::hand_down(const SplitOutcome& outcome) const {
  const std::pair<float, float> measures = strategy_.hand_down(outcome);
  for (const float value : {measures.first, measures.second})
    if (!(value >= 0))
      blame(outcome.node, "the children were handed the measure " + text(value), "a measure must not be negative");
  return measures;
}

void ActiveStrategy::planes(const NodeContext& node, const Bounds& keys, int axis, std::vector<float>& out) const {
  strategy_.planes(node, keys, axis, parameters_.bins, out);
  for (size_t i = 0; i < out.size(); ++i)
    if (!std::isfinite(out[i]) || (i > 0 && out[i] < out[i - 1]))
      blame(node, "candidate plane " + std::to_string(i) + " at " + text(out[i]) + " is not finite or not ascending",
            "give candidate planes in ascending order");
}

float ActiveStrategy::checked_key(const Bounds& box, Vec3 centroid, int axis, const NodeContext& node) const {
  const float key = strategy_.partition(box, centroid, axis);
  if (!std::isfinite(key))
    blame(node, "the partition rule returned " + text(key), "a primitive's position must be finite");
  return key;
}

}  // namespace raygrain::builder

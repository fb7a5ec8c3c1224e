#include "accel/routes.h"

#include <algorithm>

namespace raygrain {
namespace {

/// What is not the global tree must be expected to save a tenth.
constexpr double kLeastGain = 0.9;

struct Choice {
  bool covers, searches;
};

/// `many`: what the global tree's costs are multiplied by.
Choice cheapest(const WayCosts& costs, bool can_cover, bool can_search, double many) {
  Choice choice{can_cover && costs.coverage <= kLeastGain * costs.global * many, false};
  const double along = choice.covers ? 0 : 1;  // rays along the area that a tree must answer
  const double local = costs.off_local + along * costs.local, global = costs.off_global + along * costs.global;
  choice.searches = can_search && local <= kLeastGain * global * many;
  if (choice.searches) choice.covers = can_cover && costs.coverage <= costs.local;
  return choice;
}

Route make_route(std::span<const AreaGeometry> areas, std::span<const Coverage> coverages,
                 std::span<const Choice> choices, EyeEnd end) {
  Route route;
  std::vector<Reach> reaches;
  for (const Choice& choice : choices) {
    route.covers.push_back(choice.covers ? 1 : 0);
    route.searches.push_back(choice.searches ? 1 : 0);
    route.searches_some |= choice.searches;
    reaches.push_back(choice.searches ? Reach::kTolerance : choice.covers ? Reach::kAxis : Reach::kNone);
  }
  route.asked = AskedCoverages(coverages, areas, route.covers, end);
  route.foreign = ForeignFilter(areas, reaches);
  return route;
}

}  // namespace

Routes choose_routes(std::span<const AreaGeometry> areas, std::span<const Coverage> coverages, bool has_locals,
                     std::span<const AreaCosts> costs, double many) {
  const auto route = [&](WayCosts AreaCosts::*kind, double share) {
    const EyeEnd end = kind == &AreaCosts::any ? EyeEnd::kTowards : EyeEnd::kFrom;
    std::vector<Choice> choices;
    for (size_t i = 0; i < areas.size(); ++i) {
      const bool can_cover = i < coverages.size() && coverages[i].is_useful();
      choices.push_back(costs.empty() ? Choice{can_cover, has_locals}
                                      : cheapest(costs[i].*kind, can_cover, has_locals, share));
    }
    return make_route(areas, coverages, choices, end);
  };
  return {route(&AreaCosts::any, 1), route(&AreaCosts::nearest, 1), route(&AreaCosts::any, many),
          route(&AreaCosts::nearest, many)};
}

}  // namespace raygrain

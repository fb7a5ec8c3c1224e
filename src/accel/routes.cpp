#include "accel/routes.h"

#include <algorithm>

namespace raygrain {
namespace {

/// What is not the global tree must be expected to save a tenth.
constexpr double kLeastGain = 0.9;

constexpr size_t kMostOfEye = 254;  // coverages that Coverage::divide takes

struct Choice {
  bool covers, searches, covers_batches;

  bool asks_coverage() const { return covers || covers_batches; }
};

/// Is the local tree expected to cost less than `share` of the global one? `along`: rays along the area, too.
bool local_pays(const WayCosts& costs, bool along, double share) {
  along = along && costs.has_samples;
  const double local = costs.off_local + (along ? costs.local : 0),
               global = costs.off_global + (along ? costs.global : 0);
  return local <= kLeastGain * global * share;
}

Choice cheapest(const WayCosts& costs, bool can_cover, bool can_search) {
  Choice choice{can_cover && costs.coverage <= kLeastGain * costs.global, false, false};
  choice.searches = can_search && local_pays(costs, !choice.covers, 1);
  if (choice.searches) choice.covers = can_cover && costs.has_samples && costs.coverage <= costs.local;
  return choice;
}

/// Of arrays. Coverage is asked about batches alone: the global tree is as fast about many rays as coverage about one.
/// `share`: what the global tree's costs are multiplied by.
Choice cheapest_of_many(const WayCosts& costs, bool can_cover, bool can_search, double share) {
  Choice choice{false, false, can_cover && kShareOfBatch * costs.coverage <= costs.global * share};
  choice.searches = can_search && local_pays(costs, !choice.covers_batches, share);
  choice.covers = choice.searches && can_cover && costs.has_samples && costs.coverage <= costs.local;
  return choice;
}

/// False where the point has as many already as can be told apart.
bool add(const AreaGeometry& area, const AreaCoverage& coverage, BatchCoverages& batches) {
  if (area.is_plane()) {
    batches.planes.push_back(coverage);
    return true;
  }
  const Vec3 place = std::get<PointArea>(area.area().shape).eye;
  const auto eye = std::ranges::find(batches.eyes, place, &BatchCoverages::Eye::place);
  if (eye == batches.eyes.end()) {
    batches.eyes.push_back({place, {coverage}});
    return true;
  }
  if (eye->coverages.size() >= kMostOfEye) return false;
  eye->coverages.push_back(coverage);
  return true;
}

Route make_route(std::span<const AreaGeometry> areas, std::span<const Coverage> coverages,
                 std::span<const Choice> choices, EyeEnd end) {
  Route route;
  std::vector<Reach> reaches;
  std::vector<uint8_t> are_asked;
  for (Choice choice : choices) {
    const auto area = static_cast<uint32_t>(reaches.size());
    choice.covers_batches = choice.covers_batches && add(areas[area], {coverages[area], area}, route.batches);
    are_asked.push_back(choice.covers ? 1 : 0);
    route.covers.push_back(choice.asks_coverage() ? 1 : 0);
    route.searches.push_back(choice.searches ? 1 : 0);
    route.searches_some |= choice.searches;
    reaches.push_back(choice.searches ? Reach::kTolerance : choice.asks_coverage() ? Reach::kAxis : Reach::kNone);
  }
  route.asked = AskedCoverages(coverages, areas, are_asked, end);
  route.foreign = ForeignFilter(areas, reaches);
  return route;
}

}  // namespace

Routes choose_routes(std::span<const AreaGeometry> areas, std::span<const Coverage> coverages, bool has_locals,
                     std::span<const AreaCosts> costs, ManyShares many) {
  const auto route = [&](WayCosts AreaCosts::*kind, const double* share) {
    const EyeEnd end = kind == &AreaCosts::any ? EyeEnd::kTowards : EyeEnd::kFrom;
    std::vector<Choice> choices;
    for (size_t i = 0; i < areas.size(); ++i) {
      const bool can_cover = i < coverages.size() && coverages[i].is_useful();
      choices.push_back(costs.empty()      ? Choice{can_cover, has_locals, can_cover && share != nullptr}
                        : share != nullptr ? cheapest_of_many(costs[i].*kind, can_cover, has_locals, *share)
                                           : cheapest(costs[i].*kind, can_cover, has_locals));
    }
    return make_route(areas, coverages, choices, end);
  };
  return {route(&AreaCosts::any, nullptr), route(&AreaCosts::nearest, nullptr), route(&AreaCosts::any, &many.any),
          route(&AreaCosts::nearest, &many.nearest)};
}

}  // namespace raygrain

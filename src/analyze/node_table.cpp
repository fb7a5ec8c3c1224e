#include <algorithm>

#include "raygrain/analyze.h"

#include "analyze/node_facts.h"

namespace raygrain {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

std::vector<std::string> column_names() {
  return {"index", "parent",       "level",    "first_child", "triangles",   "lo_x",          "lo_y", "lo_z",
          "hi_x",  "hi_y",         "hi_z",     "measure",     "probability", "cost",          "axis", "quality",
          "ratio", "orientations", "fallback", "forced",      "overlap",     "overlap_culled"};
}

void append_place(std::vector<double>& row, const NodeVisit& visit) {
  const Bvh::Node& node = *visit.node;
  row.push_back(static_cast<double>(visit.index));
  row.push_back(visit.parent == kNoTriangle ? -1.0 : static_cast<double>(visit.parent));
  row.push_back(static_cast<double>(visit.level));
  row.push_back(node.is_leaf() ? -1.0 : static_cast<double>(node.first));
  row.push_back(static_cast<double>(node.count));
  for (const Vec3 end : {node.bounds.lo, node.bounds.hi}) {
    for (int axis = 0; axis < 3; ++axis) row.push_back(static_cast<double>(end[axis]));
  }
}

void append_price(std::vector<double>& row, const Bvh::Node& node, float measure, float total, const CostModel& costs) {
  const double probability = total > 0 ? std::min(static_cast<double>(measure) / static_cast<double>(total), 1.0) : 0.0;
  row.insert(row.end(), {static_cast<double>(measure), probability, probability * node_price(node, costs)});
}

void append_log(std::vector<double>& row, const BuildLog* log, uint32_t index) {
  if (log == nullptr || index >= log->nodes.size()) {
    row.insert(row.end(), 6, kUnknown);
    return;
  }
  const NodeLog& node = log->nodes[index];
  const bool is_inner = node.axis >= 0;
  row.insert(row.end(), {is_inner ? static_cast<double>(node.axis) : kUnknown,
                         is_inner ? static_cast<double>(node.quality) : kUnknown,
                         is_inner ? static_cast<double>(node.ratio) : kUnknown, static_cast<double>(node.orientations),
                         node.fallback ? 1.0 : 0.0, node.forced ? 1.0 : 0.0});
}

void append_overlap(std::vector<double>& row, const Bvh& bvh, const AreaGeometry* area, const NodeVisit& visit) {
  for (const Culling culling : {Culling::kNone, Culling::kWindow}) {
    if (area == nullptr || visit.parent == kNoTriangle) {
      row.push_back(kUnknown);
      continue;
    }
    const uint32_t left = bvh.nodes[visit.parent].first;
    const SiblingOverlap overlap = sibling_overlap(*area, bvh.nodes[left].bounds, bvh.nodes[left + 1].bounds, culling);
    row.push_back(overlap.smaller > 0 ? overlap.common / overlap.smaller : 0);
  }
}

}  // namespace

NodeTable tabulate_nodes(const Bvh& bvh, const RayMeasure& measure, const AreaGeometry* area, const BuildLog* log,
                         const CostModel& costs) {
  NodeTable table{column_names(), std::vector<std::vector<double>>(bvh.nodes.size())};
  if (bvh.nodes.empty()) return table;
  const std::vector<float> measures = node_measures(bvh, measure);
  const float total = measure.total(bvh.nodes[0].bounds);
  visit_nodes(bvh, [&](const NodeVisit& visit) {
    std::vector<double>& row = table.rows[visit.index];
    append_place(row, visit);
    append_price(row, *visit.node, measures[visit.index], total, costs);
    append_log(row, log, visit.index);
    append_overlap(row, bvh, area, visit);
  });
  return table;
}

}  // namespace raygrain

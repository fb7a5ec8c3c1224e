#include "raygrain/analyze.h"

namespace raygrain {

void visit_nodes(const Bvh& bvh, const std::function<void(const NodeVisit&)>& per_node,
                 const std::function<void()>& at_end) {
  std::vector<NodeVisit> stack;
  if (!bvh.nodes.empty()) stack.push_back({});
  while (!stack.empty()) {
    NodeVisit visit = stack.back();
    stack.pop_back();
    const Bvh::Node& node = bvh.nodes[visit.index];
    visit.node = &node;
    per_node(visit);
    if (node.is_leaf()) continue;
    stack.push_back({node.first + 1, visit.index, visit.level + 1, nullptr});
    stack.push_back({node.first, visit.index, visit.level + 1, nullptr});  // on top: left before right
  }
  if (at_end) at_end();
}

void visit_nodes(const TopLevel& top_level, const std::function<void(const TopLevel::Node&, uint32_t level)>& per_node,
                 const std::function<void()>& at_end) {
  struct Entry {
    uint32_t node, level;
  };
  std::vector<Entry> stack;
  if (!top_level.nodes().empty()) stack.push_back({0, 0});
  while (!stack.empty()) {
    const Entry entry = stack.back();
    stack.pop_back();
    const TopLevel::Node& node = top_level.nodes()[entry.node];
    per_node(node, entry.level);
    if (node.first_child == 0) continue;
    for (uint32_t child = 8; child-- > 0;) stack.push_back({node.first_child + child, entry.level + 1});
  }
  if (at_end) at_end();
}

}  // namespace raygrain

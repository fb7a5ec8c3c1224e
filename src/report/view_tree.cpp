#include "report/view_tree.h"

namespace raygrain {

namespace {

/// Is every box the union of what lies below it? Then a reader can compute them all.
bool has_plain_boxes(const Bvh& bvh, std::span<const Bounds> triangles) {
  if (bvh.split_references) return false;
  for (const Bvh::Node& node : bvh.nodes) {
    Bounds box;
    if (node.is_leaf())
      for (uint32_t i = node.first; i < node.first + node.count; ++i) box.extend(triangles[bvh.prims[i]]);
    else
      box = united(bvh.nodes[node.first].bounds, bvh.nodes[node.first + 1].bounds);
    if (box != node.bounds) return false;
  }
  return true;
}

void pack_boxes(ViewBlob& blob, const Bvh& bvh) {
  std::vector<float> boxes;
  boxes.reserve(6 * bvh.nodes.size());
  for (const Bvh::Node& node : bvh.nodes)
    for (const Vec3 end : {node.bounds.lo, node.bounds.hi}) boxes.insert(boxes.end(), {end.x, end.y, end.z});
  blob.add_floats("boxes", boxes);
}

void pack_links(ViewBlob& blob, const Bvh& bvh) {
  std::vector<uint32_t> counts, children, starts;
  for (const Bvh::Node& node : bvh.nodes) {
    counts.push_back(node.count);
    (node.is_leaf() ? starts : children).push_back(node.first);
  }
  blob.add_whole("count", counts);
  blob.add_whole("children", children);
  blob.add_whole("starts", starts);
  blob.add_whole("prims", bvh.prims);
}

void pack_measures(ViewBlob& blob, const Bvh& bvh, const RayMeasure& measure) {
  std::vector<Bounds> boxes;
  for (const Bvh::Node& node : bvh.nodes) boxes.push_back(node.bounds);
  std::vector<float> measures(boxes.size());
  measure(boxes, measures);
  blob.add_rounded_floats("measure", measures);
}

void pack_log(ViewBlob& blob, const Bvh& bvh, const BuildLog& log) {
  if (log.nodes.size() != bvh.nodes.size()) return;
  std::vector<uint8_t> axes;
  std::vector<float> qualities;
  for (size_t i = 0; i < bvh.nodes.size(); ++i) {
    const NodeLog& node = log.nodes[i];
    const int axis = node.axis < 0 ? 3 : node.axis;
    axes.push_back(static_cast<uint8_t>(axis | (node.fallback ? 4 : 0) | (node.forced ? 8 : 0)));
    if (!bvh.nodes[i].is_leaf()) qualities.push_back(node.quality);
  }
  blob.add_bytes("axis", axes);
  blob.add_shares("quality", qualities);
}

}  // namespace

ViewBlob pack_tree(const ViewTree& tree, std::span<const Bounds> triangles) {
  ViewBlob blob;
  pack_links(blob, *tree.tree);
  pack_measures(blob, *tree.tree, tree.measure);
  pack_log(blob, *tree.tree, tree.log);
  if (!has_plain_boxes(*tree.tree, triangles)) pack_boxes(blob, *tree.tree);
  return blob;
}

}  // namespace raygrain

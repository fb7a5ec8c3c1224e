#include <ostream>

#include "raygrain/io.h"

#include "io/text.h"

namespace raygrain {

namespace {

/// JSON has no infinity and no NaN: null stands for them.
void append_json_float(std::string& text, float value) {
  if (value - value == 0)
    append_float(text, value);
  else
    text += "null";
}

void append_node(std::string& text, const Bvh::Node& node) {
  text += '[';
  for (const Vec3 corner : {node.bounds.lo, node.bounds.hi})
    for (int axis = 0; axis < 3; ++axis) {
      append_json_float(text, corner[axis]);
      text += ',';
    }
  text += std::to_string(node.first) + ',' + std::to_string(node.count) + ']';
}

}  // namespace

void save_tree_json(const Bvh& bvh, const std::string& info_json, const std::string& path) {
  write_file_atomically(path, [&](std::ostream& stream) {
    stream << "{\"format\": \"raygrain-tree\", \"version\": 1,\n\"info\": " << (info_json.empty() ? "{}" : info_json)
           << ",\n\"node_fields\": [\"lo_x\", \"lo_y\", \"lo_z\", \"hi_x\", \"hi_y\", \"hi_z\", \"first\", \"count\"]"
           << ",\n\"nodes\": [";
    std::string text;
    for (size_t i = 0; i < bvh.nodes.size(); ++i) {
      text = i == 0 ? "\n" : ",\n";
      append_node(text, bvh.nodes[i]);
      stream << text;
    }
    stream << "],\n\"prims\": [";
    for (size_t i = 0; i < bvh.prims.size(); ++i) stream << (i == 0 ? "" : ",") << bvh.prims[i];
    stream << "]" << (bvh.split_references ? ",\n\"split_references\": true" : "") << "}\n";
  });
}

}  // namespace raygrain

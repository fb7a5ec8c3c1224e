// raygrain recipes: what trees can be made by.
#include <algorithm>
#include <memory>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "raygrain/registry.h"

#include "cli/commands.h"
#include "cli/output.h"

namespace raygrain::cli {

namespace {

using Json = nlohmann::ordered_json;

template <class Entry>
std::string section(const std::string& title, const std::vector<Entry>& entries) {
  std::string text = title + "\n";
  for (const Entry& entry : entries) text += fmt::format("  {:<14} {}\n", entry.name, entry.description);
  return text;
}

template <class Entry>
Json described(const std::vector<Entry>& entries) {
  Json list = Json::array();
  for (const Entry& entry : entries) list.push_back({{"name", entry.name}, {"description", entry.description}});
  return list;
}

int list_recipes(const CommonOptions& common) {
  const Registry registry = default_registry();
  const Output output(common);
  output.save_json(Json{{"measures", described(registry.measures)},
                        {"orientations", described(registry.orientations)},
                        {"builders", described(registry.builders)}}
                       .dump(2) +
                   "\n");
  output.print("A recipe is MEASURE+ORIENTATION or MEASURE+ORIENTATION@BUILDER, e.g. PAH+SPFH or SAH+ALL@binned.\n\n" +
               section("Measures: how likely a ray meets a box", registry.measures) + "\n" +
               section("Orientations: which axes to split across", registry.orientations) + "\n" +
               section("Builders (without one: paper)", registry.builders));
  return kSuccess;
}

}  // namespace

Action declare_recipes(Arguments& arguments) {
  const auto common = std::make_shared<CommonOptions>();
  add_common(arguments, *common);
  return [common] { return list_recipes(*common); };
}

}  // namespace raygrain::cli

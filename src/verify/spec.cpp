#include "verify/spec.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <sstream>

#include "raygrain/error.h"
#include "raygrain/ray_frame.h"

#include "base/random.h"

namespace raygrain::verification {
namespace {

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::kUsage, "structure", what, "Take a name that raygrain verify printed");
}

/// Every field but `kind`, with its name.
template <class Spec, class Visit>
void visit_fields(Spec& s, const Visit& visit) {
  visit("tree", s.tree), visit("local", s.local), visit("for_wide", s.for_wide), visit("reinserted", s.reinserted);
  visit("refitted", s.refitted), visit("from_file", s.from_file), visit("area", s.area), visit("leaf", s.leaf);
  visit("isa", s.isa), visit("frame", s.frame), visit("of_area", s.of_area), visit("spatial", s.spatial);
  visit("areas", s.areas), visit("octree", s.octree), visit("ray_space", s.ray_space), visit("covered", s.covered);
  visit("traversal", s.traversal), visit("cells", s.cells), visit("tile", s.tile), visit("order", s.order);
  visit("batch", s.batch), visit("threads", s.threads), visit("counted", s.counted), visit("unpruned", s.unpruned);
  visit("seed", s.seed), visit("by_own_measure", s.by_own_measure), visit("local_trees", s.local_trees);
  visit("reinserted_local", s.reinserted_local), visit("wide_measure", s.wide_measure);
  visit("area_frame", s.area_frame), visit("quality", s.quality), visit("solid_angle", s.solid_angle);
}

std::string text_of(const std::string& value) {
  return value;
}
template <class Number>
std::string text_of(Number value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

void read(std::string& value, const std::string& text) {
  value = text;
}
void read(bool& value, const std::string& text) {
  if (text != "0" && text != "1") fail("\"" + text + "\" is neither 0 nor 1");
  value = text == "1";
}
template <class Number>
void read(Number& value, const std::string& text) {
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, value);
  if (error != std::errc{} || rest != end) fail("\"" + text + "\" is no number that fits");
}

template <class Item, size_t n>
Item any_of(Random& random, const std::array<Item, n>& items) {
  return items[random.below(n)];
}

bool one_in(Random& random, uint64_t n) {
  return random.below(n) == 0;
}

/// One name after the other: within an expression each compiler would draw in its own order.
std::string random_recipe(Random& random, const Registry& registry) {
  const std::string builder = registry.builders[random.below(registry.builders.size())].name;
  const std::string orientation = registry.orientations[random.below(registry.orientations.size())].name;
  const std::string measure = registry.measures[random.below(registry.measures.size())].name;
  return measure + "+" + orientation + "@" + builder;
}

/// A global tree knows no area.
std::string random_global_recipe(Random& random, const Registry& registry) {
  while (true) {
    std::string name = random_recipe(random, registry);
    const Recipe recipe = parse_recipe(name, registry);
    if (!needs_area(recipe, registry) && !needs_samples(recipe, registry)) return name;
  }
}

void draw_calls(StructureSpec& spec, Random& random) {
  if (random.below(4)) spec.batch = any_of(random, std::array<uint32_t, 7>{1, 2, 7, 16, 17, 100, 5000});
  if (spec.batch > 1000 && one_in(random, 2)) spec.threads = any_of(random, std::array<uint32_t, 3>{0, 2, 3});
  spec.counted = one_in(random, 5);
  if (spec.kind != "accelerator") spec.unpruned = one_in(random, 12);
}

void draw_coverage(StructureSpec& spec, Random& random) {
  spec.cells = any_of(random, std::array<float, 3>{0.25f, 4, 64});
  spec.tile = any_of(random, std::array<uint32_t, 3>{256, 16, 4});
  spec.order = name(kCoverageOrders[random.below(std::size(kCoverageOrders))]);
}

void draw_tree(StructureSpec& spec, Random& random, const Registry& registry) {
  spec.tree = random_recipe(random, registry);
  spec.for_wide = one_in(random, 4) && parse_recipe(spec.tree, registry).builder != "paper";
  spec.reinserted = one_in(random, 5);
  spec.refitted = one_in(random, 6) && parse_recipe(spec.tree, registry).builder != "spatial";
  spec.from_file = one_in(random, 40);
}

void draw_accelerator(StructureSpec& spec, Random& random, const Registry& registry) {
  spec.tree = random_global_recipe(random, registry);
  spec.local = random_recipe(random, registry);
  spec.reinserted = one_in(random, 5);
  spec.areas = !one_in(random, 6);
  spec.octree = one_in(random, 2);
  if (one_in(random, 5)) spec.traversal = "binary";
  spec.ray_space = one_in(random, 2) && spec.traversal == "wide";
  spec.covered = random.below(3) != 0;
  draw_coverage(spec, random);
}

std::string random_frame(Random& random) {
  return name(kFrameKinds[random.below(std::size(kFrameKinds))]);
}

void draw_frame(StructureSpec& spec, Random& random) {
  spec.frame = random_frame(random);
  spec.of_area = one_in(random, 2) || spec.frame == name(FrameKind::kProjective);
  spec.spatial = one_in(random, 2);
}

std::string random_wide_measure(Random& random, const Registry& registry) {
  if (one_in(random, 2)) return "VISIBLE";
  return registry.measures[random.below(registry.measures.size())].name;
}

void draw_local_trees(StructureSpec& spec, Random& random, const Registry& registry) {
  if (one_in(random, 4)) {
    spec.local_trees = spec.ray_space = false;
    spec.local = StructureSpec().local;
    return;
  }
  spec.reinserted_local = one_in(random, 4);
  if (spec.traversal == "wide" && one_in(random, 3)) spec.wide_measure = random_wide_measure(random, registry);
  if (spec.ray_space && one_in(random, 2)) spec.area_frame = random_frame(random);
}

/// Now and then in place of a recipe's measure.
void draw_solid(std::string& recipe, Random& random) {
  if (one_in(random, 7)) recipe = "SOLID" + recipe.substr(recipe.find('+'));
}

void draw_solid_angles(StructureSpec& spec, Random& random) {
  const bool is_tree = spec.kind == "binary" || spec.kind == "wide", has_local = spec.areas && spec.local_trees;
  if (is_tree) draw_solid(spec.tree, random);
  if (spec.kind == "accelerator" && has_local) draw_solid(spec.local, random);
  if (!spec.wide_measure.empty() && one_in(random, 14)) spec.wide_measure = "SOLID";
  const bool is_projective = spec.kind == "frame" && spec.frame == name(FrameKind::kProjective);
  if (is_projective || (spec.kind == "accelerator" && has_local && spec.ray_space))
    spec.solid_angle = one_in(random, 2);
}

/// After all others: whatever is drawn before stays what it is for a seed.
void draw_uses(StructureSpec& spec, Random& random, const Registry& registry) {
  if (spec.kind == "binary" || spec.kind == "wide") spec.by_own_measure = spec.reinserted && !one_in(random, 4);
  if (spec.kind == "wide" && one_in(random, 3)) spec.wide_measure = random_wide_measure(random, registry);
  if (spec.kind == "accelerator") {
    if (one_in(random, 4)) spec.quality = any_of(random, std::array{"fast", "balanced", "best"});
    if (spec.areas) draw_local_trees(spec, random, registry);
  }
  draw_solid_angles(spec, random);
}

/// A seed draws among the measures that were there first; newer ones take their place in the end.
Registry drawn_registry() {
  Registry registry = verify_registry(1);
  std::erase_if(registry.measures, [](const MeasureEntry& measure) { return measure.name == "SOLID"; });
  return registry;
}

}  // namespace

StructureSpec random_spec(Random& random) {
  const Registry registry = drawn_registry();
  const std::vector<Isa> isas = supported_isas();
  StructureSpec spec;
  const uint64_t kind = random.below(20);
  spec.kind = kind < 2 ? "binary" : kind < 8 ? "wide" : kind < 11 ? "frame" : kind < 14 ? "coverage" : "accelerator";
  spec.seed = random.below(1'000'000);
  spec.area = static_cast<uint32_t>(random.below(16));
  if (spec.kind != "binary") spec.isa = name(isas[random.below(isas.size())]);
  if (spec.kind == "binary" || spec.kind == "wide") draw_tree(spec, random, registry);
  if (spec.kind == "wide" && random.below(2)) spec.leaf = 1 + static_cast<uint32_t>(random.below(8));
  if (spec.kind == "frame") draw_frame(spec, random);
  if (spec.kind == "coverage") draw_coverage(spec, random);
  if (spec.kind == "accelerator") draw_accelerator(spec, random, registry);
  draw_calls(spec, random);
  draw_uses(spec, random, registry);
  return spec;
}

std::string to_text(const StructureSpec& spec) {
  std::string text = spec.kind;
  StructureSpec usual;
  std::vector<std::string> defaults;
  visit_fields(usual, [&](const char*, const auto& value) { defaults.push_back(text_of(value)); });
  size_t i = 0;
  visit_fields(spec, [&](const char* name, const auto& value) {
    const std::string written = text_of(value);
    if (written != defaults[i++]) text += std::string(" ") + name + "=" + written;
  });
  return text;
}

StructureSpec parse_spec(const std::string& text) {
  std::istringstream words(text);
  StructureSpec spec;
  spec.kind.clear();
  words >> spec.kind;
  for (std::string word; words >> word;) {
    const size_t equal = word.find('=');
    bool is_known = false;
    visit_fields(spec, [&](const std::string& name, auto& value) {
      if (equal == std::string::npos || word.substr(0, equal) != name) return;
      read(value, word.substr(equal + 1));
      is_known = true;
    });
    if (!is_known) fail("\"" + word + "\" says nothing about a structure");
  }
  return spec;
}

Isa parse_isa(const std::string& text) {
  for (const Isa isa : {Isa::kScalar, Isa::kSse4, Isa::kAvx2, Isa::kAvx512, Isa::kNeon})
    if (text == name(isa)) return isa;
  fail("unknown instruction set \"" + text + "\"");
}

FrameKind parse_frame(const std::string& text) {
  for (const FrameKind kind : kFrameKinds)
    if (text == name(kind)) return kind;
  fail("unknown frame \"" + text + "\"");
}

CoverageOrder parse_order(const std::string& text) {
  for (const CoverageOrder order : kCoverageOrders)
    if (text == name(order)) return order;
  fail("unknown order \"" + text + "\"");
}

Registry verify_registry(uint64_t seed) {
  Registry registry = default_registry();
  registry.measures.push_back(
      {"RANDOM", "a number that a seed draws for each box", false, false, [seed](const HeuristicInput&) {
         return RayMeasure([seed](const Bounds& box) {
           uint64_t bits = seed;
           for (const Vec3 p : {box.lo, box.hi})
             for (int k = 0; k < 3; ++k) bits = Random(bits ^ std::bit_cast<uint32_t>(p[k])).next();
           return static_cast<float>(Random(bits).uniform());
         });
       }});
  return registry;
}

}  // namespace raygrain::verification

namespace raygrain {

namespace {

RayStructure structure_of(const verification::StructureSpec& spec) {
  using namespace verification;
  constexpr std::array<std::pair<const char*, AnswerRays (*)(const StructureSpec&, const VerifyScene&)>, 6> kKinds{
      {{"binary", make_binary},
       {"wide", make_wide},
       {"frame", make_frame},
       {"coverage", make_coverage},
       {"accelerator", make_accelerator},
       {"exact", make_exact}}};
  for (const auto& [kind, make] : kKinds)
    if (spec.kind == kind)
      return {to_text(spec), [spec, make = make](const VerifyScene& scene) {
                const std::vector<Isa> isas = supported_isas();
                return std::ranges::count(isas, parse_isa(spec.isa)) ? make(spec, scene) : AnswerRays{};
              }};
  throw Error(ErrorCode::kUsage, "structure", "unknown kind \"" + spec.kind + "\"",
              "Known: binary, wide, frame, coverage, accelerator, exact");
}

}  // namespace

RayStructure random_structure(uint64_t seed) {
  Random random(seed);
  return structure_of(verification::random_spec(random));
}

RayStructure parse_structure(const std::string& name) {
  return structure_of(verification::parse_spec(name));
}

}  // namespace raygrain

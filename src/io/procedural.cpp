#include "io/procedural.h"

#include <array>
#include <charconv>
#include <limits>
#include <string_view>

#include "raygrain/error.h"
#include "raygrain/scene.h"

#include "base/nearest_name.h"

namespace raygrain {
namespace {

constexpr std::string_view kPrefix = "procedural:";
constexpr Vec3 kSunDirection{0.35f, -0.8f, 0.48f};
constexpr uint64_t kAnySeed = std::numeric_limits<uint64_t>::max();

struct Kind {
  std::string_view name;
  uint32_t default_size, greatest_size;  // 0: has no size
  uint64_t greatest_seed;
  TriangleMesh (*make)(uint32_t size, uint64_t seed);
};

// The greatest sizes give about ten million triangles, of terrain a hundred.
constexpr std::array<Kind, 5> kKinds{{
    {"city", 8, 150, kAnySeed, make_city},
    {"forest", 8, 150, kAnySeed, make_forest},
    {"terrain", 100, 7000, kAnySeed, make_terrain},
    {"random100", 0, 0, 0xffffffffu,
     [](uint32_t, uint64_t seed) { return make_random_100(static_cast<uint32_t>(seed)); }},
    {"random1000", 0, 0, 0xffffffffu,
     [](uint32_t, uint64_t seed) { return make_random_1000(static_cast<uint32_t>(seed)); }},
}};

const Kind& find_kind(const std::string& name) {
  std::array<std::string_view, kKinds.size()> names;
  for (size_t i = 0; i < kKinds.size(); ++i) {
    if (kKinds[i].name == name) return kKinds[i];
    names[i] = kKinds[i].name;
  }
  throw Error(ErrorCode::kUsage, std::string(kPrefix) + name, "unknown procedural scene", suggestion(name, names));
}

void check_range(const ProceduralOptions& options, const Kind& kind) {
  const std::string where(kPrefix);
  if (kind.greatest_size > 0 && options.size > kind.greatest_size)
    throw Error(ErrorCode::kUsage, where + options.kind, "size " + std::to_string(options.size) + " is too large",
                "Choose 1 to " + std::to_string(kind.greatest_size));
  if (options.seed > kind.greatest_seed)
    throw Error(ErrorCode::kUsage, where + options.kind, "seed " + std::to_string(options.seed) + " is too large",
                "Choose 0 to " + std::to_string(kind.greatest_seed));
}

std::string canonical_name(const ProceduralOptions& options, const Kind& kind, uint32_t size) {
  std::string name = std::string(kPrefix) + options.kind;
  if (kind.greatest_size > 0)
    name += "?size=" + std::to_string(size) + "&seed=" + std::to_string(options.seed);
  else if (options.seed != 1)
    name += "?seed=" + std::to_string(options.seed);
  return name;
}

template <class Integer>
Integer parse_integer(const std::string& where, std::string_view key, std::string_view digits) {
  Integer value = 0;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (digits.empty() || error != std::errc() || end != digits.data() + digits.size())
    throw Error(ErrorCode::kUsage, where,
                std::string(key) + " is not a whole number in range: \"" + std::string(digits) + '"',
                "Write for example " + std::string(key) + "=10");
  return value;
}

/// What was given so far.
struct Given {
  bool size = false, seed = false;
};

void give_once(const std::string& where, std::string_view key, bool& given) {
  if (given) throw Error(ErrorCode::kUsage, where, std::string(key) + " is there twice", "Leave one of them out");
  given = true;
}

void parse_parameter(const std::string& where, std::string_view parameter, Given& given, ProceduralOptions& options) {
  constexpr std::array<std::string_view, 2> kKeys{"size", "seed"};
  const size_t equals = parameter.find('=');
  const std::string_view key = parameter.substr(0, equals);
  const std::string_view value = equals == std::string_view::npos ? std::string_view{} : parameter.substr(equals + 1);
  if (key == "size") {
    give_once(where, key, given.size);
    options.size = parse_integer<uint32_t>(where, key, value);
    if (options.size == 0) throw Error(ErrorCode::kUsage, where, "size is 0", "Leave it out for the default");
  } else if (key == "seed") {
    give_once(where, key, given.seed);
    options.seed = parse_integer<uint64_t>(where, key, value);
  } else {
    throw Error(ErrorCode::kUsage, where, "unknown parameter \"" + std::string(key) + '"', suggestion(key, kKeys));
  }
}

}  // namespace

Scene generate_scene(const ProceduralOptions& options) {
  const Kind& kind = find_kind(options.kind);
  check_range(options, kind);
  const uint32_t size = options.size == 0 ? kind.default_size : options.size;
  Scene scene;
  scene.name = canonical_name(options, kind, size);
  scene.mesh = kind.make(size, options.seed);
  const InfluenceArea sun = directional_light_area("sun", kSunDirection, mesh_bounds(scene.mesh));
  scene.areas.push_back(sun);
  scene.ray_sets.push_back({"sun", AreaRays{sun}, 10000, 1});
  return scene;
}

ProceduralOptions parse_procedural(const std::string& text) {
  const std::string_view whole(text);
  if (!whole.starts_with(kPrefix))
    throw Error(ErrorCode::kUsage, text, "not a procedural scene", "Write procedural:KIND?size=N&seed=S");
  const size_t question = whole.find('?');
  const std::string_view kind_name = whole.substr(0, question).substr(kPrefix.size());
  ProceduralOptions options;
  options.kind = kind_name;
  const Kind& kind = find_kind(options.kind);
  std::string_view rest = question == std::string_view::npos ? std::string_view{} : whole.substr(question + 1);
  Given given;
  while (!rest.empty()) {
    const size_t ampersand = rest.find('&');
    parse_parameter(text, rest.substr(0, ampersand), given, options);
    rest = ampersand == std::string_view::npos ? std::string_view{} : rest.substr(ampersand + 1);
  }
  check_range(options, kind);
  return options;
}

}  // namespace raygrain

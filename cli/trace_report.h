// What raygrain trace says about its rays.
#pragma once

#include <optional>
#include <string>

#include "raygrain/scene.h"

#include "cli/asked_rays.h"

namespace raygrain::cli {

struct Traced {
  size_t rays = 0;
  RayAnswers answers;
  std::optional<CheckedAnswers> checked;  // where that was asked for
};

std::string trace_json(const Traced& traced, const Scene& scene, unsigned threads);
std::string trace_text(const Traced& traced, const Scene& scene, size_t areas);
/// A line where trees of this kind ("ray", "world") were asked for and coverage left no ray for them; else empty.
std::string unused_trees_note(const Traced& traced, const std::string& space);

}  // namespace raygrain::cli

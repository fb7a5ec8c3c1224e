// Handing rays over: one at a time, or in batches.
#pragma once

#include <algorithm>
#include <span>

#include "verify/spec.h"

namespace raygrain::verification {

/// one(ray) answers a ray, many(rays, answers) an array.
template <class Answer, class One, class Many>
void ask(const StructureSpec& spec, std::span<const Ray> rays, std::span<Answer> answers, const One& one,
         const Many& many) {
  if (spec.batch == 0) {
    for (size_t i = 0; i < rays.size(); ++i) answers[i] = one(rays[i]);
    return;
  }
  for (size_t begin = 0; begin < rays.size(); begin += spec.batch) {
    const size_t count = std::min<size_t>(spec.batch, rays.size() - begin);
    many(rays.subspan(begin, count), answers.subspan(begin, count));
  }
}

inline void tell(const RayAnswers& answers, uint8_t what) {
  for (uint8_t& told : answers.told) told |= what;
}

}  // namespace raygrain::verification

// Closed meshes have no gaps.
#pragma once

#include <optional>
#include <string>

#include "raygrain/verify.h"

#include "verify/oracle.h"

namespace raygrain::verification {

/// An odd number of crossings of a closed mesh by a line that touches no edge would be a leak. Nothing: the line
/// touches an edge and says nothing.
std::optional<bool> crosses_evenly(const Oracle& oracle, const Ray& line);

/// The distances of a line's hits, as a structure finds them one after the other: each search begins one float behind
/// the last hit. All of the line, both ways.
std::vector<Hit> hits_in_order(const AnswerRays& structure, const Ray& line);

}  // namespace raygrain::verification

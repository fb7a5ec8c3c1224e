// What a command will need, told before it takes hours or the whole machine.
#pragma once

#include <span>
#include <string>

#include "raygrain/accelerator.h"

namespace raygrain::cli {

/// Throws Error (kLimit) with both figures where `bytes` are more than there are left.
void require_memory(const std::string& what, double bytes, const std::string& hint);

/// About the most that is held at once, besides the mesh: measured bytes a triangle, rounded up. Areas count with their
/// share of the triangles, which a sample of them tells.
double bytes_of_tree(const TriangleMesh& mesh, const InfluenceArea* area, const Recipe& recipe);
double bytes_of_accelerator(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                            const AcceleratorOptions& options);
double bytes_of_comparison(const TriangleMesh& mesh, std::span<const InfluenceArea> areas,
                           std::span<const Recipe> recipes);

}  // namespace raygrain::cli

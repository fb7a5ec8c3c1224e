#include <cstdlib>
#include <string>

#include "raygrain/error.h"
#include "raygrain/wide.h"

#include "trace/kernels/kernels.h"

namespace raygrain {

const char* name(Isa isa) {
  switch (isa) {
    case Isa::kScalar:
      return "scalar";
    case Isa::kSse4:
      return "sse4";
    case Isa::kAvx2:
      return "avx2";
    case Isa::kAvx512:
      return "avx512";
    case Isa::kNeon:
      return "neon";
  }
  return "?";
}

std::vector<Isa> supported_isas() {
  std::vector<Isa> isas;
  for (const Isa isa : {Isa::kScalar, Isa::kNeon, Isa::kSse4, Isa::kAvx2, Isa::kAvx512})
    if (kernels(isa) != nullptr) isas.push_back(isa);
  return isas;
}

Isa default_isa() {
  const std::vector<Isa> isas = supported_isas();
  const char* wish = std::getenv("RAYGRAIN_ISA");
  if (wish == nullptr || *wish == '\0') return isas.back();
  std::string known;
  for (const Isa isa : isas) {
    if (std::string(wish) == name(isa)) return isa;
    known += (known.empty() ? "" : ", ") + std::string(name(isa));
  }
  throw Error(ErrorCode::kUsage, "RAYGRAIN_ISA", "this CPU does not offer '" + std::string(wish) + "'",
              "it offers " + known);
}

}  // namespace raygrain

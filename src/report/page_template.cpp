#include "report/page_template.h"

#include "raygrain/error.h"

namespace raygrain {

std::string filled_page(const std::string& page, std::string_view place, const std::string& text, const PageKind& kind,
                        const std::string& path) {
  const size_t start = page.find(place);
  if (start == std::string::npos || page.find(place, start + 1) != std::string::npos)
    throw Error(ErrorCode::kMalformed, path, std::string("is no ") + kind.name + " of raygrain",
                std::string("Build it again with make ") + kind.target);
  std::string filled;
  filled.reserve(page.size() + text.size());
  filled.append(page, 0, start).append(text).append(page, start + place.size());
  return filled;
}

std::string script_safe(const std::string& json) {
  std::string safe;
  safe.reserve(json.size());
  for (const char c : json) {
    if (c == '<')
      safe += "\\u003c";
    else
      safe += c;
  }
  return safe;
}

}  // namespace raygrain

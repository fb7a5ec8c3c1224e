// Built pages with places in them for data: what the interactive report and the viewer have in common.
#pragma once

#include <string>
#include <string_view>

namespace raygrain {

/// The page with `text` instead of `place`, which must be there exactly once. Throws Error (kMalformed, `path`): the
/// text "is no KIND of raygrain", and `make TARGET` builds one.
struct PageKind {
  const char* name;
  const char* target;
};
std::string filled_page(const std::string& page, std::string_view place, const std::string& text, const PageKind& kind,
                        const std::string& path);

/// JSON in a script element: no "</script>" and no "<!--" may occur in it.
std::string script_safe(const std::string& json);

}  // namespace raygrain

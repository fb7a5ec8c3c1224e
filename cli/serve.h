// One page on this machine's own network address, for a browser.
#pragma once

#include <cstdint>
#include <functional>
#include <string>

namespace raygrain::cli {

/// Answers GET / with the page, and everything else with 404, until the program is interrupted. Listens on 127.0.0.1
/// alone. `port` 0: any that is free. `ready` is told the address once the page can be had. Throws Error (kUnreadable)
/// where the port cannot be listened on.
[[noreturn]] void serve_page(const std::string& page, uint16_t port,
                             const std::function<void(const std::string& address)>& ready);

}  // namespace raygrain::cli

// Quantities for people.
#pragma once

#include <string>

namespace raygrain {

/// "40 B", "1.5 KiB" or "3.2 MiB".
std::string bytes_text(double bytes);

/// A count that is known roughly: two significant digits, thousands apart, e.g. "300,000". Below 100 as it is, rounded
/// up.
std::string rough_count_text(double count);

}  // namespace raygrain

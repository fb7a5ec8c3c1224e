// The one exception type of the library, thrown at its border only: files, options, user callbacks.
#pragma once

#include <stdexcept>
#include <string>

namespace raygrain {

enum class ErrorCode {
  kUsage,         // a call or command line that cannot be meant: unknown name, option out of range
  kNotFound,      // a file or named thing that is not there
  kUnreadable,    // a file that is there and cannot be read
  kMalformed,     // content that breaks its format
  kUnsupported,   // a format, version or feature that raygrain does not know
  kBadMesh,       // no triangles, index out of range, non-finite vertex
  kBadArea,       // zero size, zero direction, near >= far, field of view out of range
  kBadHeuristic,  // a measure or orientation that returned NaN, a negative value or a wrong axis
  kUnwritable,    // an output that cannot be created or completed
  kLimit,         // more memory, time, depth or indices than are allowed
  kCancelled,     // the caller asked to stop
};

/// The name of a code as it is written in machine-readable output, e.g. "bad_mesh".
const char* name(ErrorCode code);

/// `where` is a file, file:line:column, option or field; `message` says what is wrong; `hint` how to mend it (may be
/// empty). what() is "WHERE: MESSAGE. HINT".
class Error : public std::runtime_error {
 public:
  Error(ErrorCode error_code, std::string where_text, std::string message_text, std::string hint_text = {});

  ErrorCode code;
  std::string where, message, hint;
};

}  // namespace raygrain

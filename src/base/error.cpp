#include "raygrain/error.h"

#include <utility>

namespace raygrain {

namespace {

std::string sentence(const std::string& where, const std::string& message, const std::string& hint) {
  std::string text = where.empty() ? message : where + ": " + message;
  if (!hint.empty()) text += ". " + hint;
  return text;
}

}  // namespace

const char* name(ErrorCode code) {
  switch (code) {
    case ErrorCode::kUsage:
      return "usage";
    case ErrorCode::kNotFound:
      return "not_found";
    case ErrorCode::kUnreadable:
      return "unreadable";
    case ErrorCode::kMalformed:
      return "malformed";
    case ErrorCode::kUnsupported:
      return "unsupported";
    case ErrorCode::kBadMesh:
      return "bad_mesh";
    case ErrorCode::kBadArea:
      return "bad_area";
    case ErrorCode::kBadHeuristic:
      return "bad_heuristic";
    case ErrorCode::kUnwritable:
      return "unwritable";
    case ErrorCode::kLimit:
      return "limit";
    case ErrorCode::kCancelled:
      return "cancelled";
  }
  return "unknown";
}

Error::Error(ErrorCode error_code, std::string where_text, std::string message_text, std::string hint_text)
    : std::runtime_error(sentence(where_text, message_text, hint_text)),
      code(error_code),
      where(std::move(where_text)),
      message(std::move(message_text)),
      hint(std::move(hint_text)) {}

}  // namespace raygrain

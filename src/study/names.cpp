#include "study/names.h"

#include "raygrain/error.h"

namespace raygrain::study {

namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

bool is_plain_name(std::string_view name) {
  return std::none_of(name.begin(), name.end(),
                      [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; });
}

bool is_same_name(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](char x, char y) { return lower(x) == lower(y); });
}

void fail_without_rows(const std::string& study, const std::vector<std::string>& missing) {
  std::string what;
  for (const std::string& line : missing) what += (what.empty() ? "" : ", ") + line.substr(0, line.find(';'));
  throw Error(ErrorCode::kNotFound, study,
              "the scenes asked for are known, but their models are missing (" + what + ")",
              "Name the folder that holds them with --scenes DIR");
}

}  // namespace raygrain::study

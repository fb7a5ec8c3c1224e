#include <algorithm>
#include <array>
#include <ostream>
#include <string_view>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/text.h"

namespace raygrain {

namespace {

constexpr std::array<std::string_view, 8> kRayColumns{"ox", "oy", "oz", "dx", "dy", "dz", "tmin", "tmax"};
constexpr size_t kNeededColumns = 6;
constexpr const char* kHeaderHint = "the header names ox,oy,oz,dx,dy,dz and, if wanted, tmin,tmax, in any order";

struct Line {
  std::string_view text;
  size_t number = 0;
};

/// Steps through the lines that hold something: not blank, not a comment.
class LineReader {
 public:
  explicit LineReader(std::string_view bytes) : rest_(bytes) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }
  bool next(Line& line) {
    while (!rest_.empty()) {
      const size_t end = std::min(rest_.find('\n'), rest_.size());
      line.text = rest_.substr(0, end);
      ++line.number;
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      if (line.text.ends_with('\r')) line.text.remove_suffix(1);
      const std::string_view content = trimmed(line.text);
      if (!content.empty() && content.front() != '#') return true;
    }
    return false;
  }

 private:
  std::string_view rest_;
};

/// Calls use(field, column), column counting bytes from 1, for each comma-separated field.
template <class Use>
void for_each_field(std::string_view line, const Use& use) {
  for (size_t begin = 0;;) {
    const size_t end = std::min(line.find(',', begin), line.size());
    use(trimmed(line.substr(begin, end - begin)), begin + 1);
    if (end == line.size()) return;
    begin = end + 1;
  }
}

/// For each column of the file, which of kRayColumns it is.
std::vector<size_t> parse_header(const Line& line, const std::string& path) {
  std::vector<size_t> columns;
  for_each_field(line.text, [&](std::string_view field, size_t column) {
    const auto known = std::find(kRayColumns.begin(), kRayColumns.end(), field);
    const auto meaning = static_cast<size_t>(known - kRayColumns.begin());
    const std::string where = place(path, line.number, column);
    if (known == kRayColumns.end())
      throw Error(ErrorCode::kMalformed, where, "unknown column " + in_quotes(field), kHeaderHint);
    if (std::find(columns.begin(), columns.end(), meaning) != columns.end())
      throw Error(ErrorCode::kMalformed, where, "column " + in_quotes(field) + " is there twice", kHeaderHint);
    columns.push_back(meaning);
  });
  for (size_t meaning = 0; meaning < kNeededColumns; ++meaning)
    if (std::find(columns.begin(), columns.end(), meaning) == columns.end())
      throw Error(ErrorCode::kMalformed, place(path, line.number),
                  "column \"" + std::string(kRayColumns[meaning]) + "\" is missing", kHeaderHint);
  return columns;
}

Ray parse_ray(const Line& line, const std::vector<size_t>& columns, const std::string& path) {
  std::array<float, kRayColumns.size()> values{0, 0, 0, 0, 0, 0, Ray{}.tmin, Ray{}.tmax};
  size_t count = 0;
  for_each_field(line.text, [&](std::string_view field, size_t column) {
    if (count == columns.size())
      throw Error(ErrorCode::kMalformed, place(path, line.number, column),
                  "more fields than the header's " + std::to_string(columns.size()));
    const std::optional<float> value = parse_float(field);
    if (!value && is_beyond_float(field))
      throw Error(ErrorCode::kMalformed, place(path, line.number, column),
                  in_quotes(field) + " is beyond float32 (3.4e38)",
                  "give a number between -3.4e38 and 3.4e38, or inf for tmin and tmax");
    if (!value)
      throw Error(ErrorCode::kMalformed, place(path, line.number, column),
                  (field.empty() ? "an empty field" : in_quotes(field)) + " is not a number",
                  "numbers look like 1.5, -2e-3, inf or nan");
    values[columns[count++]] = *value;
  });
  if (count < columns.size())
    throw Error(ErrorCode::kMalformed, place(path, line.number, line.text.size() + 1),
                std::to_string(count) + " fields where the header has " + std::to_string(columns.size()));
  return {{values[0], values[1], values[2]}, {values[3], values[4], values[5]}, values[6], values[7]};
}

void write_row(std::ostream& stream, std::string& row) {
  row.back() = '\n';
  stream.write(row.data(), static_cast<std::streamsize>(row.size()));
  row.clear();
}

}  // namespace

std::vector<Ray> load_rays(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  LineReader reader(bytes);
  Line line;
  if (!reader.next(line)) throw Error(ErrorCode::kMalformed, path, "the file is empty", kHeaderHint);
  const std::vector<size_t> columns = parse_header(line, path);
  std::vector<Ray> rays;
  while (reader.next(line)) rays.push_back(parse_ray(line, columns, path));
  return rays;
}

void save_rays(std::span<const Ray> rays, const std::string& path) {
  write_file_atomically(path, [&](std::ostream& stream) {
    stream << "ox,oy,oz,dx,dy,dz,tmin,tmax\n";
    std::string row;
    for (const Ray& ray : rays) {
      for (const float value : {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y,
                                ray.direction.z, ray.tmin, ray.tmax}) {
        append_float(row, value);
        row += ',';
      }
      write_row(stream, row);
    }
  });
}

void save_hits(std::span<const Hit> hits, const std::string& path) {
  write_file_atomically(path, [&](std::ostream& stream) {
    stream << "t,u,v,triangle\n";
    std::string row;
    for (const Hit& hit : hits) {
      for (const float value : {hit.t, hit.u, hit.v}) {
        append_float(row, value);
        row += ',';
      }
      row += is_hit(hit) ? std::to_string(hit.triangle) + "," : "-1,";
      write_row(stream, row);
    }
  });
}

}  // namespace raygrain

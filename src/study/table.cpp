#include "study/table.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "raygrain/error.h"

#include "io/text.h"

namespace raygrain {

namespace study {

namespace {

std::optional<uint64_t> whole(std::string_view text) {
  uint64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

std::string quoted(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string text(1, '"');
  for (const char c : cell) text.append(c == '"' ? 2 : 1, c);
  text.push_back('"');
  return text;
}

/// Reads one cell that starts at `at` and moves `at` behind it; false for a broken quotation.
bool take_cell(std::string_view line, size_t& at, std::string& cell) {
  cell.clear();
  if (at >= line.size() || line[at] != '"') {
    const size_t end = std::min(line.find(',', at), line.size());
    cell = line.substr(at, end - at);
    at = end;
    return cell.find('"') == std::string::npos;
  }
  for (++at; at < line.size(); ++at) {
    if (line[at] != '"') {
      cell += line[at];
    } else if (at + 1 < line.size() && line[at + 1] == '"') {
      cell += line[at++];
    } else {
      ++at;
      return at == line.size() || line[at] == ',';
    }
  }
  return false;
}

}  // namespace

std::vector<std::string> header_of(const Study& study) {
  std::vector<std::string> header{"scene", "kind", "variant", "combo"};
  for (const StudyColumn& column : study.columns) header.push_back(column.name);
  for (const char* name : {"setting", "ray_set", "seed", "repeat", "commit", "compiler", "cpu"}) header.push_back(name);
  return header;
}

std::vector<std::string> row_of(const StudyKey& key, const std::vector<std::string>& cells,
                                const StudyEnvironment& environment) {
  std::vector<std::string> row{key.scene, key.kind, key.variant, key.combo};
  row.insert(row.end(), cells.begin(), cells.end());
  for (const std::string& cell : {key.setting, key.ray_set, std::to_string(key.seed), std::to_string(key.repeat),
                                  environment.commit, environment.compiler, environment.cpu})
    row.push_back(cell);
  return row;
}

std::optional<StudyKey> key_of(const std::vector<std::string>& row) {
  constexpr size_t kTail = 7;
  if (row.size() < kLeadingKeys + kTail) return std::nullopt;
  const std::string* tail = row.data() + row.size() - kTail;
  const auto seed = whole(tail[2]), repeat = whole(tail[3]);
  if (!seed || !repeat) return std::nullopt;
  return StudyKey{row[0], row[1], row[2], row[3], tail[0], tail[1], *seed, *repeat};
}

std::string describe(const StudyKey& key) {
  std::string text = key.scene;
  for (const std::string& part : {key.kind, key.variant, key.combo, key.setting, key.ray_set})
    if (!part.empty()) text.append(text.empty() ? 0 : 1, ' ').append(part);
  return text;
}

std::string csv_line(const std::vector<std::string>& cells) {
  std::string line;
  for (size_t i = 0; i < cells.size(); ++i) line.append(i > 0 ? 1 : 0, ',').append(quoted(cells[i]));
  return line;
}

std::optional<std::vector<std::string>> parse_csv_line(std::string_view line) {
  std::vector<std::string> cells;
  std::string cell;
  for (size_t at = 0;; ++at) {
    if (!take_cell(line, at, cell)) return std::nullopt;
    cells.push_back(cell);
    if (at >= line.size()) return cells;
  }
}

}  // namespace study

std::string study_cell(double value) {
  if (std::isnan(value)) return {};
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

size_t StudyTable::column(const std::string& name) const {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) throw Error(ErrorCode::kNotFound, name, "is no column of these results");
  return static_cast<size_t>(found - header.begin());
}

double StudyTable::number(size_t row, size_t column) const {
  const std::string& cell = rows.at(row).at(column);
  if (cell.empty()) return std::nan("");
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size())
    throw Error(ErrorCode::kMalformed, header.at(column), in_quotes(cell) + " is not a number");
  return value;
}

StudyTable load_study_table(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  StudyTable table;
  size_t number = 0;
  for (size_t begin = 0; begin < bytes.size();) {
    const size_t end = std::min(bytes.find('\n', begin), bytes.size());
    std::string_view line = std::string_view(bytes).substr(begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    begin = end + 1;
    ++number;
    std::optional<std::vector<std::string>> cells = study::parse_csv_line(line);
    if (!cells) throw Error(ErrorCode::kMalformed, place(path, number), "is no line of CSV");
    if (number == 1) {
      table.header = std::move(*cells);
      continue;
    }
    if (cells->size() != table.header.size())
      throw Error(ErrorCode::kMalformed, place(path, number),
                  std::to_string(cells->size()) + " cells under a header of " + std::to_string(table.header.size()));
    table.rows.push_back(std::move(*cells));
  }
  if (table.header.empty()) throw Error(ErrorCode::kMalformed, path, "is empty");
  return table;
}

}  // namespace raygrain

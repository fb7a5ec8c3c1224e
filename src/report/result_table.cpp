#include <algorithm>
#include <array>
#include <filesystem>

#include "raygrain/error.h"
#include "raygrain/fields.h"
#include "raygrain/study_report.h"

#include "io/text.h"
#include "report/study_data.h"

namespace raygrain {

namespace {

constexpr const char* kColumnsHint =
    "results files of raygrain study and compare.csv have a recipe and metrics per row";

/// Other names of columns.
constexpr std::array<std::pair<std::string_view, std::string_view>, 7> kSynonyms{{
    {"combo", kRecipeColumn},
    {"name", kRecipeColumn},
    {"real_cost_local", "real_cost"},
    {"real_cost_with_fallback", "cost_with_fallback"},
    {"overlap", "overlap100_culled"},
    {"estimated_own", "estimated_cost"},
    {"test", "scene"},
}};

struct Record {
  std::vector<std::string> cells;
  size_t line = 0;
};

/// RFC 4180, one record after the other; lines end with LF or CR LF.
class CsvReader {
 public:
  CsvReader(std::string_view bytes, const std::string& path) : rest_(bytes), path_(path) {
    if (rest_.starts_with("\xef\xbb\xbf")) rest_.remove_prefix(3);
  }

  /// The next record that is not an empty line.
  bool next(Record& record) {
    while (!rest_.empty()) {
      record = {{}, line_};
      while (read_cell(record)) {
      }
      if (record.cells.size() > 1 || !record.cells.front().empty()) return true;
    }
    return false;
  }

 private:
  /// Appends a cell; false at the end of the record.
  bool read_cell(Record& record) {
    std::string cell;
    if (rest_.starts_with('"'))
      cell = quoted(record.line);
    else
      cell = take(std::min(rest_.find_first_of(",\n"), rest_.size()));
    if (cell.ends_with('\r')) cell.pop_back();
    if (rest_.starts_with('\r')) rest_.remove_prefix(1);
    record.cells.push_back(std::move(cell));
    if (rest_.empty()) return false;
    const char end = rest_.front();
    if (end != ',' && end != '\n')
      throw Error(ErrorCode::kMalformed, place(path_, line_), "text after a closing quote", kColumnsHint);
    rest_.remove_prefix(1);
    if (end == '\n') ++line_;
    return end == ',';
  }

  std::string quoted(size_t first_line) {
    std::string cell;
    rest_.remove_prefix(1);
    for (;;) {
      const size_t end = rest_.find('"');
      if (end == std::string_view::npos)
        throw Error(ErrorCode::kMalformed, place(path_, first_line), "a quote is not closed", "was the file cut off?");
      const std::string part = take(end);
      line_ += static_cast<size_t>(std::count(part.begin(), part.end(), '\n'));
      cell += part;
      rest_.remove_prefix(1);
      if (!rest_.starts_with('"')) return cell;
      cell += '"';
      rest_.remove_prefix(1);
    }
  }

  std::string take(size_t count) {
    std::string text(rest_.substr(0, count));
    rest_.remove_prefix(count);
    return text;
  }

  std::string_view rest_;
  const std::string& path_;
  size_t line_ = 1;
};

std::string canonical(std::string_view column) {
  for (const auto& [other, own] : kSynonyms)
    if (column == other) return std::string(own);
  return std::string(column);
}

void check_columns(const ResultTable& table) {
  for (size_t i = 0; i < table.columns.size(); ++i)
    if (std::find(table.columns.begin(), table.columns.begin() + static_cast<ptrdiff_t>(i), table.columns[i]) !=
        table.columns.begin() + static_cast<ptrdiff_t>(i))
      throw Error(ErrorCode::kMalformed, place(table.path, 1),
                  "column " + in_quotes(table.columns[i]) + " is there twice", kColumnsHint);
  const bool measured = std::any_of(table.columns.begin(), table.columns.end(), is_metric);
  if (!measured)
    throw Error(ErrorCode::kMalformed, place(table.path, 1), "is no results file: it has no column of a metric",
                kColumnsHint);
}

void check_row(const ResultTable& table, const Record& record) {
  if (record.cells.size() != table.columns.size())
    throw Error(
        ErrorCode::kMalformed, place(table.path, record.line),
        std::to_string(record.cells.size()) + " cells where the header has " + std::to_string(table.columns.size()),
        "was the file cut off? raygrain study goes on where it was stopped");
  for (size_t i = 0; i < record.cells.size(); ++i)
    if (is_metric(table.columns[i]) && !record.cells[i].empty() && !is_number(record.cells[i]))
      throw Error(ErrorCode::kMalformed, place(table.path, record.line),
                  in_quotes(record.cells[i]) + " in column " + in_quotes(table.columns[i]) + " is not a number",
                  "numbers look like 1.5, -2e-3 or nan; what was not measured is empty");
}

/// What study.txt beside a results.csv says: "# raygrain-study 1 NAME HASH"; empty where it says nothing.
std::string noted_name(const std::filesystem::path& folder) {
  const std::string note = (folder / "study.txt").string();
  std::error_code none;
  if (!std::filesystem::is_regular_file(note, none)) return {};
  constexpr std::string_view kTitle = "# raygrain-study 1 ";
  const std::string text = read_whole_file(note);
  const std::string_view line = std::string_view(text).substr(0, text.find('\n'));
  const size_t end = line.rfind(' ');
  return line.starts_with(kTitle) && end >= kTitle.size() ? std::string(line.substr(kTitle.size(), end - kTitle.size()))
                                                          : std::string{};
}

/// What the rows say, or study.txt, or what the file or its folder is called.
std::string study_name(const ResultTable& table) {
  const auto column = std::find(table.columns.begin(), table.columns.end(), "study");
  if (column != table.columns.end()) {
    const std::string& name = table.rows.front()[static_cast<size_t>(column - table.columns.begin())];
    if (!name.empty()) return name;
  }
  const std::filesystem::path path(table.path);
  std::string stem = path.stem().string();
  if (stem != "results") return stem;
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (std::string name = noted_name(folder); !name.empty()) return name;
  return folder.filename().empty() ? stem : folder.filename().string();
}

}  // namespace

ResultTable load_results(const std::string& path) {
  const std::string bytes = read_whole_file(path);
  CsvReader reader(bytes, path);
  Record record;
  ResultTable table;
  table.path = path;
  if (!reader.next(record)) throw Error(ErrorCode::kMalformed, path, "the file is empty", kColumnsHint);
  for (const std::string& cell : record.cells) table.columns.push_back(canonical(trimmed(cell)));
  check_columns(table);
  while (reader.next(record)) {
    check_row(table, record);
    table.rows.push_back(std::move(record.cells));
  }
  if (table.rows.empty())
    throw Error(ErrorCode::kMalformed, path, "has a header and no results",
                "run the study again: it goes on where it was stopped");
  table.study = study_name(table);
  return table;
}

}  // namespace raygrain

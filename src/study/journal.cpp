#include "study/journal.h"

#include <algorithm>
#include <cerrno>
#include <filesystem>
#include <ostream>
#include <set>
#include <system_error>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "raygrain/error.h"
#include "raygrain/io.h"

#include "io/text.h"
#include "study/table.h"

namespace raygrain::study {

namespace {

/// FNV-1a: tells runs of different studies apart, no more.
uint64_t hash(const std::string& text) {
  uint64_t value = 0xcbf29ce484222325u;
  for (const char c : text) value = (value ^ static_cast<unsigned char>(c)) * 0x100000001b3u;
  return value;
}

/// The first line: what the rows below belong to.
std::string title(const Study& study) {
  std::string all = study.identity + '\n' + csv_line(header_of(study)) + '\n';
  for (const StudyTask& task : study.tasks) all += csv_line(row_of(task.key, {}, {})) + '\n';
  return "# raygrain-study 1 " + study.name + ' ' + std::to_string(hash(all));
}

[[noreturn]] void fail_write(const std::string& path) {
  throw Error(ErrorCode::kUnwritable, path, "cannot write: " + std::generic_category().message(errno));
}

/// Results of before study.txt was written: the same columns, and the same rows?
bool are_of(const StudyTable& table, const Study& study) {
  if (table.header != header_of(study) || table.rows.size() != study.tasks.size()) return false;
  std::set<StudyKey> keys;
  for (const StudyTask& task : study.tasks) keys.insert(task.key);
  return std::all_of(table.rows.begin(), table.rows.end(), [&](const auto& row) {
    const auto key = key_of(row);
    return key && keys.contains(*key);
  });
}

}  // namespace

/// Results take hours: those of another study, or of another grid by the same name, stay.
void Journal::check_finished(const Study& study) const {
  const std::string results = folder_ + "/results.csv", note = folder_ + "/study.txt";
  if (!std::filesystem::exists(results)) return;
  bool same = false;
  try {
    same = std::filesystem::exists(note) ? read_whole_file(note) == title(study) + '\n'
                                         : are_of(load_study_table(results), study);
  } catch (const Error&) {
    // What cannot be read is not this study's.
  }
  if (!same)
    throw Error(ErrorCode::kUsage, results, "holds the results of another study, or of this one with other options",
                "Choose another folder with --out, or remove that file first");
}

Journal::Journal(const Study& study, const std::string& folder)
    : folder_(folder), path_(folder + "/results.partial.csv") {
  check_finished(study);
  make_output_folder(folder);
  descriptor_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC, 0666);
  if (descriptor_ < 0) fail_write(path_);
  try {
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0)
      throw Error(ErrorCode::kUsage, folder, "another run is writing here", "Wait for it, or choose another folder");
    read_rows(study);
    write_file_atomically(folder + "/study.txt", [&](std::ostream& out) { out << title(study) << '\n'; });
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void Journal::read_rows(const Study& study) {
  std::string bytes = read_whole_file(path_);
  const size_t whole = bytes.rfind('\n') == std::string::npos ? 0 : bytes.rfind('\n') + 1;
  if (whole < bytes.size() && ::ftruncate(descriptor_, static_cast<off_t>(whole)) != 0) fail_write(path_);
  bytes.resize(whole);
  if (bytes.empty()) return write(title(study) + '\n');

  const size_t first_end = bytes.find('\n');
  if (bytes.substr(0, first_end) != title(study))
    throw Error(ErrorCode::kUsage, path_, "holds an unfinished run of another study, or of this one with other options",
                "Finish that one, remove the file, or choose another folder");
  std::set<StudyKey> wanted;
  for (const StudyTask& task : study.tasks) wanted.insert(task.key);
  const size_t cells = header_of(study).size();
  size_t number = 2;
  for (size_t begin = first_end + 1; begin < bytes.size(); ++number) {
    const size_t end = bytes.find('\n', begin);
    auto row = parse_csv_line(std::string_view(bytes).substr(begin, end - begin));
    begin = end + 1;
    const auto key = row && row->size() == cells ? key_of(*row) : std::nullopt;
    if (!key || !wanted.contains(*key))
      throw Error(ErrorCode::kMalformed, place(path_, number), "is no row of this study",
                  "Remove the line, and the row is computed again");
    rows_[*key] = std::move(*row);
  }
}

void Journal::write(const std::string& text) {
  size_t done = 0;
  while (done < text.size()) {
    const ssize_t written = ::write(descriptor_, text.data() + done, text.size() - done);
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_write(path_);
    done += static_cast<size_t>(written);
  }
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL) fail_write(path_);
}

void Journal::append(const StudyKey& key, std::vector<std::string> row) {
  write(csv_line(row) + '\n');
  rows_[key] = std::move(row);
}

void Journal::finish(const std::vector<std::string>& header) {
  write_file_atomically(folder_ + "/results.csv", [&](std::ostream& out) {
    out << csv_line(header) << '\n';
    for (const auto& [key, row] : rows_) out << csv_line(row) << '\n';
  });
  if (::unlink(path_.c_str()) != 0) fail_write(path_);
}

}  // namespace raygrain::study

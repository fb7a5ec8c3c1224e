// Runs the tasks of a study: a few at a time, each row kept as soon as it is there.
#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>

#include "raygrain/error.h"
#include "raygrain/study.h"

#include "base/parallel.h"
#include "study/journal.h"
#include "study/names.h"
#include "study/table.h"

namespace raygrain {

namespace study {

void check_study(const Study& study) {
  if (study.tasks.empty() && !study.missing.empty()) fail_without_rows(study.name, study.missing);
  if (study.tasks.empty()) throw Error(ErrorCode::kUsage, study.name, "has no rows", "Check the names of scenes");
  std::set<StudyKey> keys;
  for (const StudyTask& task : study.tasks) {
    const StudyKey& key = task.key;
    if (!keys.insert(key).second)
      throw Error(ErrorCode::kUsage, study.name, "two rows have one key: " + describe(key),
                  "Give each recipe its own combo or setting, and each ray set and seed once");
    for (const std::string& name : {study.name, key.scene, key.kind, key.variant, key.combo, key.setting, key.ray_set})
      if (!is_plain_name(name))
        throw Error(ErrorCode::kUsage, study.name, "a name of row " + describe(key) + " has control characters",
                    "Names are one line of text");
  }
}

}  // namespace study

namespace {

using study::Journal;

class Runner {
 public:
  Runner(const Study& study, const StudyRunOptions& options)
      : study_(study), options_(options), journal_(study, options.folder) {
    for (const StudyTask& task : study.tasks) {
      all_ += task.weight;
      if (journal_.rows().contains(task.key))
        done_ += task.weight;
      else
        pending_.push_back(&task);
    }
  }

  StudyTable run() {
    tell("start");
    const unsigned jobs = options_.jobs == 0 ? default_threads() : options_.jobs;
    parallel_for(jobs, 1, jobs, [this](size_t, size_t) { work(); });
    if (cancelled_)
      throw Error(ErrorCode::kCancelled, study_.name, "stopped after the rows in progress",
                  "The same command goes on from here");
    const std::vector<std::string> header = study::header_of(study_);
    journal_.finish(header);
    StudyTable table{header, {}};
    for (const auto& [key, row] : journal_.rows()) table.rows.push_back(row);
    return table;
  }

 private:
  /// Takes tasks, in order, until none is left. An error of one stops all.
  void work() {
    while (!cancelled_ && !failed_) {
      const size_t i = next_++;
      if (i >= pending_.size()) return;
      const StudyTask& task = *pending_[i];
      try {
        const std::vector<std::string> cells = cells_of(task);
        const std::lock_guard lock(mutex_);
        journal_.append(task.key, study::row_of(task.key, cells, options_.environment));
        done_ += task.weight;
        tell(study::describe(task.key));
      } catch (...) {
        failed_ = true;
        throw;
      }
    }
  }

  std::vector<std::string> cells_of(const StudyTask& task) const {
    std::vector<std::string> cells;
    try {
      cells = task.run();
    } catch (const Error& error) {
      throw Error(error.code, study::describe(task.key), error.where + ": " + error.message, error.hint);
    }
    if (cells.size() != study_.columns.size())
      throw Error(ErrorCode::kUsage, study::describe(task.key),
                  std::to_string(cells.size()) + " cells for " + std::to_string(study_.columns.size()) + " columns");
    return cells;
  }

  void tell(const std::string& step) {
    const double share = all_ > 0 ? std::min(done_ / all_, 1.0) : 1;
    if (options_.progress && !options_.progress(step, share)) cancelled_ = true;
  }

  const Study& study_;
  const StudyRunOptions& options_;
  Journal journal_;
  std::vector<const StudyTask*> pending_;
  std::atomic<size_t> next_{0};
  std::atomic<bool> cancelled_{false}, failed_{false};
  std::mutex mutex_;           // for the journal and the progress
  double all_ = 0, done_ = 0;  // weights
};

}  // namespace

void Study::add(const StudyKey& key, std::function<std::vector<std::string>()> run, double weight) {
  tasks.push_back({key, std::move(run), weight});
}

StudyTable run_study(const Study& study, const StudyRunOptions& options) {
  study::check_study(study);
  return Runner(study, options).run();
}

}  // namespace raygrain

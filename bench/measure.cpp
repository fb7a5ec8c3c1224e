#include "measure.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>

#include "raygrain/trace.h"

namespace raygrain::bench {
namespace {

constexpr size_t kMostQuestions = 10;
constexpr int kRounds = 7, kRoundsOnManyThreads = 15;  // more, for other programs disturb them more

bool same_answer(bool any, const Answers& a, const Answers& b, size_t i) {
  return any ? a.flags[i] == b.flags[i] : std::memcmp(&a.hits[i], &b.hits[i], sizeof(Hit)) == 0;
}

/// Hits whose t agree within rounding are the same; which of two triangles at a common edge is named is not compared.
bool differ(bool any, const Answers& a, const Answers& b, size_t i) {
  if (any) return a.flags[i] != b.flags[i];
  const Hit &x = a.hits[i], &y = b.hits[i];
  if (is_hit(x) != is_hit(y)) return true;
  return is_hit(x) && x.triangle != y.triangle && std::abs(x.t - y.t) > 1e-4f * std::max(std::abs(x.t), 1e-3f);
}

class Measurement {
 public:
  Measurement(const TriangleMesh& mesh, const BenchRays& set, const Peer& peer, unsigned threads)
      : mesh_(mesh), set_(set), peer_(peer), threads_(threads) {}

  std::vector<Row> run(Row row, const std::vector<Entrant>& entrants) {
    row.triangles = mesh_.triangle_count();
    row.rays = set_.name;
    row.query = set_.any ? "any" : "closest";
    row.threads = threads_;
    const std::vector<Entrant> ours = best_of_each_api(entrants);
    const std::vector<PeerMode> modes = peer_.best_modes(set_, threads_);
    for (const Entrant& entrant : ours) add(entrant.trace);
    for (const PeerMode& mode : modes)
      add([this, mode](bool any, const Part& part, unsigned n) { peer_.trace(mode, any, part, n); });
    const std::vector<double> seconds =
        race(contenders_, set_.rays.size(), threads_, threads_ == 1 ? kRounds : kRoundsOnManyThreads);
    check_agreement(ours);
    add_peer_figures(modes, std::span(seconds).subspan(ours.size()), ours.size(), row);
    return rows_of(ours, seconds, row);
  }

 private:
  void add(const Tracer& tracer) {
    answers_.push_back(std::make_unique<Answers>(set_.rays.size()));
    contenders_.push_back([this, tracer, &answers = *answers_.back()](size_t begin, size_t end) {
      tracer(set_.any, Part(set_, answers, begin, end), threads_);
    });
  }

  /// In the given order of the apis, of each the two fastest.
  std::vector<Entrant> best_of_each_api(const std::vector<Entrant>& entrants) const {
    const BenchRays sample = spread_sample(set_, kRaysToRank);
    std::vector<std::string> apis;
    for (const Entrant& entrant : entrants)
      if (std::ranges::find(apis, entrant.api) == apis.end()) apis.push_back(entrant.api);
    std::vector<Entrant> best;
    for (const std::string& api : apis) {
      std::vector<std::pair<double, const Entrant*>> ranking;
      for (const Entrant& entrant : entrants)
        if (entrant.api == api) ranking.emplace_back(try_out(entrant.trace, sample, threads_), &entrant);
      std::ranges::stable_sort(ranking, {}, &std::pair<double, const Entrant*>::first);
      for (size_t i = 0; i < std::min<size_t>(2, ranking.size()); ++i) best.push_back(*ranking[i].second);
    }
    return best;
  }

  void check_agreement(const std::vector<Entrant>& ours) const {
    for (size_t k = 1; k < ours.size(); ++k)
      for (size_t i = 0; i < set_.rays.size(); ++i)
        if (!same_answer(set_.any, *answers_[0], *answers_[k], i))
          throw std::logic_error("raygrain's " + ours[k].api + " and " + ours[0].api + " disagree about ray " +
                                 std::to_string(i) + " of " + set_.name);
  }

  double mrays(double seconds) const { return static_cast<double>(set_.rays.size()) / seconds * 1e-6; }

  void add_peer_figures(const std::vector<PeerMode>& modes, std::span<const double> seconds, size_t first, Row& row) {
    for (size_t i = 0; i < modes.size(); ++i) {
      const double speed = mrays(seconds[i]);
      if (speed > row.embree_best_mrays) {
        row.embree_best_mrays = speed;
        row.embree_best_mode = modes[i].name();
        best_ = answers_[first + i].get();
      }
      if (modes[i].packet != 1 || speed <= row.embree_single_mrays) continue;
      row.embree_single_mrays = speed;
      row.embree_single_mode = modes[i].name();
      best_single_ = answers_[first + i].get();
    }
  }

  std::vector<Row> rows_of(const std::vector<Entrant>& ours, const std::vector<double>& seconds, const Row& row) const {
    std::vector<Row> rows;
    for (size_t i = 0; i < ours.size(); ++i) {
      if (rows.empty() || rows.back().api != ours[i].api) {
        rows.push_back(row);
        rows.back().api = ours[i].api;
        const Answers* theirs = ours[i].api == "single" ? best_single_ : best_;
        if (theirs != nullptr) rows.back().differences = count_differences(mesh_, set_, *answers_[i], *theirs);
      }
      if (mrays(seconds[i]) <= rows.back().raygrain_mrays) continue;
      rows.back().raygrain_mrays = mrays(seconds[i]);
      rows.back().tree = ours[i].tree;
    }
    return rows;
  }

  const TriangleMesh& mesh_;
  const BenchRays& set_;
  const Peer& peer_;
  unsigned threads_;
  std::vector<std::unique_ptr<Answers>> answers_;  // ours, then the peer's
  std::vector<Contender> contenders_;
  const Answers *best_ = nullptr, *best_single_ = nullptr;  // the peer's
};

}  // namespace

Differences count_differences(const TriangleMesh& mesh, const BenchRays& set, const Answers& ours,
                              const Answers& theirs) {
  Differences found;
  for (size_t i = 0; i < set.rays.size(); ++i) {
    if (!differ(set.any, ours, theirs, i)) continue;
    ++found.count;
    if (found.asked == kMostQuestions) continue;
    ++found.asked;
    found.agreed += set.any ? occluded_reference(mesh, set.rays[i]) == (ours.flags[i] != 0)
                            : intersect_reference(mesh, set.rays[i]) == ours.hits[i];
  }
  return found;
}

void measure(const Row& row, const TriangleMesh& mesh, const BenchRays& set, const std::vector<Entrant>& entrants,
             const Peer& peer, unsigned threads, Results& results) {
  if (set.rays.empty()) return;
  for (const Row& finished : Measurement(mesh, set, peer, threads).run(row, entrants)) report(finished, results);
}

}  // namespace raygrain::bench

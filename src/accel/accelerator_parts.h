// What an accelerator holds.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "accel/routes.h"
#include "accel/search.h"
#include "accel/search_tree.h"

namespace raygrain {

/// In bytes.
struct AcceleratorMemory {
  size_t global = 0;          // the global tree, in all forms
  std::vector<size_t> areas;  // coverage and local tree in all forms, without what they share
  size_t shared = 0;          // tables, top level, and the corners that all trees in ray space share
  size_t fast_forms = 0;      // of all these: wide trees and trees in ray space with their corners

  size_t total() const;
};

struct Accelerator::Parts {
  std::shared_ptr<const TriangleMesh> mesh;
  std::vector<LocalTree> locals;     // parallel to the areas, or none
  std::vector<SearchTree> searches;  // parallel to `locals`
  SearchTree global;
  AreaTable areas;  // of `locals`
  Traversal traversal = Traversal::kWide;
  std::vector<AreaGeometry> geometries = {};  // of all areas
  std::vector<Coverage> coverages = {};       // parallel to them, or empty
  std::vector<AreaCosts> costs = {};          // ... likewise
  Routes routes = {};
  ManyShares many_shares = {};
  double shared_seconds = 0;  // of the build: top level, tables, and what chose the routes

  /// Chooses the routes: by cost, or whatever there is.
  void choose_routes(bool by_cost, const SampleSource& samples, Isa isa);

  AcceleratorMemory memory() const;

  /// What there is of an area, without times.
  AreaReport describe(size_t area) const;
  void describe_local(size_t area, AreaReport& report) const;

  /// Makes room for the areas' counts; where there is none they are left out.
  void count_areas(AcceleratorCounters* counters) const;
  void count_use(uint32_t area, const Ray& ray, AcceleratorCounters* counters) const;
  void count_global(const Ray& ray, AcceleratorCounters* counters) const;

  Hit nearest(const Ray& ray, const Route& route, AcceleratorCounters* counters) const;
  Hit nearest_by_trees(const Ray& ray, const Route& route, AcceleratorCounters* counters) const;
  bool any(const Ray& ray, const Route& route, AcceleratorCounters* counters) const;
  bool any_by_trees(const Ray& ray, const Route& route, AcceleratorCounters* counters) const;

  // Any hits (flags) or nearest ones. Answers: uint8_t or Hit.
  template <class Answer>
  const Route& route_of_one() const {
    return kIsAny<Answer> ? routes.any : routes.nearest;
  }
  template <class Answer>
  const Route& route_of_many() const {
    return kIsAny<Answer> ? routes.any_of_many : routes.nearest_of_many;
  }
  template <class Answer>
  Answer answer_one(const Ray& ray, AcceleratorCounters* counters) const;
  /// Ray by ray.
  template <class Answer>
  void answer_along(const Route& route, std::span<const Ray> rays, std::span<Answer> answers,
                    AcceleratorCounters* counters) const;
  /// Rays that concern no area. Counted, they go one by one.
  template <class Answer>
  void answer_by_global(std::span<const Ray> rays, std::span<Answer> answers, AcceleratorCounters* counters) const;
  /// Rays that coverage has left.
  template <class Answer>
  void answer_by_trees(std::span<const Ray> rays, std::span<Answer> answers, AcceleratorCounters* counters) const;
  template <class Answer>
  void answer_gathered(std::span<const Ray> rays, std::span<const uint32_t> numbers, std::span<Answer> answers,
                       AcceleratorCounters* counters) const;
  template <class Answer>
  void answer_chunk(std::span<const Ray> rays, std::span<Answer> answers, AcceleratorCounters* counters) const;
  template <class Answer>
  void answer_array(std::span<const Ray> rays, std::span<Answer> answers, unsigned threads,
                    AcceleratorCounters* counters) const;
  template <class Answer>
  void answer_batch(const Shared& shared, std::span<const Vec3> points, std::span<Answer> answers, unsigned threads,
                    AcceleratorCounters* counters) const;
};

template <>
Hit Accelerator::Parts::answer_one<Hit>(const Ray& ray, AcceleratorCounters* counters) const;
template <>
uint8_t Accelerator::Parts::answer_one<uint8_t>(const Ray& ray, AcceleratorCounters* counters) const;

}  // namespace raygrain

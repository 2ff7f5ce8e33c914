// Every entry of every path of a plan, in flat arrays for inner loops.

#ifndef TRAVERSE_ENGINE_COST_ENTRY_TABLE_H_
#define TRAVERSE_ENGINE_COST_ENTRY_TABLE_H_

#include <cstddef>
#include <vector>

#include "absl/types/span.h"
#include "engine/base/budget.h"
#include "engine/model/plan.h"
#include "engine/model/route.h"

namespace traverse {

// Entries are numbered from 0 over all paths. Path p has [first(p), first(p + 1)), for a contour in
// the order of Path::allowed (or of its vertices), for an open path forward and then reversed.
// Contours have enter(e) == exit(e). Memory: 40 bytes per entry.
class EntryTable {
 public:
  // Asks `budget` regularly, if it is not null.
  explicit EntryTable(const Plan& plan, Budget* budget = nullptr);

  int path_count() const { return static_cast<int>(first_.size()) - 1; }
  int entry_count() const { return first_.back(); }

  int first(int path) const { return first_[static_cast<size_t>(path)]; }
  int count(int path) const { return first(path + 1) - first(path); }

  Point enter(int entry) const { return enter_[static_cast<size_t>(entry)]; }
  Point exit(int entry) const { return exit_[static_cast<size_t>(entry)]; }

  // The points of all entries of a path at once: enters(p)[i] == enter(first(p) + i).
  absl::Span<const Point> enters(int path) const { return Slice(enter_, path); }
  absl::Span<const Point> exits(int path) const { return Slice(exit_, path); }

  int path_of(int entry) const { return path_of_[static_cast<size_t>(entry)]; }

  // Converts an entry to its visit, and back. REQUIRES for EntryOf: visit.entry is allowed.
  Visit VisitOf(int entry) const {
    return Visit{path_of(entry), visit_entry_[static_cast<size_t>(entry)]};
  }
  int EntryOf(const Visit& visit) const;

 private:
  absl::Span<const Point> Slice(const std::vector<Point>& points, int path) const {
    return absl::MakeConstSpan(points.data() + first(path), static_cast<size_t>(count(path)));
  }

  std::vector<int> first_;        // [path], path_count() + 1 of them
  std::vector<Point> enter_;      // [entry]
  std::vector<Point> exit_;       // [entry]
  std::vector<int> path_of_;      // [entry]
  std::vector<int> visit_entry_;  // [entry] Visit::entry
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_COST_ENTRY_TABLE_H_

#include "engine/validator.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "engine/base/rest.h"
#include "engine/validator_links.h"

namespace traverse {
namespace {

absl::Status Fault(const std::string& text) { return absl::FailedPreconditionError(text); }

bool Allows(const Path& path, int entry) {
  if (path.kind == Path::Kind::kOpen) return entry == 0 || (entry == 1 && !path.one_way);
  if (entry < 0 || entry >= static_cast<int>(path.points.size())) return false;
  return path.allowed.empty() ||
         std::find(path.allowed.begin(), path.allowed.end(), entry) != path.allowed.end();
}

// Fills `position`: [path] where in the route it is.
absl::Status CheckVisits(const Plan& plan, const Route& route, Rest& rest,
                         std::vector<int>& position) {
  const int paths = static_cast<int>(plan.paths.size());
  position.assign(plan.paths.size(), -1);
  for (size_t i = 0; i < route.size(); ++i) {
    rest(4);
    const Visit& visit = route[i];
    const auto fault = [&](const std::string& text) {
      return Fault(absl::StrCat("route[", i, "]: ", text));
    };
    if (visit.path < 0 || visit.path >= paths) {
      return fault(absl::StrCat("there is no path ", visit.path));
    }
    int& slot = position[static_cast<size_t>(visit.path)];
    if (slot >= 0) return fault(absl::StrCat("path ", visit.path, " was visited before"));
    slot = static_cast<int>(i);
    if (!Allows(plan.paths[static_cast<size_t>(visit.path)], visit.entry)) {
      return fault(absl::StrCat("path ", visit.path, " cannot be entered at ", visit.entry));
    }
  }
  for (size_t p = 0; p < position.size(); ++p) {
    if (position[p] < 0) return Fault(absl::StrCat("path ", p, " is not visited"));
  }
  return absl::OkStatus();
}

// The positions in the route that the paths below a node take.
struct Range {
  int first = std::numeric_limits<int>::max();
  int last = -1;
  int count = 0;

  bool empty() const { return count == 0; }
  void Add(const Range& other) {
    first = std::min(first, other.first);
    last = std::max(last, other.last);
    count += other.count;
  }
};

absl::Status CheckInOrder(const PlanNode& node, size_t index, const std::vector<Range>& ranges) {
  int last = -1;
  for (size_t c = 0; c < node.children.size(); ++c) {
    const Range& range = ranges[static_cast<size_t>(node.children[c])];
    if (range.empty()) continue;
    if (range.first < last) {
      return Fault(absl::StrCat("nodes[", index, "].in_order: child ", c, " comes too early"));
    }
    last = range.last;
  }
  return absl::OkStatus();
}

// A child without paths may be done anywhere, but what comes before it still comes before what
// comes after it. So each child has an end: its own last position, or if it has none, the latest
// end of those that come before it. The pairs have no cycle (CheckPlan), so all get one.
class BeforeCheck {
 public:
  BeforeCheck(const PlanNode& node, const std::vector<Range>& ranges)
      : node_(node),
        ranges_(ranges),
        first_pair_(node.children.size() + 1),
        second_(node.before.size()),
        waiting_for_(node.children.size()),
        end_before_(node.children.size(), -1) {
    for (const auto& [first, second] : node.before) {
      ++first_pair_[static_cast<size_t>(first) + 1];
      ++waiting_for_[static_cast<size_t>(second)];
    }
    for (size_t c = 0; c < node.children.size(); ++c) first_pair_[c + 1] += first_pair_[c];
    std::vector<size_t> next(first_pair_.begin(), first_pair_.end() - 1);
    for (const auto& [first, second] : node.before) {
      second_[next[static_cast<size_t>(first)]++] = second;
    }
  }

  absl::Status Run(size_t index) {
    std::vector<size_t> ready;
    for (size_t c = 0; c < waiting_for_.size(); ++c) {
      if (waiting_for_[c] == 0) ready.push_back(c);
    }
    for (size_t next = 0; next < ready.size(); ++next) {
      const size_t child = ready[next];
      const Range& range = RangeOf(child);
      if (range.first < end_before_[child]) {
        return Fault(absl::StrCat("nodes[", index, "].any_order: child ", child,
                                  " comes before one that must precede it"));
      }
      const int end = range.empty() ? end_before_[child] : range.last;
      for (size_t pair = first_pair_[child]; pair < first_pair_[child + 1]; ++pair) {
        const size_t later = static_cast<size_t>(second_[pair]);
        end_before_[later] = std::max(end_before_[later], end);
        if (--waiting_for_[later] == 0) ready.push_back(later);
      }
    }
    return absl::OkStatus();
  }

 private:
  const Range& RangeOf(size_t child) const {
    return ranges_[static_cast<size_t>(node_.children[child])];
  }

  const PlanNode& node_;
  const std::vector<Range>& ranges_;  // [node]
  std::vector<size_t> first_pair_;    // [child] the first of its pairs in second_
  std::vector<int> second_;           // the children that come after it
  std::vector<int> waiting_for_;      // [child] pairs not examined yet
  std::vector<int> end_before_;       // [child] the latest end of those that come before it
};

// From the leaves up, as children have greater indices than their parents.
absl::Status CheckTree(const Plan& plan, const std::vector<int>& position, Rest& rest) {
  std::vector<Range> ranges(plan.nodes.size());
  for (size_t index = plan.nodes.size(); index-- > 0;) {
    const PlanNode& node = plan.nodes[index];
    rest(2 + 2 * node.children.size() + 4 * node.before.size());
    Range& range = ranges[index];
    if (node.kind == PlanNode::Kind::kPath) {
      const int at = position[static_cast<size_t>(node.path)];
      range = Range{at, at, 1};
      continue;
    }
    for (const int child : node.children) range.Add(ranges[static_cast<size_t>(child)]);
    if (!range.empty() && range.last - range.first + 1 != range.count) {
      return Fault(absl::StrCat("nodes[", index, "]: other paths come between its own"));
    }
    absl::Status status = node.kind == PlanNode::Kind::kInOrder
                              ? CheckInOrder(node, index, ranges)
                              : BeforeCheck(node, ranges).Run(index);
    if (!status.ok()) return status;
  }
  return absl::OkStatus();
}

double Length(Point from, Point to) { return std::hypot(to.x - from.x, to.y - from.y); }

}  // namespace

absl::Status ValidateRoute(const Plan& plan, const Route& route, Budget* budget) {
  assert(CheckPlan(plan).ok());
  Rest rest(budget);
  std::vector<int> position;
  if (absl::Status status = CheckVisits(plan, route, rest, position); !status.ok()) return status;
  return CheckTree(plan, position, rest);
}

TravelSplit MeasureTravel(const Plan& plan, Point start, const Route& route, Budget* budget,
                          const LayerLinks* links) {
  assert(ValidateRoute(plan, route).ok());
  TravelSplit split;
  Point at = start;
  Path::Kind from = Path::Kind::kContour;
  Rest rest(budget);
  for (const Visit& visit : route) {
    rest(4);
    const Path& path = plan.paths[static_cast<size_t>(visit.path)];
    const double length = Length(at, path.points[static_cast<size_t>(visit.entry)]);
    if (path.kind != from) {
      split.links_mm += length;
    } else if (from == Path::Kind::kContour) {
      split.contours_mm += length;
    } else {
      split.rasters_mm += length;
    }
    const int exit = path.kind == Path::Kind::kOpen ? 1 - visit.entry : visit.entry;
    at = LeavingAt(links, visit.path, exit).from.value_or(path.points[static_cast<size_t>(exit)]);
    from = path.kind;
  }
  return split;
}

}  // namespace traverse

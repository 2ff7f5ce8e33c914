#include "engine/proof/vertices/places.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace traverse {
namespace {

// Of more pairs of points the boxes' distance is taken.
constexpr size_t kMostPairs = 4096;

double Diagonal(const BoundingBox& box) { return std::hypot(box.width(), box.height()); }

}  // namespace

Places::Places(const EndGraph& graph, size_t most_of_end) : graph_(&graph) {
  assert(most_of_end >= 1);
  for (size_t end = 0; end < graph.ends.size(); ++end) {
    const int of_end = static_cast<int>(end);
    const int points = static_cast<int>(graph.ends[end].points.size());
    std::vector<Place> parts{MakePlace(of_end, 0, points)};
    while (parts.size() < most_of_end) {
      const auto widest = std::max_element(
          parts.begin(), parts.end(),
          [](const Place& a, const Place& b) { return Diagonal(a.box) < Diagonal(b.box); });
      if (Diagonal(widest->box) == 0) break;
      std::vector<Place> halves;
      SplitInto(*widest, halves);
      *widest = halves[0];
      parts.insert(widest + 1, halves[1]);
    }
    places_.insert(places_.end(), parts.begin(), parts.end());
  }
  FindFirst();
}

absl::Span<const Point> Places::points(int place) const {
  const Place& it = at(place);
  return absl::MakeConstSpan(graph_->ends[static_cast<size_t>(it.end)].points)
      .subspan(static_cast<size_t>(it.begin), static_cast<size_t>(it.behind - it.begin));
}

double Places::width(int place) const { return Diagonal(at(place).box); }

double Places::LeastDistance(int a, int b) const {
  const auto from = points(a);
  const auto to = points(b);
  if (from.size() * to.size() > kMostPairs) return box(a).DistanceTo(box(b));
  distances_ += static_cast<double>(from.size() * to.size());
  double least = std::numeric_limits<double>::infinity();
  for (const Point& p : from) {
    for (const Point& q : to) {
      const double dx = p.x - q.x;
      const double dy = p.y - q.y;
      least = std::min(least, dx * dx + dy * dy);
    }
  }
  return std::sqrt(least);
}

Places::Place Places::MakePlace(int end, int begin, int behind) const {
  const auto& points = graph_->ends[static_cast<size_t>(end)].points;
  return {end, begin, behind,
          BoundingBox(absl::MakeConstSpan(points).subspan(static_cast<size_t>(begin),
                                                          static_cast<size_t>(behind - begin)))};
}

// Where the wider half is narrowest.
void Places::SplitInto(const Place& place, std::vector<Place>& parts) const {
  const auto& points = graph_->ends[static_cast<size_t>(place.end)].points;
  const auto point = [&](int i) { return points[static_cast<size_t>(i)]; };
  std::vector<double> behind(static_cast<size_t>(place.behind - place.begin));
  BoundingBox box;
  for (int i = place.behind; i-- > place.begin;) {
    box.Add(point(i));
    behind[static_cast<size_t>(i - place.begin)] = Diagonal(box);
  }
  box = BoundingBox();
  double least = std::numeric_limits<double>::infinity();
  int cut = place.begin + 1;
  for (int i = place.begin + 1; i < place.behind; ++i) {
    box.Add(point(i - 1));
    const double wider = std::max(Diagonal(box), behind[static_cast<size_t>(i - place.begin)]);
    if (wider >= least) continue;
    least = wider;
    cut = i;
  }
  parts.push_back(MakePlace(place.end, place.begin, cut));
  parts.push_back(MakePlace(place.end, cut, place.behind));
}

void Places::FindFirst() {
  first_.assign(graph_->ends.size() + 1, 0);
  for (const Place& place : places_) ++first_[static_cast<size_t>(place.end) + 1];
  for (size_t end = 0; end < graph_->ends.size(); ++end) first_[end + 1] += first_[end];
}

std::vector<int> Places::Split(const std::vector<char>& marked) {
  assert(marked.size() == places_.size());
  std::vector<Place> parts;
  std::vector<int> first;
  for (size_t p = 0; p < places_.size(); ++p) {
    first.push_back(static_cast<int>(parts.size()));
    if (marked[p] != 0 && Diagonal(places_[p].box) > 0) {
      SplitInto(places_[p], parts);
    } else {
      parts.push_back(places_[p]);
    }
  }
  first.push_back(static_cast<int>(parts.size()));
  places_ = std::move(parts);
  FindFirst();
  return first;
}

}  // namespace traverse

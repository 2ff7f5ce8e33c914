#include "engine/proof/vertices/set_finder.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/base/at.h"

namespace traverse {
namespace {

constexpr double kLeastWeight = 0.02;  // of a move that is looked at
constexpr double kFirstWeight = 0.1;   // of one that a set begins with

// A set stops growing where that takes so much away, or when it is so large.
constexpr double kMostLoss = 0.1;
constexpr size_t kMostOfSet = 14;
constexpr size_t kMostOfSetWithWhole = 24;

// Sets that share most of their points with so many others are left out.
constexpr int kMostCovers = 2;

}  // namespace

SetFinder::SetFinder(const NearMoves& moves, const AverageSolution& average)
    : moves_(moves),
      average_(average),
      neighbors_(At(moves.point_count())),
      is_in_(neighbors_.size()),
      tie_(neighbors_.size()) {
  for (size_t i = 0; i < moves.moves().size(); ++i) {
    const double weight = average.moves[i];
    if (weight <= kLeastWeight) continue;
    const int* points = moves.moves()[i].points;
    neighbors_[At(points[0])].push_back({points[1], weight});
    neighbors_[At(points[1])].push_back({points[0], weight});
  }
}

void SetFinder::TakeIn(int point) {
  is_in_[At(point)] = 1;
  points_.push_back(point);
  for (const Neighbor& neighbor : neighbors_[At(point)]) {
    if (tie_[At(neighbor.point)] == 0) candidates_.push_back(neighbor.point);
    tie_[At(neighbor.point)] += neighbor.weight;
  }
}

int SetFinder::BestNeighbor(bool has_whole, double most_visited, double& gain) const {
  int best = -1;
  gain = -kMostLoss;
  for (const int point : candidates_) {
    if (is_in_[At(point)] != 0) continue;
    double of_point = tie_[At(point)] - Visited(point);
    if (!has_whole) of_point += std::max(0.0, Visited(point) - most_visited);
    if (of_point < gain || (of_point == gain && best >= 0)) continue;
    gain = of_point;
    best = point;
  }
  return best;
}

// `violation` is that of the set of `first` points.
void SetFinder::Grow(const std::vector<int>& first, double violation, bool has_whole,
                     double least) {
  double most_visited = 0;
  for (const int point : first) {
    TakeIn(point);
    most_visited = std::max(most_visited, Visited(point));
  }
  size_t best_size = violation >= least ? points_.size() : 0;
  double best = std::max(violation, least);
  const size_t most = has_whole ? kMostOfSetWithWhole : kMostOfSet;
  while (points_.size() < most) {
    double gain = 0;
    const int point = BestNeighbor(has_whole, most_visited, gain);
    if (point < 0) break;
    TakeIn(point);
    most_visited = std::max(most_visited, Visited(point));
    violation += gain;
    if (violation <= best) continue;
    best = violation;
    best_size = points_.size();
  }
  for (const int point : points_) is_in_[At(point)] = 0;
  for (const int point : candidates_) tie_[At(point)] = 0;
  candidates_.clear();
  points_.resize(best_size);
  if (best_size > 0) Add(points_, best);
  points_.clear();
}

void SetFinder::Add(std::vector<int> points, double violation) {
  const double score = violation / static_cast<double>(points.size());
  found_.push_back({score, std::move(points)});
}

void SetFinder::Offer(const Take& take) {
  std::stable_sort(found_.begin(), found_.end(),
                   [](const Found& a, const Found& b) { return a.score > b.score; });
  std::vector<int> covers(neighbors_.size());  // [point]
  for (const Found& found : found_) {
    const auto covered = std::count_if(found.points.begin(), found.points.end(),
                                       [&](int point) { return covers[At(point)] >= kMostCovers; });
    if (2 * static_cast<size_t>(covered) > found.points.size() || !take(found.points)) continue;
    for (const int point : found.points) ++covers[At(point)];
  }
}

void SetFinder::Find(double least, const Take& take, Budget& budget) {
  found_.clear();
  const int points = moves_.point_count();
  std::vector<int> first;
  for (int point = 0; point < points && !budget.Exhausted(); ++point) {
    first.push_back(point);
    const int end = moves_.end_of(point);
    if (point + 1 == moves_.first(end + 1)) {
      Grow(first, 0, true, least);
      first.clear();
    }
    for (const Neighbor& neighbor : neighbors_[At(point)]) {
      if (neighbor.point < point || neighbor.weight < kFirstWeight) continue;
      Grow({point, neighbor.point},
           neighbor.weight - std::min(Visited(point), Visited(neighbor.point)), false, least);
    }
  }
  Offer(take);
}

}  // namespace traverse

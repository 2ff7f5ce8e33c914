// Sets of points within which solutions make too many moves (subtour_sets.h), by growing them.

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_SET_FINDER_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_SET_FINDER_H_

#include <functional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/vertices/near_moves.h"
#include "engine/proof/vertices/subtour_sets.h"

namespace traverse {

class SetFinder {
 public:
  // The arguments outlive this.
  SetFinder(const NearMoves& moves, const AverageSolution& average);

  // Offers sets whose inequality the average violates by `least` or more, worst first, to `take`,
  // which says whether it took one: from each end and each frequent move, the point that adds the
  // most is taken in again and again. None is offered that has most of its points in several that
  // were taken. Fewer if the budget ends.
  using Take = std::function<bool(const std::vector<int>& points)>;
  void Find(double least, const Take& take, Budget& budget);

 private:
  struct Found {
    double score = 0;
    std::vector<int> points;
  };
  struct Neighbor {
    int point = 0;
    double weight = 0;
  };

  double Visited(int point) const { return average_.points[static_cast<size_t>(point)]; }
  void TakeIn(int point);
  int BestNeighbor(bool has_whole, double most_visited, double& gain) const;
  void Grow(const std::vector<int>& first, double violation, bool has_whole, double least);
  void Add(std::vector<int> points, double violation);
  void Offer(const Take& take);

  const NearMoves& moves_;
  const AverageSolution& average_;
  std::vector<std::vector<Neighbor>> neighbors_;  // [point] of moves that are frequent enough
  std::vector<Found> found_;

  // The set that is growing.
  std::vector<int> points_;
  std::vector<char> is_in_;      // [point]
  std::vector<double> tie_;      // [point] moves to the set
  std::vector<int> candidates_;  // points with such
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_SET_FINDER_H_

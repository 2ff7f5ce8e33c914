// A point and all points of another end, as sets with multipliers: no more moves between them than
// the point is visited (subtour_sets.h). There is one for each line (near_moves.h) of each known
// pair.

#ifndef TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_SETS_H_
#define TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_SETS_H_

#include <cstddef>
#include <vector>

#include "engine/proof/vertices/near_moves.h"

namespace traverse {

class NearSets {
 public:
  // `moves` outlives this.
  explicit NearSets(const NearMoves& moves) : moves_(moves) {}

  // Takes the sets of groups that came in, with multiplier 0.
  void AddNew();

  // After NearMoves::Split: each set becomes as many as its single point did.
  void Split(const std::vector<int>& became);

  // [line] what each of its moves costs.
  const std::vector<double>& multipliers() const { return multipliers_; }

  // Adds what the multipliers pay back for visiting a point.
  void PayBack(std::vector<double>& paid_back) const;

  // Puts a solution into the directions, with `weight` against that of those before: [end] the
  // point that it visits, and then each of its moves.
  void Take(const std::vector<int>& points, double weight);
  void TakeMove(size_t group, const NearMoves::Move& move, double weight);

  // Square of the length of the directions, but for those that would make a multiplier negative.
  double SquareOfDirection() const;

  // Moves all multipliers along the directions.
  void Step(double length);

  // The multipliers at hand are those of the best bound; and back to these.
  void Keep() { best_ = multipliers_; }
  void GoBack() { multipliers_ = best_; }

  // An upper bound of what the multipliers add up to.
  double Scale() const;

 private:
  const NearMoves& moves_;
  std::vector<double> multipliers_;  // [line]
  std::vector<double> best_;
  std::vector<double> direction_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_VERTICES_NEAR_SETS_H_

#include "engine/proof/vertices/near_sets.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace traverse {
namespace {

size_t Index(int index) { return static_cast<size_t>(index); }

}  // namespace

void NearSets::AddNew() {
  for (auto* values : {&multipliers_, &best_, &direction_}) values->resize(moves_.line_count());
}

void NearSets::Split(const std::vector<int>& became) {
  std::vector<int> before_of(Index(became.back()));  // [part]
  for (size_t p = 0; p + 1 < became.size(); ++p) {
    for (int part = became[p]; part < became[p + 1]; ++part) {
      before_of[Index(part)] = static_cast<int>(p);
    }
  }
  std::vector<double> multipliers;
  std::vector<double> direction;
  size_t line = 0;  // before
  for (const NearMoves::Group& group : moves_.groups()) {
    for (const int end : group.ends) {
      for (int part = moves_.first(end); part < moves_.first(end + 1); ++part) {
        const size_t before = Index(before_of[Index(part)]);
        multipliers.push_back(multipliers_[line]);
        direction.push_back(direction_[line] / (became[before + 1] - became[before]));
        if (part + 1 == became[before + 1]) ++line;
      }
    }
  }
  best_ = multipliers;
  multipliers_ = std::move(multipliers);
  direction_ = std::move(direction);
}

void NearSets::PayBack(std::vector<double>& paid_back) const {
  const double* of_line = multipliers_.data();
  for (const NearMoves::Group& group : moves_.groups()) {
    for (const int end : group.ends) {
      for (int p = moves_.first(end); p < moves_.first(end + 1); ++p) {
        paid_back[Index(p)] += *of_line++;
      }
    }
  }
}

void NearSets::Take(const std::vector<int>& points, double weight) {
  for (double& value : direction_) value *= 1 - weight;
  for (const NearMoves::Group& group : moves_.groups()) {
    for (const int end : group.ends) {
      direction_[moves_.LineOf(group, points[Index(end)])] -= weight;
    }
  }
}

void NearSets::TakeMove(size_t group, const NearMoves::Move& move, double weight) {
  for (const int point : move.points) {
    direction_[moves_.LineOf(moves_.groups()[group], point)] += weight;
  }
}

double NearSets::SquareOfDirection() const {
  double square = 0;
  for (size_t i = 0; i < direction_.size(); ++i) {
    const bool counts = multipliers_[i] > 0 || direction_[i] > 0;
    square += counts ? direction_[i] * direction_[i] : 0;
  }
  return square;
}

void NearSets::Step(double length) {
  for (size_t i = 0; i < direction_.size(); ++i) {
    multipliers_[i] = std::max(0.0, multipliers_[i] + length * direction_[i]);
  }
}

double NearSets::Scale() const {
  return 2 * std::accumulate(multipliers_.begin(), multipliers_.end(), 0.0);
}

}  // namespace traverse

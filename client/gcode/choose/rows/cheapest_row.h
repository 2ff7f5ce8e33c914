// A shortest path through columns of choices.

#ifndef TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHEAPEST_ROW_H_
#define TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHEAPEST_ROW_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

namespace traverse::gcode {

// The row of choices, one of each column, with the lowest score.
class CheapestRow {
 public:
  // Adds a column of `count` choices. score(before, choice, up_to) is that of a row with `choice`
  // behind `before`, up to which it is `up_to`; may_follow(before, choice) is asked where that is
  // the lowest one yet. `before` is 0 for the first column. O(choices of both columns, multiplied).
  template <typename Score, typename MayFollow>
  void Extend(size_t count, Score score, MayFollow may_follow) {
    std::vector<double> scores(count, std::numeric_limits<double>::infinity());
    std::vector<uint32_t>& from = from_.emplace_back(count, 0);
    for (uint32_t choice = 0; choice < count; ++choice) {
      for (uint32_t before = 0; before < scores_.size(); ++before) {
        const double here = score(before, choice, scores_[before]);
        if (!(here < scores[choice]) || !may_follow(before, choice)) continue;
        scores[choice] = here;
        from[choice] = before;
      }
    }
    scores_ = std::move(scores);
  }

  // [column] its choice.
  std::vector<uint32_t> Choices() const {
    std::vector<uint32_t> row(from_.size());
    auto choice =
        static_cast<uint32_t>(std::min_element(scores_.begin(), scores_.end()) - scores_.begin());
    for (size_t column = row.size(); column-- > 0;) {
      row[column] = choice;
      choice = from_[column][choice];
    }
    return row;
  }

 private:
  std::vector<double> scores_ = {0};         // [choice of the last column] of the best row up to it
  std::vector<std::vector<uint32_t>> from_;  // [column][choice] the one before it in that row
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_CHOOSE_ROWS_CHEAPEST_ROW_H_

#include "engine/weller/milp/raster_milp.h"

#include <algorithm>
#include <cstddef>
#include <map>
#include <tuple>

#include "engine/cost/travel_cost.h"

namespace traverse {
namespace {

constexpr double kInfinity = MixedProgram::kInfinity;

// Ends are numbered 2 path + (0 or 1); First and Last have numbers of their own. Moves are numbered
// from 0 here.
class RasterModel {
 public:
  RasterModel(const LayerProblem& problem, const RasterGroups& groups, const Route& known)
      : problem_(problem),
        groups_(groups),
        rasters_(static_cast<int>(problem.plan->paths.size())),
        travel_(problem) {
    NoteGroupMoves(known);
    AddRanks();
    AddLinks();
    AddMoves();
    AddMoveRows();
    AddRankRows();
    for (int m = 0; m < rasters_; ++m) AddRasterRows(m);
    AddGroupRows();
  }

  const MixedProgram& program() const { return program_; }

  std::vector<double> ValuesOf(const Route& route) const {
    if (route.empty()) return {};
    std::vector<double> values(static_cast<size_t>(program_.column_count()));
    int last = kFirst;
    for (int kr = 0; kr < rasters_; ++kr) {
      const Visit& visit = route[static_cast<size_t>(kr)];
      const int enter = 2 * visit.path + visit.entry;
      const int exit = 2 * visit.path + 1 - visit.entry;
      Set(values, Move(last, enter, kr));
      Set(values, rank(enter, kr));
      Set(values, rank(exit, kr + 1));
      Set(values, between(visit.path, kr));
      last = exit;
    }
    Set(values, Move(last, kLast, rasters_));
    return values;
  }

  Route RouteOf(const std::vector<double>& values) const {
    Route route;
    for (int kr = 0; kr < rasters_ && !values.empty(); ++kr) {
      for (int m = 0; m < rasters_; ++m) {
        if (values[static_cast<size_t>(between(m, kr))] < 0.5) continue;
        const bool forward = values[static_cast<size_t>(rank(2 * m, kr))] > 0.5;
        route.push_back(Visit{m, forward ? 0 : 1});
      }
    }
    return route;
  }

 private:
  static constexpr int kFirst = -1;
  static constexpr int kLast = -2;

  struct MoveColumn {
    int p = 0;  // kFirst, or the smaller end
    int q = 0;  // kLast, or an end
    int kr = 0;
    int column = 0;
  };

  static void Set(std::vector<double>& values, int column) {
    values[static_cast<size_t>(column)] = 1;
  }

  int end_count() const { return 2 * rasters_; }
  int rank(int end, int kr) const { return ranks_[static_cast<size_t>(end * (rasters_ + 1) + kr)]; }
  int between(int raster, int kr) const {  // linkbn
    return betweens_[static_cast<size_t>(raster * rasters_ + kr)];
  }
  int group(int end) const { return groups_.group_of[static_cast<size_t>(end / 2)]; }
  Point at(int end) const {
    return problem_.plan->paths[static_cast<size_t>(end / 2)].points[static_cast<size_t>(end % 2)];
  }

  int Move(int p, int q, int kr) const {
    if (p >= 0 && q >= 0 && p > q) std::swap(p, q);
    return column_of_.at({p, q, kr});
  }

  void NoteGroupMoves(const Route& known) {
    int last = groups_.start_group;
    for (const Visit& visit : known) {
      const int next = groups_.group_of[static_cast<size_t>(visit.path)];
      extra_.push_back({last, next});
      last = next;
    }
  }

  bool MayFollow(int group, int other) const {
    if (group == other || groups_.linked == nullptr || group < 0) return true;
    if (groups_.linked->Linked(group, other)) return true;
    return std::any_of(extra_.begin(), extra_.end(), [&](const std::pair<int, int>& pair) {
      return pair == std::pair(group, other) || pair == std::pair(other, group);
    });
  }

  void AddRanks() {
    for (int end = 0; end < end_count(); ++end) {
      for (int kr = 0; kr <= rasters_; ++kr) ranks_.push_back(program_.AddBinary(0));
    }
  }

  void AddLinks() {
    for (int i = 0; i < rasters_ * rasters_; ++i) betweens_.push_back(program_.AddBinary(0));
  }

  void AddMove(int p, int q, int kr, double cost) {
    const MoveColumn move{p, q, kr, program_.AddBinary(cost)};
    moves_.push_back(move);
    column_of_[{p, q, kr}] = move.column;
  }

  void AddMoves() {
    for (int p = 0; p < end_count(); ++p) {
      if (MayFollow(groups_.start_group, group(p))) {
        AddMove(kFirst, p, 0, travel_(problem_.start, at(p)));
      }
      AddMove(p, kLast, rasters_, problem_.finish ? travel_(at(p), *problem_.finish) : 0);
      for (int q = p + 1; q < end_count(); ++q) {
        if (p / 2 == q / 2 || !MayFollow(group(p), group(q))) continue;
        for (int kr = 1; kr < rasters_; ++kr) AddMove(p, q, kr, travel_(at(p), at(q)));
      }
    }
  }

  void AddMoveRows() {
    std::vector<MixedProgram::Entries> of_end(static_cast<size_t>(end_count()));
    std::vector<MixedProgram::Entries> of_move(static_cast<size_t>(rasters_) + 1);
    std::vector<MixedProgram::Entries> of_both(static_cast<size_t>(end_count()) *
                                               (static_cast<size_t>(rasters_) + 1));
    for (const MoveColumn& move : moves_) {
      of_move[static_cast<size_t>(move.kr)].Add(move.column, 1);
      for (const int end : {move.p, move.q}) {
        if (end < 0) continue;
        of_end[static_cast<size_t>(end)].Add(move.column, 1);
        of_both[static_cast<size_t>(end * (rasters_ + 1) + move.kr)].Add(move.column, 1);
      }
    }
    for (const auto& row : of_end) program_.AddRow(1, 1, row);   // (4.15)
    for (const auto& row : of_move) program_.AddRow(1, 1, row);  // (4.17) to (4.21)
    for (int end = 0; end < end_count(); ++end) {                // (4.16)
      for (int kr = 0; kr <= rasters_; ++kr) {
        MixedProgram::Entries& row = of_both[static_cast<size_t>(end * (rasters_ + 1) + kr)];
        row.Add(rank(end, kr), -1);
        program_.AddRow(0, kInfinity, row);
      }
    }
  }

  void AddRankRows() {
    for (int kr = 0; kr <= rasters_; ++kr) {  // (4.22), with (4.24) and (4.25) put in
      MixedProgram::Entries row;
      for (int end = 0; end < end_count(); ++end) row.Add(rank(end, kr), 1);
      program_.AddRow(-kInfinity, kr == 0 || kr == rasters_ ? 1 : 2, row);
    }
    for (int end = 0; end < end_count(); ++end) {  // (4.23)
      MixedProgram::Entries row;
      for (int kr = 0; kr <= rasters_; ++kr) row.Add(rank(end, kr), 1);
      program_.AddRow(1, kInfinity, row);
    }
  }

  void AddRasterRows(int m) {
    for (int kr = 0; kr < rasters_; ++kr) {  // (4.26)
      MixedProgram::Entries row;
      row.Add(between(m, kr), 1);
      for (const int end : {2 * m, 2 * m + 1}) {
        row.Add(rank(end, kr), -1);
        row.Add(rank(end, kr + 1), -1);
      }
      program_.AddRow(-1, kInfinity, row);
    }
    for (const int end : {2 * m, 2 * m + 1}) {  // (4.27)
      for (int kr = 0; kr <= rasters_; ++kr) {
        MixedProgram::Entries row;
        if (kr < rasters_) row.Add(between(m, kr), 1);
        if (kr > 0) row.Add(between(m, kr - 1), 1);
        row.Add(rank(end, kr), -1);
        program_.AddRow(0, kInfinity, row);
      }
    }
    MixedProgram::Entries once;  // (4.28)
    for (int kr = 0; kr < rasters_; ++kr) once.Add(between(m, kr), 1);
    program_.AddRow(-kInfinity, 1, once);
    if (!problem_.plan->paths[static_cast<size_t>(m)].one_way) return;
    for (int kr = 0; kr < rasters_; ++kr) {
      MixedProgram::Entries row;
      row.Add(rank(2 * m, kr), 1);
      row.Add(between(m, kr), -1);
      program_.AddRow(0, 0, row);
    }
  }

  // A group's rasters are done together.
  void AddGroupRows() {
    std::map<int, int> rasters_in;
    for (const int group : groups_.group_of) ++rasters_in[group];
    for (const auto& [group_index, count] : rasters_in) {
      if (count == 1) continue;
      MixedProgram::Entries row;
      for (const MoveColumn& move : moves_) {
        if (move.p < 0 || move.q < 0) continue;
        if (group(move.p) == group_index && group(move.q) == group_index) row.Add(move.column, 1);
      }
      program_.AddRow(count - 1, count - 1, row);
    }
  }

  const LayerProblem& problem_;
  const RasterGroups& groups_;
  const int rasters_;
  const TravelCost travel_;
  std::vector<std::pair<int, int>> extra_;  // groups that count as neighbors
  MixedProgram program_;
  std::vector<int> ranks_;     // [end * (rasters_ + 1) + kr]
  std::vector<int> betweens_;  // [raster * rasters_ + kr]
  std::vector<MoveColumn> moves_;
  std::map<std::tuple<int, int, int>, int> column_of_;
};

}  // namespace

MilpRoute SolveRasterMilp(const LayerProblem& problem, const RasterGroups& groups,
                          const Route& known, const MilpOptions& options, Budget& budget) {
  const double rasters = static_cast<double>(problem.plan->paths.size());
  // Of these columns most are moves between islands, of which neighborhoods leave a part.
  if (rasters * rasters * rasters > options.most_columns_and_rows) return {};
  const RasterModel model(problem, groups, known);
  std::vector<double> values;
  MilpRoute found =
      SolveAndDescribe(model.program(), model.ValuesOf(known), options, budget, values);
  found.route = model.RouteOf(values);
  return found;
}

}  // namespace traverse

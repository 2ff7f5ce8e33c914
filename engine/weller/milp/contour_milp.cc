#include "engine/weller/milp/contour_milp.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/cost/travel_cost.h"

namespace traverse {
namespace {

constexpr double kInfinity = MixedProgram::kInfinity;

SymmetricRelation WithMovesOf(const Route& known, SymmetricRelation linked) {
  int from = linked.node_count() - 1;
  for (const Visit& visit : known) {
    linked.Link(from, visit.path);
    from = visit.path;
  }
  return linked;
}

// Columns and rows of the model, nearly.
double SizeOf(const Plan& plan, const SymmetricRelation& linked) {
  const double positions = linked.node_count();
  double pairs = 0;  // of points
  double apart = 0;  // pairs of contours
  for (size_t i = 0; i < plan.paths.size(); ++i) {
    const double points = static_cast<double>(plan.paths[i].points.size());
    pairs += points;
    for (size_t j = i + 1; j < plan.paths.size(); ++j) {
      if (linked.Linked(static_cast<int>(i), static_cast<int>(j))) {
        pairs += points * static_cast<double>(plan.paths[j].points.size());
      } else {
        ++apart;
      }
    }
  }
  return positions * (2 * pairs + apart + positions);
}

class ContourModel {
 public:
  ContourModel(const LayerProblem& problem, SymmetricRelation linked, const MilpOptions& options)
      : problem_(problem), linked_(std::move(linked)), positions_(linked_.node_count()) {
    for (const Path& path : problem.plan->paths) AddContour(path.points);
    AddContour({problem.start});
    AddRanks();
    AddPointRanks();
    AddLinks();
    for (int i = 0; i < positions_; ++i) {
      for (int j = i + 1; j < positions_; ++j) {
        for (int k = 0; k + 1 < positions_ && !linked_.Linked(i, j); ++k) KeepApart(i, j, k);
      }
    }
    if (options.strengthened) AddPositionRows();
  }

  const MixedProgram& program() const { return program_; }

  std::vector<double> ValuesOf(const Route& route) const {
    std::vector<double> values(static_cast<size_t>(program_.column_count()));
    if (route.empty()) return {};
    int last = first(positions_ - 1);
    Set(values, rank(positions_ - 1, 0));
    Set(values, point_rank(last, 0));
    for (int k = 1; k < positions_; ++k) {
      const Visit& visit = route[static_cast<size_t>(k - 1)];
      const int point = first(visit.path) + visit.entry;
      Set(values, rank(visit.path, k));
      Set(values, point_rank(point, k));
      for (const Link& link : links_) {
        if (link.position != k - 1) continue;
        const bool same =
            (link.p == last && link.q == point) || (link.p == point && link.q == last);
        if (same) Set(values, link.column);
      }
      last = point;
    }
    return values;
  }

  Route RouteOf(const std::vector<double>& values) const {
    Route route;
    for (int k = 1; k < positions_ && !values.empty(); ++k) {
      for (int p = 0; p < first(positions_ - 1); ++p) {
        const int column = point_rank(p, k);
        if (values[static_cast<size_t>(column)] < 0.5) continue;
        const int contour = contour_of_[static_cast<size_t>(p)];
        route.push_back(Visit{contour, p - first(contour)});
      }
    }
    return route;
  }

 private:
  struct Link {
    int p = 0;
    int q = 0;
    int position = 0;
    int column = 0;
  };

  static void Set(std::vector<double>& values, int column) {
    values[static_cast<size_t>(column)] = 1;
  }

  // Points of contour i are [first(i), first(i + 1)).
  int first(int contour) const { return first_[static_cast<size_t>(contour)]; }
  int point_count() const { return first_.back(); }

  // Columns; -1 for what cannot be: the origin has position 0, and nothing else has.
  int rank(int contour, int k) const {
    return ranks_[static_cast<size_t>(contour * positions_ + k)];
  }
  int point_rank(int point, int k) const {
    return point_ranks_[static_cast<size_t>(point * positions_ + k)];
  }

  void AddContour(const std::vector<Point>& points) {
    const int contour = static_cast<int>(first_.size()) - 1;
    points_.insert(points_.end(), points.begin(), points.end());
    contour_of_.insert(contour_of_.end(), points.size(), contour);
    first_.push_back(static_cast<int>(points_.size()));
  }

  bool IsPossible(int contour, int k) const { return (contour == positions_ - 1) == (k == 0); }

  void AddRanks() {
    for (int i = 0; i < positions_; ++i) {
      for (int k = 0; k < positions_; ++k) {
        ranks_.push_back(IsPossible(i, k) ? program_.AddBinary(0, k == 0) : -1);
      }
    }
    for (int k = 0; k < positions_; ++k) {  // (4.2)
      MixedProgram::Entries row;
      for (int i = 0; i < positions_; ++i) Add(row, rank(i, k), 1);
      program_.AddRow(1, 1, row);
    }
    for (int i = 0; i < positions_; ++i) {  // (4.3)
      MixedProgram::Entries row;
      for (int k = 0; k < positions_; ++k) Add(row, rank(i, k), 1);
      program_.AddRow(1, 1, row);
    }
  }

  void AddPointRanks() {
    for (int p = 0; p < point_count(); ++p) {
      for (int k = 0; k < positions_; ++k) {
        const bool possible = IsPossible(contour_of_[static_cast<size_t>(p)], k);
        point_ranks_.push_back(possible ? program_.AddBinary(0, k == 0) : -1);
      }
    }
    for (int i = 0; i < positions_; ++i) {  // (4.4)
      for (int k = 0; k < positions_; ++k) {
        if (!IsPossible(i, k)) continue;
        MixedProgram::Entries row;
        for (int p = first(i); p < first(i + 1); ++p) Add(row, point_rank(p, k), 1);
        Add(row, rank(i, k), -1);
        program_.AddRow(0, 0, row);
      }
    }
  }

  void AddLinks() {
    const TravelCost travel(problem_);
    // [p * positions + k]: links of p at k
    std::vector<MixedProgram::Entries> links_of(static_cast<size_t>(point_count()) *
                                                static_cast<size_t>(positions_));
    for (int i = 0; i < positions_; ++i) {
      for (int j = i + 1; j < positions_; ++j) {
        if (!linked_.Linked(i, j)) continue;
        const bool from_origin = j == positions_ - 1;
        for (int k = from_origin ? 0 : 1; k < (from_origin ? 1 : positions_ - 1); ++k) {
          for (int p = first(i); p < first(i + 1); ++p) {
            for (int q = first(j); q < first(j + 1); ++q) AddLink(p, q, k, travel, links_of);
          }
        }
      }
    }
    for (int p = 0; p < point_count(); ++p) {  // (4.6)
      for (int k = 0; k + 1 < positions_; ++k) {
        MixedProgram::Entries& row = links_of[static_cast<size_t>(p * positions_ + k)];
        if (row.indices.empty()) continue;
        Add(row, point_rank(p, k), -1);
        Add(row, point_rank(p, k + 1), -1);
        program_.AddRow(-kInfinity, 0, row);
      }
    }
  }

  void AddLink(int p, int q, int k, const TravelCost& travel,
               std::vector<MixedProgram::Entries>& links_of) {
    const double cost = travel(points_[static_cast<size_t>(p)], points_[static_cast<size_t>(q)]);
    const Link link{p, q, k, program_.AddBinary(cost)};
    links_.push_back(link);
    MixedProgram::Entries row;  // (4.5)
    row.Add(link.column, 1);
    for (const int point : {p, q}) {
      Add(row, point_rank(point, k), -1);
      Add(row, point_rank(point, k + 1), -1);
      links_of[static_cast<size_t>(point * positions_ + k)].Add(link.column, 1);
    }
    program_.AddRow(-1, kInfinity, row);
  }

  // (4.5) without a link.
  void KeepApart(int i, int j, int k) {
    MixedProgram::Entries row;
    for (const int contour : {i, j}) {
      Add(row, rank(contour, k), 1);
      Add(row, rank(contour, k + 1), 1);
    }
    program_.AddRow(-kInfinity, 1, row);
  }

  void AddPositionRows() {
    std::vector<MixedProgram::Entries> rows(static_cast<size_t>(positions_ - 1));
    for (const Link& link : links_) rows[static_cast<size_t>(link.position)].Add(link.column, 1);
    for (const MixedProgram::Entries& row : rows) program_.AddRow(1, 1, row);
  }

  static void Add(MixedProgram::Entries& row, int column, double value) {
    if (column >= 0) row.Add(column, value);
  }

  const LayerProblem& problem_;
  const SymmetricRelation linked_;
  const int positions_;  // as many as contours, the origin included
  std::vector<Point> points_;
  std::vector<int> contour_of_;   // [point]
  std::vector<int> first_ = {0};  // [contour], one more at the end
  MixedProgram program_;
  std::vector<int> ranks_;        // [contour * positions_ + k]
  std::vector<int> point_ranks_;  // [point * positions_ + k]
  std::vector<Link> links_;
};

}  // namespace

MilpRoute SolveAndDescribe(const MixedProgram& program, const std::vector<double>& known,
                           const MilpOptions& options, Budget& budget,
                           std::vector<double>& values) {
  const Stopwatch watch;
  MixedProgram::Result solved = program.Solve({options.gap}, known, budget);
  MilpRoute described;
  if (!known.empty()) described.start = program.ValueOf(known);
  described.value = solved.value;
  described.bound = solved.bound;
  described.complete = solved.complete;
  described.columns = program.column_count();
  described.rows = program.row_count();
  described.nodes = solved.nodes;
  described.seconds = watch.Seconds();
  described.incumbents = std::move(solved.incumbents);
  values = std::move(solved.values);
  return described;
}

MilpRoute SolveContourMilp(const LayerProblem& problem, const SymmetricRelation& linked,
                           const Route& known, const MilpOptions& options, Budget& budget) {
  SymmetricRelation with_known = WithMovesOf(known, linked);
  if (SizeOf(*problem.plan, with_known) > options.most_columns_and_rows) return {};
  const ContourModel model(problem, std::move(with_known), options);
  std::vector<double> values;
  MilpRoute found =
      SolveAndDescribe(model.program(), model.ValuesOf(known), options, budget, values);
  found.route = model.RouteOf(values);
  return found;
}

}  // namespace traverse

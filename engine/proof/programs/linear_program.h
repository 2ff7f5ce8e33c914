// A linear programme that grows and is solved again and again: the part of Clp that branch and cut
// needs, with nothing of Clp in a header.

#ifndef TRAVERSE_ENGINE_PROOF_PROGRAMS_LINEAR_PROGRAM_H_
#define TRAVERSE_ENGINE_PROOF_PROGRAMS_LINEAR_PROGRAM_H_

#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "engine/base/budget.h"

namespace traverse {

// min cost x, lower <= row x <= upper, x within the bounds of its columns. Not thread-safe, but
// different programmes share nothing.
class LinearProgram {
 public:
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  static constexpr int kNoLimit = std::numeric_limits<int>::max();

  enum class Status {
    kOptimal,
    kInfeasible,
    kStopped,  // budget or iterations ran out, or the numbers became unreliable
  };

  // Coefficients of one row or column.
  struct Entries {
    std::vector<int> indices;
    std::vector<double> values;
    void Add(int index, double value) {
      indices.push_back(index);
      values.push_back(value);
    }
  };

  LinearProgram();
  ~LinearProgram();
  LinearProgram(const LinearProgram&) = delete;
  LinearProgram& operator=(const LinearProgram&) = delete;

  int row_count() const;
  int column_count() const;

  // Return the index of the new row or column.
  int AddRow(double lower, double upper, const Entries& columns);
  int AddColumn(double cost, double lower, double upper, const Entries& rows);

  // Adds several at once, which is quicker: each call copies the matrix.
  struct Column {
    double cost = 0;
    double lower = 0;
    double upper = 0;
    Entries rows;
  };
  struct Row {
    double lower = 0;
    double upper = 0;
    Entries columns;
  };
  void AddColumns(const std::vector<Column>& columns);
  void AddRows(const std::vector<Row>& rows);

  void SetColumnBounds(int column, double lower, double upper);
  void SetRowBounds(int row, double lower, double upper);
  void SetCost(int column, double cost);

  // The entries after a deleted one move up. The arguments ascend.
  void DeleteRows(const std::vector<int>& rows);
  void DeleteColumns(const std::vector<int>& columns);

  // Starts from the last basis. Dual simplex is quick after changes of rows and bounds, primal
  // simplex after new columns and costs.
  Status SolveDual(Budget& budget, int most_iterations = kNoLimit);
  Status SolvePrimal(Budget& budget);

  // Starts without a basis. If a solve ended without an answer because rounding errors had added up
  // in its basis, this one may still find the answer.
  Status SolveAfresh(Budget& budget, int most_iterations = kNoLimit);

  // What all solves took: the sum of iterations times rows, to which time is about proportional.
  double work() const;

  // The value of the last solution.
  double value() const;
  double Primal(int column) const;
  double Dual(int row) const;
  bool RowIsBasic(int row) const;
  double ReducedCost(int column) const;  // of the cost, less what the duals make of its entries

  // A lower bound of the value from the last duals alone, whether or not these are optimal: with
  // multipliers y, sum of y x (the row bound that y pushes against) + sum over columns of the least
  // that (cost - y A) x can be. What is summed up is of the problem's size, so a double holds it to
  // a relative 1e-12. REQUIRES: all columns are bounded.
  double SafeBound() const;

  // Multipliers of rows that show, in the same way, that there is no feasible point: with them the
  // rows ask for more than the columns can give, by `margin` beyond what rounding may hide.
  struct Contradiction {
    std::vector<double> multipliers;
    double margin = 0;
  };

  // From the last solution's ray. Unset if that proves nothing.
  std::optional<Contradiction> FindContradiction() const;
  bool IsSurelyInfeasible() const { return FindContradiction().has_value(); }

  // The basis, usable for the same rows and columns.
  std::vector<unsigned char> Basis() const;
  void SetBasis(const std::vector<unsigned char>& basis);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_PROGRAMS_LINEAR_PROGRAM_H_

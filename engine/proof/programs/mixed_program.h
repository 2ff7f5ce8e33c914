// A mixed integer linear programme of binaries, solved by Cbc: the part that the models of the
// thesis need, with nothing of Cbc in a header.

#ifndef TRAVERSE_ENGINE_PROOF_PROGRAMS_MIXED_PROGRAM_H_
#define TRAVERSE_ENGINE_PROOF_PROGRAMS_MIXED_PROGRAM_H_

#include <memory>
#include <optional>
#include <vector>

#include "engine/base/budget.h"
#include "engine/proof/programs/linear_program.h"

namespace traverse {

// min cost x, lower <= row x <= upper, x binary. Not thread-safe, but different programmes share
// nothing.
class MixedProgram {
 public:
  using Entries = LinearProgram::Entries;
  static constexpr double kInfinity = LinearProgram::kInfinity;

  struct Options {
    double gap = 0;  // relative gap at which the search ends
  };

  // A solution better than all before it, and when it was found.
  struct Incumbent {
    double seconds = 0;  // since Solve began
    double value = 0;
  };

  struct Result {
    std::vector<double> values;  // [column] of the best solution, 0 or 1; empty if there is none
    double value = 0;            // of the best solution
    int nodes = 0;               // of branch and bound

    std::vector<Incumbent> incumbents;  // that Cbc found, without `known`

    // No solution costs less, according to Cbc (its tolerances are about 1e-7). Unset: unknown.
    std::optional<double> bound;

    // The gap was reached, or it is certain that there is no solution.
    bool complete = false;
  };

  MixedProgram();
  ~MixedProgram();
  MixedProgram(const MixedProgram&) = delete;
  MixedProgram& operator=(const MixedProgram&) = delete;

  // Return the index of the new column or row. A column may be fixed at 1.
  int AddBinary(double cost, bool fixed_at_one = false);
  int AddRow(double lower, double upper, const Entries& columns);

  int row_count() const;
  int column_count() const;

  double ValueOf(const std::vector<double>& values) const;

  // Whether `values` satisfies all rows.
  bool IsSolution(const std::vector<double>& values) const;

  // `known`, if not empty, is a solution to start from: the result is no worse. Deterministic
  // unless the budget ends it. Cbc checks the budget between two nodes and two cut generators, Clp
  // after every iteration within them; a factorization or a generator always runs to its end.
  Result Solve(const Options& options, const std::vector<double>& known, Budget& budget) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_PROGRAMS_MIXED_PROGRAM_H_

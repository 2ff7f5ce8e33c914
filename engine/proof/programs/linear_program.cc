#include "engine/proof/programs/linear_program.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <coin/ClpDualRowSteepest.hpp>
#include <coin/ClpEventHandler.hpp>
#include <coin/ClpSimplex.hpp>
#include <coin/CoinError.hpp>
#include <cstddef>
#include <cstring>
#include <utility>

namespace traverse {
namespace {

// Ends a solve once the budget has run out. Clp asks after every iteration.
class BudgetHandler : public ClpEventHandler {
 public:
  explicit BudgetHandler(Budget* budget) : budget_(budget) {}
  ClpEventHandler* clone() const override { return new BudgetHandler(*this); }
  int event(Event) override {
    constexpr int kGoOn = -1;
    constexpr int kStop = 3;
    return budget_ != nullptr && budget_->Exhausted() ? kStop : kGoOn;
  }

 private:
  Budget* budget_;
};

// Rows or columns one after the other, as Clp takes them.
struct Packed {
  std::vector<double> lower, upper, values;
  std::vector<CoinBigIndex> starts = {0};
  std::vector<int> indices;

  void Add(double least, double most, const LinearProgram::Entries& entries) {
    lower.push_back(std::max(least, -COIN_DBL_MAX));
    upper.push_back(std::min(most, COIN_DBL_MAX));
    indices.insert(indices.end(), entries.indices.begin(), entries.indices.end());
    values.insert(values.end(), entries.values.begin(), entries.values.end());
    starts.push_back(static_cast<CoinBigIndex>(indices.size()));
  }
};

}  // namespace

class LinearProgram::Impl {
 public:
  Impl() {
    simplex_.setLogLevel(0);
    simplex_.resize(0, 0);
    // Weights that are not known are not computed: rows come and go too often.
    constexpr int kPartialWeights = 2;
    ClpDualRowSteepest steepest(kPartialWeights);
    simplex_.setDualRowPivotAlgorithm(steepest);
  }

  // Clp throws where numbers go wrong.
  template <typename Method>
  Status Solve(Budget& budget, int most_iterations, const Method& method) {
    if (budget.ExhaustedNow()) return Status::kStopped;
    const BudgetHandler handler(&budget);
    simplex_.passInEventHandler(&handler);
    simplex_.setMaximumIterations(most_iterations);
    try {
      method(simplex_);
    } catch (const CoinError&) {
      return Status::kStopped;
    }
    work_ += static_cast<double>(simplex_.numberIterations()) * simplex_.numberRows();
    if (simplex_.status() == 0) return Status::kOptimal;
    return simplex_.status() == 1 ? Status::kInfeasible : Status::kStopped;
  }

  // cost - y A of a column.
  double Reduced(int column, const double* multipliers, double cost) const {
    const CoinPackedMatrix* matrix = simplex_.matrix();
    const CoinBigIndex begin = matrix->getVectorStarts()[column];
    const CoinBigIndex end = begin + matrix->getVectorLengths()[column];
    for (CoinBigIndex i = begin; i < end; ++i) {
      cost -= multipliers[matrix->getIndices()[i]] * matrix->getElements()[i];
    }
    return cost;
  }

  // The multipliers without those that push against a bound which is not there, and what they add
  // up to.
  double Clip(std::vector<double>& multipliers) const {
    double sum = 0;
    for (size_t i = 0; i < multipliers.size(); ++i) {
      double& y = multipliers[i];
      const double bound = y > 0 ? simplex_.rowLower()[i] : simplex_.rowUpper()[i];
      if (std::abs(bound) > kHuge) {
        y = 0;
      } else {
        sum += y * bound;
      }
    }
    return sum;
  }

  std::optional<Contradiction> ContradictionOf(const double* ray, double sign) const {
    std::vector<double> multipliers(static_cast<size_t>(simplex_.numberRows()));
    for (size_t i = 0; i < multipliers.size(); ++i) multipliers[i] = sign * ray[i];
    const double needed = Clip(multipliers);
    double most = 0;
    double scale = std::abs(needed);
    for (int j = 0; j < simplex_.numberColumns(); ++j) {
      const double z = -Reduced(j, multipliers.data(), 0);
      const double term = std::max(z * simplex_.columnLower()[j], z * simplex_.columnUpper()[j]);
      most += term;
      scale += std::abs(term);
    }
    const double margin = needed - 1e-7 * std::max(1.0, scale) - most;
    if (margin <= 0) return std::nullopt;
    return Contradiction{std::move(multipliers), margin};
  }

  static constexpr double kHuge = 1e29;
  ClpSimplex simplex_;
  double work_ = 0;
};

LinearProgram::LinearProgram() : impl_(std::make_unique<Impl>()) {}
LinearProgram::~LinearProgram() = default;

int LinearProgram::row_count() const { return impl_->simplex_.numberRows(); }
int LinearProgram::column_count() const { return impl_->simplex_.numberColumns(); }

int LinearProgram::AddRow(double lower, double upper, const Entries& columns) {
  AddRows({{lower, upper, columns}});
  return row_count() - 1;
}

int LinearProgram::AddColumn(double cost, double lower, double upper, const Entries& rows) {
  AddColumns({{cost, lower, upper, rows}});
  return column_count() - 1;
}

void LinearProgram::AddColumns(const std::vector<Column>& columns) {
  if (columns.empty()) return;
  Packed packed;
  std::vector<double> costs;
  for (const Column& it : columns) {
    packed.Add(it.lower, it.upper, it.rows);
    costs.push_back(it.cost);
  }
  impl_->simplex_.addColumns(static_cast<int>(columns.size()), packed.lower.data(),
                             packed.upper.data(), costs.data(), packed.starts.data(),
                             packed.indices.data(), packed.values.data());
}

void LinearProgram::AddRows(const std::vector<Row>& rows) {
  if (rows.empty()) return;
  Packed packed;
  for (const Row& it : rows) packed.Add(it.lower, it.upper, it.columns);
  impl_->simplex_.addRows(static_cast<int>(rows.size()), packed.lower.data(), packed.upper.data(),
                          packed.starts.data(), packed.indices.data(), packed.values.data());
}

void LinearProgram::SetColumnBounds(int column, double lower, double upper) {
  impl_->simplex_.setColumnBounds(column, lower, upper);
}

void LinearProgram::SetRowBounds(int row, double lower, double upper) {
  impl_->simplex_.setRowBounds(row, lower, upper);
}

void LinearProgram::SetCost(int column, double cost) {
  impl_->simplex_.setObjectiveCoefficient(column, cost);
}

void LinearProgram::DeleteRows(const std::vector<int>& rows) {
  impl_->simplex_.deleteRows(static_cast<int>(rows.size()), rows.data());
}

void LinearProgram::DeleteColumns(const std::vector<int>& columns) {
  impl_->simplex_.deleteColumns(static_cast<int>(columns.size()), columns.data());
}

LinearProgram::Status LinearProgram::SolveDual(Budget& budget, int most_iterations) {
  return impl_->Solve(budget, most_iterations, [](ClpSimplex& simplex) { simplex.dual(); });
}

LinearProgram::Status LinearProgram::SolvePrimal(Budget& budget) {
  return impl_->Solve(budget, kNoLimit, [](ClpSimplex& simplex) { simplex.primal(); });
}

LinearProgram::Status LinearProgram::SolveAfresh(Budget& budget, int most_iterations) {
  return impl_->Solve(budget, most_iterations, [](ClpSimplex& simplex) {
    simplex.allSlackBasis(/*resetSolution=*/true);
    simplex.dual();
  });
}

double LinearProgram::work() const { return impl_->work_; }
double LinearProgram::value() const { return impl_->simplex_.objectiveValue(); }
double LinearProgram::Primal(int column) const {
  return impl_->simplex_.primalColumnSolution()[column];
}
double LinearProgram::Dual(int row) const { return impl_->simplex_.dualRowSolution()[row]; }
bool LinearProgram::RowIsBasic(int row) const {
  return impl_->simplex_.getRowStatus(row) == ClpSimplex::basic;
}

double LinearProgram::ReducedCost(int column) const {
  return impl_->Reduced(column, impl_->simplex_.dualRowSolution(),
                        impl_->simplex_.getObjCoefficients()[column]);
}

double LinearProgram::SafeBound() const {
  const ClpSimplex& simplex = impl_->simplex_;
  std::vector<double> multipliers(simplex.dualRowSolution(),
                                  simplex.dualRowSolution() + row_count());
  double bound = impl_->Clip(multipliers);
  for (int j = 0; j < column_count(); ++j) {
    const double reduced = impl_->Reduced(j, multipliers.data(), simplex.getObjCoefficients()[j]);
    assert(simplex.columnLower()[j] > -COIN_DBL_MAX && simplex.columnUpper()[j] < COIN_DBL_MAX);
    bound += std::min(reduced * simplex.columnLower()[j], reduced * simplex.columnUpper()[j]);
  }
  return bound;
}

std::optional<LinearProgram::Contradiction> LinearProgram::FindContradiction() const {
  const std::unique_ptr<double[]> ray(impl_->simplex_.infeasibilityRay());
  if (ray == nullptr) return std::nullopt;
  std::optional<Contradiction> found = impl_->ContradictionOf(ray.get(), 1);
  return found ? std::move(found) : impl_->ContradictionOf(ray.get(), -1);
}

std::vector<unsigned char> LinearProgram::Basis() const {
  const unsigned char* status = impl_->simplex_.statusArray();
  if (status == nullptr) return {};
  return {status, status + row_count() + column_count()};
}

void LinearProgram::SetBasis(const std::vector<unsigned char>& basis) {
  if (!basis.empty()) impl_->simplex_.copyinStatus(basis.data());
}

}  // namespace traverse

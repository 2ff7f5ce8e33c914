#include "engine/proof/programs/mixed_program.h"

#include <algorithm>
#include <cmath>
#include <coin/CbcEventHandler.hpp>
#include <coin/CbcHeuristic.hpp>
#include <coin/CbcModel.hpp>
#include <coin/CbcStrategy.hpp>
#include <coin/CglCutGenerator.hpp>
#include <coin/CglGomory.hpp>
#include <coin/ClpEventHandler.hpp>
#include <coin/ClpPackedMatrix.hpp>
#include <coin/ClpSimplex.hpp>
#include <coin/CoinError.hpp>
#include <coin/CoinPackedMatrix.hpp>
#include <coin/OsiClpSolverInterface.hpp>
#include <cstddef>
#include <functional>
#include <optional>
#include <utility>

// clang-format off: it does not stand alone
#include <coin/CbcCutGenerator.hpp>
// clang-format on

namespace traverse {
namespace {

// What the handlers and the caller share. Cbc copies handlers along with models.
struct Watch {
  Budget* budget = nullptr;
  double bound = -MixedProgram::kInfinity;  // Cbc's, while nothing was cut short
  Stopwatch since_start;
  std::vector<MixedProgram::Incumbent> incumbents;
  std::vector<std::unique_ptr<ClpMatrixBase>> matrices;  // taken away; Cbc may still look at them

  void NoteSolution(double value) {
    constexpr double kSame = 1e-6;
    if (!incumbents.empty() && value > incumbents.back().value - kSame) return;
    incumbents.push_back({since_start.Seconds(), value});
  }
};

// Ends a linear programme within Cbc once the budget has run out.
class LinearWatcher : public ClpEventHandler {
 public:
  explicit LinearWatcher(Watch* watch) : watch_(watch) {}
  ClpEventHandler* clone() const override { return new LinearWatcher(*this); }
  int event(Event) override {
    constexpr int kGoOn = -1;
    constexpr int kStop = 3;
    return watch_->budget->ExhaustedNow() ? kStop : kGoOn;
  }

 private:
  Watch* watch_;
};

// Begins no linear programme any more once the budget has run out: to stop, Cbc begins several, and
// each is factorized before the handler above is asked. To Cbc all are then without a solution.
// What it still begins past this class, with Clp's own model, finds no matrix and ends at once.
class WatchedSolver : public OsiClpSolverInterface {
 public:
  explicit WatchedSolver(Watch* watch) : watch_(watch) {}
  OsiSolverInterface* clone(bool with_data = true) const override {
    return with_data ? new WatchedSolver(*this) : new WatchedSolver(watch_);
  }
  void initialSolve() override {
    if (!GivesUp()) OsiClpSolverInterface::initialSolve();
  }
  void resolve() override {
    if (!GivesUp()) OsiClpSolverInterface::resolve();
  }
  void markHotStart() override {
    marked_ = !GivesUp();
    if (marked_) OsiClpSolverInterface::markHotStart();
  }
  void solveFromHotStart() override {
    if (!GivesUp()) OsiClpSolverInterface::solveFromHotStart();
  }
  void unmarkHotStart() override {
    if (marked_) OsiClpSolverInterface::unmarkHotStart();
    GivesUp();
  }

 private:
  bool GivesUp() {
    if (!watch_->budget->ExhaustedNow()) return false;
    constexpr int kStoppedByHandler = 5;
    modelPtr_->setProblemStatus(kStoppedByHandler);
    if (emptied_) return true;
    CoinPackedMatrix none(true, 0, 0);
    none.setDimensions(getNumRows(), getNumCols());
    watch_->matrices.emplace_back(modelPtr_->clpMatrix());
    modelPtr_->replaceMatrix(new ClpPackedMatrix(none), /*deleteCurrent=*/false);
    emptied_ = true;
    return true;
  }

  Watch* watch_;
  bool marked_ = false;
  bool emptied_ = false;
};

// Ends the search itself. A linear programme that was ended means nothing to it, so the bound is
// kept from before.
class SearchWatcher : public CbcEventHandler {
 public:
  explicit SearchWatcher(Watch* watch) : watch_(watch) {}
  CbcEventHandler* clone() const override { return new SearchWatcher(*this); }
  CbcAction event(CbcEvent which) override {
    if (model_ != nullptr && model_->parentModel() == nullptr &&
        (which == solution || which == heuristicSolution)) {
      watch_->NoteSolution(model_->getObjValue());
    }
    if (watch_->budget->ExhaustedNow()) return stop;
    if (which == node && model_ != nullptr && model_->parentModel() == nullptr) {
      watch_->bound = std::max(watch_->bound, model_->getBestPossibleObjValue());
    }
    return noAction;
  }
  CbcAction event(CbcEvent which, void*) override { return event(which); }

 private:
  Watch* watch_;
};

// Stands between two cut generators, which are only asked for more in the middle of a round: once
// the budget has run out it switches off those that follow.
class CutWatcher : public CglCutGenerator {
 public:
  CutWatcher(Watch* watch, CbcModel* model) : watch_(watch), model_(model) {}
  CglCutGenerator* clone() const override { return new CutWatcher(*this); }
  void generateCuts(const OsiSolverInterface&, OsiCuts&, const CglTreeInfo) override {
    constexpr int kNever = -100;
    if (!watch_->budget->ExhaustedNow()) return;
    for (int g = 0; g < model_->numberCutGenerators(); ++g) {
      model_->cutGenerator(g)->setHowOften(kNever);
    }
  }

 private:
  Watch* watch_;
  CbcModel* model_;
};

// Gomory's cuts for the columns that are farthest from whole numbers. A cut takes time in
// proportion to the matrix, and one call of the generator cannot be ended.
class FewGomory : public CglGomory {
 public:
  explicit FewGomory(const CglGomory& usual)
      : CglGomory(usual),
        usual_away_(usual.getAway()),
        usual_away_at_root_(usual.getAwayAtRoot()) {}
  CglCutGenerator* clone() const override { return new FewGomory(*this); }
  void generateCuts(const OsiSolverInterface& solver, OsiCuts& cuts,
                    const CglTreeInfo info) override {
    const double away = LeastAway(solver);
    if (away >= kHalf) return;
    setAway(std::max(usual_away_, away));
    setAwayAtRoot(std::max(usual_away_at_root_, away));
    CglGomory::generateCuts(solver, cuts, info);
  }

 private:
  static constexpr double kHalf = 0.5;
  static constexpr double kMostWork = 1.5e6;  // numbers of the matrix, of some 10 ns each

  // So far from a whole number are only as many columns as there is time for.
  static double LeastAway(const OsiSolverInterface& solver) {
    const double of_cut = solver.getNumElements() + solver.getNumRows() + 1;
    const auto most = static_cast<size_t>(kMostWork / of_cut);
    std::vector<double> away;
    for (int c = 0; c < solver.getNumCols(); ++c) {
      const double x = solver.getColSolution()[c];
      away.push_back(std::abs(x - std::round(x)));
    }
    if (away.size() <= most) return 0;
    std::nth_element(away.begin(), away.begin() + static_cast<ptrdiff_t>(most), away.end(),
                     std::greater<>());
    return away[most];
  }

  double usual_away_;
  double usual_away_at_root_;
};

// Cbc's usual cuts and heuristics, with watchers between the cut generators.
class WatchedStrategy : public CbcStrategyDefault {
 public:
  explicit WatchedStrategy(Watch* watch) : CbcStrategyDefault(1, kStrong, 0, 0), watch_(watch) {}
  CbcStrategy* clone() const override { return new WatchedStrategy(*this); }
  void setupCutGenerators(CbcModel& model) override {
    CbcStrategyDefault::setupCutGenerators(model);
    const int usual = model.numberCutGenerators();
    const CutWatcher watcher(watch_, &model);
    for (int g = 0; g < usual; ++g) {
      CutWatcher between = watcher;
      model.addCutGenerator(&between, 1, "watcher");
      CbcCutGenerator& given = *model.cutGenerator(g);
      CglCutGenerator* generator = given.generator();
      std::optional<FewGomory> few;
      if (const auto* gomory = dynamic_cast<const CglGomory*>(generator)) {
        generator = &few.emplace(*gomory);
      }
      model.addCutGenerator(generator, given.howOften(), given.cutGeneratorName(), given.normal(),
                            given.atSolution(), given.whenInfeasible(), given.howOftenInSub(),
                            given.whatDepth(), given.whatDepthInSub());
      model.cutGenerator(g)->setHowOften(-100);  // its copy, behind the watcher, takes its place
    }
  }

 private:
  static constexpr int kStrong = 5;  // candidates of strong branching
  Watch* watch_;
};

// One call of a generator cannot be ended. With 15 524 columns and 116 749 rows probing takes 0.7 s
// and Gomory's cuts 0.4 s: large programmes do without.
void SetUp(CbcModel& model, Watch* watch) {
  constexpr int kMostColumnsToProbe = 10000;
  constexpr int kMostRowsToCut = 100000;
  constexpr int kAtRootOnly = -99;
  if (model.getNumCols() <= kMostColumnsToProbe) {
    WatchedStrategy strategy(watch);
    model.setStrategy(strategy);
    return;
  }
  FewGomory gomory{CglGomory()};
  if (model.getNumRows() <= kMostRowsToCut) model.addCutGenerator(&gomory, kAtRootOnly, "");
  CbcRounding rounding(model);
  model.addHeuristic(&rounding);
}

}  // namespace

class MixedProgram::Impl {
 public:
  void Load(OsiClpSolverInterface& solver) const {
    const int columns = static_cast<int>(costs.size());
    CoinPackedMatrix matrix(false, 0, 0);
    matrix.setDimensions(0, columns);
    matrix.appendRows(static_cast<int>(row_lower.size()), row_begin.data(), indices.data(),
                      values.data());
    const std::vector<double> upper(costs.size(), 1.0);
    solver.loadProblem(matrix, lower.data(), upper.data(), costs.data(), row_lower.data(),
                       row_upper.data());
    for (int column = 0; column < columns; ++column) solver.setInteger(column);
  }

  double ValueOf(const std::vector<double>& solution) const {
    double sum = 0;
    for (size_t c = 0; c < costs.size(); ++c) sum += costs[c] * solution[c];
    return sum;
  }

  std::vector<double> costs;  // [column]
  std::vector<double> lower;  // [column] 1 if it is fixed
  std::vector<double> row_lower;
  std::vector<double> row_upper;
  std::vector<CoinBigIndex> row_begin = {0};  // [row] into the two below, one more at the end
  std::vector<int> indices;
  std::vector<double> values;
};

MixedProgram::MixedProgram() : impl_(std::make_unique<Impl>()) {}
MixedProgram::~MixedProgram() = default;

int MixedProgram::AddBinary(double cost, bool fixed_at_one) {
  impl_->costs.push_back(cost);
  impl_->lower.push_back(fixed_at_one ? 1 : 0);
  return column_count() - 1;
}

int MixedProgram::AddRow(double lower, double upper, const Entries& columns) {
  impl_->row_lower.push_back(std::max(lower, -COIN_DBL_MAX));
  impl_->row_upper.push_back(std::min(upper, COIN_DBL_MAX));
  impl_->indices.insert(impl_->indices.end(), columns.indices.begin(), columns.indices.end());
  impl_->values.insert(impl_->values.end(), columns.values.begin(), columns.values.end());
  impl_->row_begin.push_back(static_cast<CoinBigIndex>(impl_->indices.size()));
  return row_count() - 1;
}

int MixedProgram::row_count() const { return static_cast<int>(impl_->row_lower.size()); }
int MixedProgram::column_count() const { return static_cast<int>(impl_->costs.size()); }

double MixedProgram::ValueOf(const std::vector<double>& values) const {
  return impl_->ValueOf(values);
}

bool MixedProgram::IsSolution(const std::vector<double>& values) const {
  constexpr double kRounding = 1e-6;
  if (values.size() != impl_->costs.size()) return false;
  for (size_t c = 0; c < values.size(); ++c) {
    if (values[c] < impl_->lower[c] || (values[c] != 0 && values[c] != 1)) return false;
  }
  for (size_t row = 0; row < impl_->row_lower.size(); ++row) {
    double sum = 0;
    for (CoinBigIndex i = impl_->row_begin[row]; i < impl_->row_begin[row + 1]; ++i) {
      const size_t at = static_cast<size_t>(i);
      sum += impl_->values[at] * values[static_cast<size_t>(impl_->indices[at])];
    }
    if (sum < impl_->row_lower[row] - kRounding || sum > impl_->row_upper[row] + kRounding) {
      return false;
    }
  }
  return true;
}

MixedProgram::Result MixedProgram::Solve(const Options& options, const std::vector<double>& known,
                                         Budget& budget) const {
  Result result;
  if (!known.empty()) {
    result.values = known;
    result.value = impl_->ValueOf(known);
  }
  if (budget.ExhaustedNow()) return result;
  Watch watch;
  watch.budget = &budget;
  WatchedSolver solver(&watch);
  solver.messageHandler()->setLogLevel(0);
  solver.getModelPtr()->setLogLevel(0);
  impl_->Load(solver);
  // In a large programme each of these steps copies the matrix several times.
  if (budget.ExhaustedNow()) return result;
  const LinearWatcher linear_watcher(&watch);
  solver.getModelPtr()->passInEventHandler(&linear_watcher);
  try {
    CbcModel model(solver);
    if (budget.ExhaustedNow()) return result;
    model.setLogLevel(0);
    const SearchWatcher search_watcher(&watch);
    model.passInEventHandler(&search_watcher);
    SetUp(model, &watch);
    if (budget.ExhaustedNow()) return result;
    model.setAllowableFractionGap(options.gap);
    if (!known.empty()) {
      model.setBestSolution(known.data(), column_count(), result.value, false);
    }
    model.branchAndBound();
    result.nodes = model.getNodeCount();
    if (const double* best = model.bestSolution(); best != nullptr) {
      std::vector<double> values(best, best + column_count());
      for (double& value : values) value = std::round(value);
      const double value = impl_->ValueOf(values);
      if (IsSolution(values) && (result.values.empty() || value < result.value)) {
        result.values = std::move(values);
        result.value = value;
      }
    }
    if (!budget.was_exhausted()) {
      result.complete = true;
      watch.bound = std::max(watch.bound, model.getBestPossibleObjValue());
    }
  } catch (const CoinError&) {
    budget.ExhaustedNow();
  }
  result.incumbents = std::move(watch.incumbents);
  if (watch.bound > -1e29 && watch.bound < 1e29) result.bound = watch.bound;
  return result;
}

}  // namespace traverse

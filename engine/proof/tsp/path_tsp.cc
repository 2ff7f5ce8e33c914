#include "engine/proof/tsp/path_tsp.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/proof/min_plus.h"
#include "engine/proof/tsp/tsp_choices.h"
#include "engine/proof/tsp/tsp_relaxation.h"

namespace traverse {
namespace {

constexpr size_t kFirstNeighbors = 4;  // moves of a port that the first programme has
constexpr int kMovesPerPricing = 500;
constexpr int kCutsPerRound = 100;
constexpr double kViolation = 0.01;
constexpr int kRoundsWithoutGainAtRoot = 20;
constexpr double kGain = 0.01;  // of the gap

// Moves are left out when the gap is below that share of the cost, and again each time it is below
// that share of what it was.
constexpr double kWidestGap = 0.1;
constexpr double kLessGap = 0.7;

constexpr double kRounding = 1e-9;  // relative to the cost; far above that of a bound

// How much is done in a node. Where the programme has many rows, each solve takes long.
struct Diligence {
  int rounds_without_gain;
  size_t strong_pairs;
  int strong_iterations;
};
constexpr Diligence kInSmall{4, 12, 100};
constexpr Diligence kInLarge{3, 8, 40};
constexpr int kLargeRows = 800;

}  // namespace

class PathTspSolver::Search {
 public:
  Search(PathTsp problem, int most_iterations)
      : problem_(std::move(problem)), relaxation_(problem_), most_iterations_(most_iterations) {
    std::vector<TspMove> moves;
    for (int p = 0; p < problem_.ports; ++p) {
      AddNearest(p, moves);
      moves.push_back({p, relaxation_.nodes().start()});
      moves.push_back({p, relaxation_.nodes().finish()});
    }
    // A path, however long, so that there is a solution whatever cuts come.
    for (int item = 2; item < relaxation_.nodes().item_count(); ++item) {
      const int to = relaxation_.nodes().first(item);
      moves.push_back({relaxation_.nodes().mate(relaxation_.nodes().first(item - 1)), to});
    }
    relaxation_.AddMoves(moves);
  }

  int port_count() const { return problem_.ports; }

  Result Solve(const std::vector<double>& start, double cutoff, const std::vector<int>& known,
               Budget& budget) {
    Begin(start, cutoff, budget);
    std::vector<TspMove> moves;
    for (size_t i = 0; i + 1 < known.size(); ++i) {
      const int from = problem_.mate[static_cast<size_t>(known[i])];
      const int to = known[i + 1];
      moves.push_back({std::min(from, to), std::max(from, to)});
    }
    relaxation_.AddMoves(moves);
    const double root = Root();
    if (!stopped_ && root < best_) {
      relaxation_.LeaveOutDear(Gap(), *budget_);
      open_.push_back(Node{{}, root});
      Explore();
    }
    double bound = std::min(best_, least_integral_);
    if (stopped_ && open_.empty()) bound = std::min(bound, root);
    for (const auto* nodes : {&open_, &failed_}) {
      for (const Node& node : *nodes) {
        if (node.bound < best_) stopped_ = true;
        bound = std::min(bound, node.bound);
      }
    }
    open_.clear();
    failed_.clear();
    result_.lower_bound = bound;
    result_.complete = !stopped_;
    return result_;
  }

  double RootBound(const std::vector<double>& start, double cutoff, Budget& budget,
                   double most_work) {
    Begin(start, cutoff, budget);
    most_work_ = lp().work() + most_work;
    return std::min(cutoff, Root());
  }

  int nodes() const { return nodes_; }
  int cuts() const { return relaxation_.total_cuts(); }

 private:
  using Status = LinearProgram::Status;
  struct Node {
    TspChoices fixed;
    double bound = 0;
  };

  LinearProgram& lp() { return relaxation_.lp(); }
  const Diligence& diligence() { return lp().row_count() > kLargeRows ? kInLarge : kInSmall; }

  void AddNearest(int port, std::vector<TspMove>& moves) const {
    std::vector<std::pair<double, int>> near;
    for (int q = 0; q < problem_.ports; ++q) {
      if (relaxation_.nodes().CanJoin(port, q)) near.emplace_back(problem_.Cost(port, q), q);
    }
    const size_t count = std::min(static_cast<size_t>(kFirstNeighbors), near.size());
    std::partial_sort(near.begin(), near.begin() + static_cast<ptrdiff_t>(count), near.end());
    for (size_t i = 0; i < count; ++i) {
      moves.push_back({std::min(port, near[i].second), std::max(port, near[i].second)});
    }
  }

  void Begin(const std::vector<double>& start, double cutoff, Budget& budget) {
    budget_ = &budget;
    result_ = Result();
    best_ = cutoff;
    most_work_ = kUnlimited;
    least_integral_ = kUnreached;
    stopped_ = false;
    // Far more than any path below the cutoff can pay.
    relaxation_.SetStart(start, 2 * std::abs(cutoff) + 1);
    applied_.clear();
    relaxation_.AllowAll();
  }

  // What a better path may cost above the bound of the duals that there are, and a little more.
  double Gap() const { return best_ - bound_now_ + kRounding * std::max(1.0, std::abs(best_)); }

  // The bound of the relaxation without branching.
  double Root() {
    double bound = 0;
    double last = 0;
    double gap = kWidestGap * best_;  // when moves were left out
    int without_gain = 0;
    while (true) {
      const Status status = SolveAndPrice(LinearProgram::kNoLimit);
      if (status == Status::kInfeasible) return best_;
      stopped_ = status != Status::kOptimal;
      if (stopped_) return bound;
      bound = std::max(bound, bound_now_);
      if (bound >= best_) return bound;
      TakeIntegral();  // cuts may be missing: goes on
      without_gain = bound > last + kGain * (best_ - bound) ? 0 : without_gain + 1;
      last = bound;
      if (without_gain > kRoundsWithoutGainAtRoot || lp().work() > most_work_) return bound;
      if (Gap() < kLessGap * gap) {
        gap = Gap();
        relaxation_.LeaveOutDear(gap, *budget_);
      }
      relaxation_.DropIdleCuts();
      if (relaxation_.Separate(kViolation, kCutsPerRound, *budget_) == 0) return bound;
    }
  }

  // Tries again without the basis unless there is an optimum, or surely no point.
  Status SolveSurely(int most_iterations) {
    const Status status = lp().SolveDual(*budget_, most_iterations);
    if (status == Status::kOptimal) return status;
    if (status == Status::kInfeasible && lp().IsSurelyInfeasible()) return status;
    return lp().SolveAfresh(*budget_, most_iterations);
  }

  // Solves with all the moves that the relaxation wants, or until its bound is high enough. What it
  // says, and bound_now_, hold for all moves that are not excluded.
  Status SolveAndPrice(int most_iterations) {
    Status status = SolveSurely(most_iterations);
    while (true) {
      if (status == Status::kInfeasible) {
        const int added = relaxation_.PriceInfeasible(kMovesPerPricing, *budget_);
        if (added < 0 || budget_->was_exhausted()) return Status::kStopped;
        if (added == 0) return Status::kInfeasible;
        status = SolveSurely(most_iterations);
        continue;
      }
      if (status != Status::kOptimal) return status;
      double missing = 0;
      const double bound = lp().SafeBound();
      const int added = relaxation_.Price(kMovesPerPricing, missing, *budget_);
      if (budget_->was_exhausted()) return Status::kStopped;
      bound_now_ = bound + missing;
      if (added == 0 || bound_now_ >= best_) return Status::kOptimal;
      status = lp().SolvePrimal(*budget_);
      if (status != Status::kOptimal) status = lp().SolveAfresh(*budget_, most_iterations);
    }
  }

  // True if the last solution is a path: the best one there is within its node.
  bool TakeIntegral() {
    const std::vector<int> path = relaxation_.IntegralPath();
    if (path.empty()) return false;
    double cost =
        problem_.finish[static_cast<size_t>(problem_.mate[static_cast<size_t>(path.back())])];
    cost += relaxation_.MoveCost({path.front(), relaxation_.nodes().start()});
    for (size_t i = 0; i + 1 < path.size(); ++i) {
      cost += problem_.Cost(problem_.mate[static_cast<size_t>(path[i])], path[i + 1]);
    }
    if (cost >= best_) return true;
    best_ = cost;
    result_.path = path;
    result_.cost = cost;
    return true;
  }

  // Nodes that failed are tried again, among other cuts.
  void Explore() {
    ExploreOpen();
    if (stopped_) return;
    open_ = std::exchange(failed_, {});
    ExploreOpen();
  }

  void ExploreOpen() {
    while (!open_.empty()) {
      if (open_.back().bound >= best_) {
        open_.pop_back();
        TakeLowest();
        continue;
      }
      Node node = open_.back();
      Apply(node);
      ++nodes_;
      const bool done = Process(node);
      if (stopped_) return;
      open_.pop_back();
      if (done || !Branch(node)) TakeLowest();
    }
  }

  // Puts the node of the lowest bound on top.
  void TakeLowest() {
    if (open_.empty()) return;
    const auto lowest = std::min_element(
        open_.begin(), open_.end(), [](const Node& a, const Node& b) { return a.bound < b.bound; });
    std::swap(*lowest, open_.back());
  }

  void ReleaseAll() {
    for (const auto& [choice, in] : applied_) Free(choice, relaxation_);
    applied_.clear();
  }

  void Apply(const Node& node) {
    ReleaseAll();
    applied_ = node.fixed;
    HoldPairsOf(applied_, {}, relaxation_);
    for (const auto& [choice, in] : applied_) Fix(choice, in, relaxation_);
  }

  // Solves and cuts; true if nothing better than best_ can be left in the node, or it failed.
  bool Process(Node& node) {
    int without_gain = 0;
    while (true) {
      const Status status = SolveAndPrice(most_iterations_);
      if (status == Status::kInfeasible) return true;
      if (status != Status::kOptimal) {
        stopped_ = budget_->ExhaustedNow();
        if (!stopped_) failed_.push_back(node);
        return true;
      }
      const double bound = bound_now_;
      without_gain = bound > node.bound + kGain * (best_ - bound) ? 0 : without_gain + 1;
      node.bound = std::max(node.bound, bound);
      if (node.bound >= best_) return true;
      if (without_gain > diligence().rounds_without_gain) break;
      relaxation_.DropIdleCuts();
      if (relaxation_.Separate(kViolation, kCutsPerRound, *budget_) == 0) break;
    }
    if (!TakeIntegral()) return node.bound >= best_;
    least_integral_ = std::min(least_integral_, node.bound);
    return true;
  }

  // Both ways of the choice that promises the most, the better one on top. False if there is none,
  // so that the node failed.
  bool Branch(const Node& node) {
    const std::vector<TspChoice> choices =
        OpenChoices(relaxation_, applied_, diligence().strong_pairs);
    if (choices.empty()) {
      // Integral but no path, and no cut found at this violation: rounding.
      failed_.push_back(node);
      return false;
    }
    const int iterations = diligence().strong_iterations;
    HoldPairsOf(applied_, choices, relaxation_);
    const std::vector<unsigned char> basis = lp().Basis();
    const double value = lp().value();
    TspChoice chosen = choices.front();
    double best_score = -1;
    bool in_first = true;
    for (const TspChoice& choice : choices) {
      double gain[2];
      for (const bool in : {false, true}) {
        Fix(choice, in, relaxation_);
        const Status status = lp().SolveDual(*budget_, iterations);
        gain[in ? 1 : 0] = status == Status::kInfeasible
                               ? best_ - value
                               : std::clamp(lp().value() - value, 0.0, best_ - value);
        Free(choice, relaxation_);
        lp().SetBasis(basis);
      }
      const double score = std::max(gain[0], 1e-6) * std::max(gain[1], 1e-6);
      if (score > best_score) {
        best_score = score;
        chosen = choice;
        in_first = gain[1] <= gain[0];
      }
    }
    for (const bool in : {!in_first, in_first}) {
      Node child = node;
      child.fixed.emplace_back(chosen, in);
      open_.push_back(std::move(child));
    }
    return true;
  }

  const PathTsp problem_;
  TspRelaxation relaxation_;
  Budget* budget_ = nullptr;
  Result result_;
  double least_integral_ = 0;      // bound of the nodes that ended with a path
  double best_ = 0;                // nothing from here up is of interest
  double most_work_ = kUnlimited;  // of the programmes, where the root alone is solved
  double bound_now_ = 0;           // of the last solution at the root
  const int most_iterations_;
  std::vector<Node> open_;
  std::vector<Node> failed_;  // whose programmes could not be solved
  TspChoices applied_;
  bool stopped_ = false;
  int nodes_ = 0;
};

PathTspSolver::PathTspSolver(PathTsp problem, int most_iterations)
    : search_(std::make_unique<Search>(std::move(problem), most_iterations)) {
  assert(search_->port_count() >= 2);
}
PathTspSolver::~PathTspSolver() = default;

PathTspSolver::Result PathTspSolver::Solve(const std::vector<double>& start, double cutoff,
                                           const std::vector<int>& known, Budget& budget) {
  return search_->Solve(start, cutoff, known, budget);
}
double PathTspSolver::RootBound(const std::vector<double>& start, double cutoff, Budget& budget,
                                double most_work) {
  return search_->RootBound(start, cutoff, budget, most_work);
}
int PathTspSolver::nodes() const { return search_->nodes(); }
int PathTspSolver::cuts() const { return search_->cuts(); }

}  // namespace traverse

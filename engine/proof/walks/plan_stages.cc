#include "engine/proof/walks/plan_stages.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "engine/base/rest.h"
#include "engine/model/tree/plan_tree.h"

namespace traverse {
namespace {

// The items of a node, and which of them may come first and last.
struct Block {
  int first = 0;  // its items are [first, last)
  int last = 0;
  absl::InlinedVector<int, 1> begins;
  absl::InlinedVector<int, 1> ends;
};

// All pairs of blocks that follow from `before`, those through children without paths included:
// [i][j]. O(blocks / 64 (children + pairs)).
std::vector<std::vector<char>> Closure(const Precedence& before, size_t blocks) {
  std::vector<std::vector<char>> closure(blocks, std::vector<char>(blocks));
  for (size_t first = 0; first < blocks && !before.empty(); first += 64) {
    const std::vector<uint64_t> slots = before.SlotsBefore(static_cast<int>(first));
    for (size_t i = first; i < std::min(blocks, first + 64); ++i) {
      for (size_t j = 0; j < blocks; ++j) closure[i][j] = (slots[j] >> (i - first) & 1) != 0;
    }
  }
  return closure;
}

// One stage of everything below one node.
class StageBuilder {
 public:
  explicit StageBuilder(const PlanTree& tree) : tree_(tree) {}

  PlanStage Build(int root) {
    const Block whole = Add(root);
    const size_t n = stage_.paths.size();
    stage_.follows.assign(n * n, 0);
    for (const auto& [i, j] : follows_) {
      stage_.follows[static_cast<size_t>(i) * n + static_cast<size_t>(j)] = 1;
    }
    stage_.begins.assign(n, 0);
    stage_.ends.assign(n, 0);
    for (const int item : whole.begins) stage_.begins[static_cast<size_t>(item)] = 1;
    for (const int item : whole.ends) stage_.ends[static_cast<size_t>(item)] = 1;
    return std::move(stage_);
  }

 private:
  int NewItem(int path) {
    stage_.paths.push_back(path);
    return stage_.size() - 1;
  }

  // The items of a node that has paths.
  Block Add(int index) {
    if (tree_.is_leaf(index)) {
      const int item = NewItem(tree_.node(index).path);
      return Block{item, item + 1, {item}, {item}};
    }
    const absl::Span<const int> children = tree_.children(index);
    if (children.size() == 1) return Add(children.front());
    const bool in_order = tree_.node(index).kind == PlanNode::Kind::kInOrder;
    return in_order ? AddInOrder(children) : AddAnyOrder(index);
  }

  Block AddInOrder(absl::Span<const int> children) {
    Block whole = Add(children.front());
    for (const int child : children.subspan(1)) {
      Block block = Add(child);
      Join(whole, block);
      Precede(whole, block);
      whole.last = block.last;
      whole.ends = std::move(block.ends);
    }
    return whole;
  }

  Block AddAnyOrder(int index) {
    std::vector<Block> blocks;
    for (const int child : tree_.children(index)) blocks.push_back(WithGate(Add(child)));
    const auto before = Closure(tree_.precedence(index), blocks.size());
    Block whole{blocks.front().first, blocks.back().last, {}, {}};
    for (size_t a = 0; a < blocks.size(); ++a) {
      bool begins = true;
      bool ends = true;
      for (size_t b = 0; b < blocks.size(); ++b) {
        begins = begins && before[b][a] == 0;
        ends = ends && before[a][b] == 0;
        if (before[a][b] != 0) Precede(blocks[a], blocks[b]);
        if (MayFollow(before, a, b)) Join(blocks[a], blocks[b]);
      }
      if (begins) Append(blocks[a].begins, whole.begins);
      if (ends) Append(blocks[a].ends, whole.ends);
    }
    return whole;
  }

  // Whether block b may come right after block a.
  static bool MayFollow(const std::vector<std::vector<char>>& before, size_t a, size_t b) {
    if (a == b || before[b][a] != 0) return false;
    if (before[a][b] == 0) return true;
    for (size_t between = 0; between < before.size(); ++between) {
      if (before[a][between] != 0 && before[between][b] != 0) return false;
    }
    return true;
  }

  // A block that could be entered more than once, and left more than once, gets a gate.
  Block WithGate(Block block) {
    if (block.begins.size() == 1 || block.ends.size() == 1) return block;
    const int gate = NewItem(PlanStage::kGate);
    stage_.gates.push_back({gate, block.first, block.last});
    const Block front{gate, gate + 1, {gate}, {gate}};
    Join(front, block);
    Precede(front, block);
    return Block{block.first, gate + 1, {gate}, std::move(block.ends)};
  }

  void Join(const Block& a, const Block& b) {
    for (const int i : a.ends) {
      for (const int j : b.begins) follows_.emplace_back(i, j);
    }
  }

  void Precede(const Block& a, const Block& b) {
    for (int i = a.first; i < a.last; ++i) {
      for (int j = b.first; j < b.last; ++j) stage_.before.emplace_back(i, j);
    }
  }

  static void Append(const absl::InlinedVector<int, 1>& items, absl::InlinedVector<int, 1>& to) {
    to.insert(to.end(), items.begin(), items.end());
  }

  const PlanTree& tree_;
  PlanStage stage_;
  std::vector<std::pair<int, int>> follows_;
};

// What a stage of one path takes, as Rest counts steps: its lists are allocated.
constexpr size_t kStepsOfStage = 64;

// Appends the stages below `index`, which has paths. False if one is too large, or the budget ends.
bool Collect(const PlanTree& tree, int index, size_t most_items, Rest& rest,
             std::deque<PlanStage>& stages) {
  if (!rest(kStepsOfStage)) return false;
  const absl::Span<const int> children = tree.children(index);
  if (children.size() == 1) return Collect(tree, children.front(), most_items, rest, stages);
  if (!tree.is_leaf(index) && tree.node(index).kind == PlanNode::Kind::kInOrder) {
    return std::all_of(children.begin(), children.end(),
                       [&](int child) { return Collect(tree, child, most_items, rest, stages); });
  }
  if (static_cast<size_t>(tree.path_count(index)) > most_items) return false;
  stages.push_back(StageBuilder(tree).Build(index));
  return stages.back().paths.size() <= most_items;
}

}  // namespace

std::optional<std::deque<PlanStage>> StagesOf(const Plan& plan, size_t most_items, Budget* budget) {
  std::deque<PlanStage> stages;
  if (plan.paths.empty()) return stages;
  Rest rest(budget);
  if (!Collect(PlanTree(plan, budget), 0, most_items, rest, stages)) return std::nullopt;
  return stages;
}

}  // namespace traverse

#include "tests/client/gcode/support/random_order.h"

#include <vector>

#include "client/gcode/model/outline.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/write/layer_writer.h"

namespace traverse::gcode::testing {
namespace {

class Shuffler {
 public:
  Shuffler(const Layer& layer, const v1::Plan& plan, Rng& rng)
      : layer_(layer), plan_(plan), rng_(rng) {}

  LayerOrder Shuffle() {
    Visit(0);
    return order_;
  }

 private:
  void Visit(uint32_t index) {
    const v1::PlanNode& node = plan_.nodes(static_cast<int>(index));
    if (node.has_path()) {
      order_.push_back(Place(node.path()));
    } else if (node.has_in_order()) {
      for (const uint32_t child : node.in_order().children()) Visit(child);
    } else {
      VisitAnyOrder(node.any_order());
    }
  }

  // Again and again one of the children for which nothing has to wait.
  void VisitAnyOrder(const v1::AnyOrder& any) {
    const auto n = static_cast<size_t>(any.children_size());
    std::vector<int> waits_for(n);
    std::vector<std::vector<uint32_t>> later(n);
    for (const v1::Precedence& pair : any.before()) {
      ++waits_for[pair.second()];
      later[pair.first()].push_back(pair.second());
    }
    std::vector<uint32_t> ready;
    for (uint32_t i = 0; i < n; ++i) {
      if (waits_for[i] == 0) ready.push_back(i);
    }
    while (!ready.empty()) {
      const uint32_t at = rng_.Below(static_cast<uint32_t>(ready.size()));
      const uint32_t child = ready[at];
      ready[at] = ready.back();
      ready.pop_back();
      Visit(any.children(static_cast<int>(child)));
      for (const uint32_t next : later[child]) {
        if (--waits_for[next] == 0) ready.push_back(next);
      }
    }
  }

  Placement Place(uint32_t path) {
    const v1::PlanPath& planned = plan_.paths(static_cast<int>(path));
    Placement placement{layer_.first_block + path, 0, planned.has_contour()};
    if (planned.has_open_path()) {
      placement.entry = planned.open_path().one_way() ? 0 : rng_.Below(2);
    } else if (planned.contour().entries_size() > 0) {
      const auto n = static_cast<uint32_t>(planned.contour().entries_size());
      placement.entry = planned.contour().entries(static_cast<int>(rng_.Below(n)));
    } else {
      placement.entry = rng_.Below(static_cast<uint32_t>(planned.contour().points_size() / 2));
    }
    return placement;
  }

  const Layer& layer_;
  const v1::Plan& plan_;
  Rng& rng_;
  LayerOrder order_;
};

}  // namespace

LayerOrder RandomOrder(const Layer& layer, const v1::Plan& plan, Rng& rng) {
  return Shuffler(layer, plan, rng).Shuffle();
}

std::string Shuffled(const GcodeFile& file, Policy policy, uint64_t seed) {
  Rng rng(seed);
  const RetractionHabit habit = LearnRetraction(file);
  const LinkDonors donors(file);
  const Block& first = file.blocks.front();
  PartStart at{StateAt(file, first), file.states[first.state_in]};
  std::string out = file.text.substr(0, first.begin);
  Placement before;
  for (const Layer& layer : file.layers) {
    const LayerWriter writer(file, layer, habit, donors);
    const LayerOrder order = RandomOrder(layer, MakeLayerPlan(file, layer, policy).plan, rng);
    if (layer.first_block > 0) at = writer.WriteTravel(before, order.front(), at, out);
    at = writer.WritePaths(order, at, out);
    before = order.back();
  }
  GcodeOut foot(file, at, out);
  const Block& last = file.blocks.back();
  const PartStart behind = StartBehind(file, last);
  foot.Copy({last.end, static_cast<Offset>(file.text.size()), behind, behind});
  return out;
}

}  // namespace traverse::gcode::testing

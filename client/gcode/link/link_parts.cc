#include "client/gcode/link/link_parts.h"

namespace traverse::gcode {

void LinkParts::MakeRoom(size_t more) {
  kept_ += more;
  if (kept_ <= kMostKept) return;
  links_.clear();
  models_.clear();
  paths_.clear();
  ends_.clear();
  kept_ = more;
}

std::shared_ptr<const Link> LinkParts::LinkTo(uint32_t block) {
  const auto found = links_.find(block);
  if (found != links_.end()) return found->second;
  auto link = std::make_shared<const Link>(ReadLink(file_, block));
  MakeRoom(link->steps.size() + 1);
  return links_.emplace(block, std::move(link)).first->second;
}

std::shared_ptr<const Link> LinkParts::ModelOf(uint32_t block) {
  const auto found = models_.find(block);
  if (found != models_.end()) return found->second;
  std::shared_ptr<const Link> link = LinkTo(block);
  if (link->fixed == 0) {
    const auto model = std::make_shared<Link>(*link);
    model->steps.clear();
    for (size_t i = 0; i < link->steps.size(); ++i) {
      const StepKind kind = link->steps[i].kind;
      const bool arrives = static_cast<int>(i) == link->arrival;
      if (arrives) model->arrival = static_cast<int>(model->steps.size());
      if (arrives || (kind != StepKind::kTravel && kind != StepKind::kComment)) {
        model->steps.push_back(link->steps[i]);
      }
    }
    model->steps.shrink_to_fit();
    link = model;
  }
  MakeRoom(link->steps.size() + 1);
  return models_.emplace(block, std::move(link)).first->second;
}

std::shared_ptr<const PlacedPath> LinkParts::PathOf(const Placement& placement) {
  const Key key(placement.block, placement.entry);
  const auto found = paths_.find(key);
  if (found != paths_.end()) return found->second;
  auto path = std::make_shared<const PlacedPath>(file_, placement);
  MakeRoom(path->body().segments.size() + 1);
  return paths_.emplace(key, std::move(path)).first->second;
}

std::shared_ptr<const PathEnds> LinkParts::EndsOf(const Placement& placement) {
  const Key key(placement.block, placement.entry);
  const auto found = ends_.find(key);
  if (found != ends_.end()) return found->second;
  auto ends = std::make_shared<const PathEnds>(file_, *PathOf(placement));
  MakeRoom(ends->first().moves.size() + ends->last().moves.size() + 1);
  return ends_.emplace(key, std::move(ends)).first->second;
}

}  // namespace traverse::gcode

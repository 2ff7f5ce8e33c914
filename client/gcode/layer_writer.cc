#include "client/gcode/layer_writer.h"

#include <algorithm>
#include <optional>

#include "client/gcode/link_writer.h"
#include "client/gcode/loops.h"
#include "client/gcode/outline.h"

namespace traverse::gcode {
namespace {

bool AsGiven(const GcodeFile& file, const Layer& layer, const LayerOrder& order,
             const Placement* before, const PartStart& start) {
  for (size_t i = 0; i < order.size(); ++i) {
    if (order[i].block != layer.first_block + i || !order[i].as_given()) return false;
  }
  if (before == nullptr) return true;
  if (before->block + 1 != layer.first_block || !before->as_given()) return false;
  const Block& block = file.blocks[before->block];
  return start.machine.RelativeE() || start.machine.e == block.e_out;
}

// One layer under construction.
class LayerDraft {
 public:
  LayerDraft(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
             const LinkDonors& donors, const PartStart& start, WrittenLayer& written)
      : file_(file),
        layer_(layer),
        outlines_(OutlinesOf(file, layer)),
        rules_(file, layer, habit, outlines_),
        written_(written),
        out_(file, start, written.text),
        links_(file, donors, out_) {}

  void Write(const LayerOrder& order, const Placement* before) {
    progress_ = std::lower_bound(file_.progress.begin(), file_.progress.end(),
                                 file_.blocks[layer_.first_block].begin);
    std::optional<PlacedPath> from;
    if (before != nullptr) from.emplace(file_, *before);
    for (size_t i = 0; i < order.size(); ++i) {
      PlacedPath to(file_, order[i]);
      const auto place = static_cast<uint32_t>(layer_.first_block + i);
      if (from) WriteLink(*from, to, place);
      if (i == 0) written_.first_path = written_.text.size();
      to.Write(true, out_);
      WriteProgress(file_.blocks[place].end);
      from.emplace(std::move(to));
    }
  }

  const PartStart& behind() const { return out_.at; }

 private:
  // `place` is the block that stands here in the file.
  void WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place) {
    const bool boundary = (file_.blocks[place].link & (kLinkSplits | kLinkFixed)) != 0;
    LinkRequest request;
    request.from = &from;
    request.to = &to;
    if (boundary) request.boundary = place;
    request.without_progress = !boundary;
    request.retract = Retracts(from, to);
    links_.Write(request);
    if (boundary) SkipProgress(file_.blocks[place].begin);
  }

  bool Retracts(const PlacedPath& from, const PlacedPath& to) const {
    const double unit = file_.modes[to.block().mode].inches ? 25.4 : 1;
    const auto vertex = [unit](const Position& at) {
      return Vertex{ToDouble(at.x) * unit, ToDouble(at.y) * unit};
    };
    const Outline& outline = outlines_[to.placement().block - layer_.first_block];
    return rules_.Retracts(vertex(from.last()), vertex(to.first()), outline.feature);
  }

  // The M73 lines of the file up to `offset` that were not yet written: as far as the file has
  // them behind as many paths. What a boundary has of them stays in it.
  void WriteProgress(Offset offset) {
    for (; progress_ != file_.progress.end() && *progress_ < offset; ++progress_) {
      out_.Raw(LineAt(file_.text, *progress_).Raw(file_.text));
    }
  }
  void SkipProgress(Offset offset) {
    while (progress_ != file_.progress.end() && *progress_ < offset) ++progress_;
  }

  const GcodeFile& file_;
  const Layer& layer_;
  const std::vector<Outline> outlines_;
  const TravelRules rules_;
  WrittenLayer& written_;
  GcodeOut out_;
  LinkWriter links_;
  std::vector<Offset>::const_iterator progress_;
};

}  // namespace

LayerOrder GivenOrder(const GcodeFile& file, const Layer& layer) {
  LayerOrder order;
  for (uint32_t b = layer.first_block; b < layer.end_block; ++b) {
    order.push_back({b, 0, OutlineOf(file, file.blocks[b]).closed});
  }
  return order;
}

WrittenLayer LayerWriter::Write(const Layer& layer, const LayerOrder& order,
                                const Placement* before, const PartStart& start) const {
  WrittenLayer written;
  written.as_given = AsGiven(file_, layer, order, before, start);
  if (written.as_given) {
    const Offset begin =
        layer.first_block == 0 ? file_.blocks[0].begin : file_.blocks[layer.first_block - 1].end;
    const Block& last = file_.blocks[layer.end_block - 1];
    written.text = file_.text.substr(begin, last.end - begin);
    written.behind = StartBehind(file_, last);
    return written;
  }
  LayerDraft draft(file_, layer, habit_, donors_, start, written);
  draft.Write(order, before);
  written.behind = draft.behind();
  return written;
}

}  // namespace traverse::gcode

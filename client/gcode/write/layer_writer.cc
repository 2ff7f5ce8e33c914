#include "client/gcode/write/layer_writer.h"

#include <algorithm>
#include <utility>

#include "client/gcode/link/composer.h"
#include "client/gcode/link/label_lines.h"
#include "client/gcode/write/path_writer.h"
#include "client/gcode/write/progress_lines.h"

namespace traverse::gcode {

PartStart StartOfPaths(const GcodeFile& file, const Placement& first) {
  const PlacedPath path(file, first);
  PartStart start{StateAt(file, path.block()), path.state()};
  start.machine.at = path.first();
  // Unknown where the path states it itself.
  start.machine.feed = path.states_feed() ? -1 : path.feed();
  return start;
}

LayerWriter::LayerWriter(const GcodeFile& file, const Layer& layer, const RetractionHabit& habit,
                         const LinkDonors& donors, const Room* room, bool hides,
                         const TravelModel* travel)
    : file_(file),
      layer_(layer),
      donors_(donors),
      links_(file, layer, habit, donors, room, hides, travel) {}

LayerOrder LayerWriter::GivenOrder() const {
  LayerOrder order;
  order.reserve(outlines().size());
  for (size_t i = 0; i < outlines().size(); ++i) {
    order.push_back({static_cast<uint32_t>(layer_.first_block + i), 0, outlines()[i].closed});
  }
  return order;
}

std::vector<uint32_t> LayerWriter::PlacesOf(const LayerOrder& order) const {
  const auto object_of = [this](const Placement& path) { return file_.blocks[path.block].object; };
  std::vector<uint32_t> begins;  // [object of the file's layer] its first place
  for (uint32_t b = layer_.first_block; b < layer_.end_block; ++b) {
    const bool goes_on =
        b > layer_.first_block && file_.blocks[b].object == file_.blocks[b - 1].object;
    if (!goes_on) begins.push_back(b - layer_.first_block);
  }
  std::vector<uint32_t> places;
  size_t objects = 0;
  uint32_t begin = 0;  // in the file, of the object that is here
  size_t here = 0;     // where it begins
  for (size_t i = 0; i < order.size(); ++i) {
    const bool goes_on = i > 0 && object_of(order[i]) == object_of(order[i - 1]);
    if (!goes_on) {
      begin = ObjectBegin(file_, order[i].block) - layer_.first_block;
      places.push_back(objects < begins.size() ? begins[objects] : static_cast<uint32_t>(i));
      here = i;
      ++objects;
    } else {
      places.push_back(begin + static_cast<uint32_t>(i - here));
    }
  }
  return places;
}

bool LayerWriter::MovesObjects(const LayerOrder& order, const std::vector<uint32_t>& places) const {
  for (size_t i = 0; i < order.size(); ++i) {
    const Block& given = file_.blocks[layer_.first_block + places[i]];
    if (file_.blocks[order[i].block].object != given.object) return true;
  }
  return false;
}

PartStart LayerWriter::WriteTravel(const Placement& before, const Placement& first,
                                   const PartStart& start, std::string& text) const {
  GcodeOut out(file_, start, text);
  LinkParts parts(file_);
  WriteLink(PlacedPath(file_, before), PlacedPath(file_, first), layer_.first_block, true, false,
            parts, out);
  out.Flush();
  return out.at;
}

PartStart LayerWriter::WritePaths(const LayerOrder& order, const PartStart& start,
                                  std::string& text, std::vector<size_t>* ends,
                                  bool as_sliced) const {
  if (StaysAsText(order, start, as_sliced)) {
    return WriteBarePaths(order, start, text, nullptr, as_sliced);
  }
  std::string bare;
  std::vector<size_t> marks;
  const PartStart behind = WriteBarePaths(order, start, bare, &marks, as_sliced);
  InsertProgressLines(file_, layer_, MovesObjects(order, PlacesOf(order)), bare, start, marks,
                      text);
  for (size_t i = 1; ends != nullptr && i < marks.size(); i += 2) ends->push_back(marks[i]);
  return behind;
}

bool LayerWriter::StaysAsText(const LayerOrder& order, const PartStart& start,
                              bool as_sliced) const {
  const bool same_e =
      start.machine.RelativeE() || start.machine.e == file_.blocks[layer_.first_block].e_in;
  return same_e && IsGiven(order) && (as_sliced || !links_.ChangesGiven());
}

PartStart LayerWriter::WriteBarePaths(const LayerOrder& order, const PartStart& start,
                                      std::string& text, std::vector<size_t>* marks,
                                      bool as_sliced) const {
  as_sliced = IsGiven(order) && (as_sliced || !links_.ChangesGiven());
  if (StaysAsText(order, start, as_sliced)) {
    const Block& last = file_.blocks[layer_.end_block - 1];
    const Offset begin = file_.blocks[layer_.first_block].begin;
    for (const size_t mark : marks != nullptr ? PathMarks(file_, layer_) : std::vector<size_t>{}) {
      marks->push_back(text.size() + mark);
    }
    text.append(file_.text, begin, last.end - begin);
    return StartBehind(file_, last);
  }
  // About as much as in the file.
  const size_t bytes =
      file_.blocks[layer_.end_block - 1].end - file_.blocks[layer_.first_block].begin;
  text.reserve(text.size() + bytes + bytes / 16);
  GcodeOut out(file_, start, text);
  PlacedPath from(file_, order.front());
  const std::vector<uint32_t> places = PlacesOf(order);
  const bool moved = MovesObjects(order, places);
  LinkParts parts(file_);
  for (size_t i = 0; i < order.size(); ++i) {
    if (i > 0) {
      PlacedPath to(file_, order[i]);
      WriteLink(from, to, layer_.first_block + places[i], as_sliced, moved, parts, out);
      from = std::move(to);
    }
    if (marks != nullptr) marks->push_back(text.size());
    WritePath(from, out);
    if (marks != nullptr) marks->push_back(text.size());
  }
  out.Flush();
  return out.at;
}

bool LayerWriter::IsGiven(const LayerOrder& order) const {
  for (size_t i = 0; i < order.size(); ++i) {
    if (order[i].block != layer_.first_block + i || !order[i].as_given()) return false;
  }
  return true;
}

// `place` is the block that stands here in the file. `moved`: objects of the layer have changed
// places, so that lines of progress stand by the time, between objects too.
void LayerWriter::WriteLink(const PlacedPath& from, const PlacedPath& to, uint32_t place,
                            bool as_sliced, bool moved, LinkParts& parts, GcodeOut& out) const {
  // Two objects that still follow each other keep what stands between them, if it is of no other
  // use there than what stands in this place.
  const uint32_t own = to.placement().block;
  const bool neighbors = from.placement().block + 1 == own && from.as_given() && to.as_given();
  if (own != place && neighbors && SaysLabelsOnly(file_, own) && SaysLabelsOnly(file_, place)) {
    place = own;
  }
  const Point end = file_.modes[to.block().mode].InMm(from.last());
  LinkForm form = links_.FormOf(from.placement(), end, to.placement(), place);
  links_.Hide(from.placement(), to.placement(), as_sliced ? Hiding::kNone : Hiding::kBent, form);
  form.without_progress = !form.boundary || moved;
  out.Print(LinkComposer(parts, donors_, from, to, form, out.at.machine).Compose());
}

}  // namespace traverse::gcode

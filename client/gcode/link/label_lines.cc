#include "client/gcode/link/label_lines.h"

#include <algorithm>

#include "client/gcode/dialects/label.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

Label LabelOfStep(const GcodeFile& file, const LinkStep& step) {
  if (step.kind != StepKind::kLabel) return {};
  return LabelOf(TrimBlanks(step.line.Text(file.text)));
}

// What the lines `steps` of `link` begin with; nothing if some of them stand among those that stay.
std::vector<std::string_view> Notations(const GcodeFile& file, const Link& link,
                                        const std::vector<size_t>& steps, bool& stays) {
  std::vector<std::string_view> notations;
  for (const size_t i : steps) {
    stays = stays || i < link.fixed;
    notations.push_back(LabelOfStep(file, link.steps[i]).notation);
  }
  return notations;
}

bool Alike(const GcodeFile& file, uint32_t one, uint32_t other, bool begins) {
  if (one == other) return true;
  const Link link = ReadLink(file, one);
  const Link other_link = ReadLink(file, other);
  const LabelLines lines = LabelLinesOf(file, link);
  const LabelLines others = LabelLinesOf(file, other_link);
  bool stays = false;
  const auto mine = Notations(file, link, begins ? lines.begins : lines.ends, stays);
  const auto theirs = Notations(file, other_link, begins ? others.begins : others.ends, stays);
  for (const LabelLines& found : {lines, others}) {
    stays = stays || (begins ? found.apart_in_behind : found.apart_in_before);
  }
  return !stays && mine == theirs && (!begins || !mine.empty());
}

}  // namespace

LabelLines LabelLinesOf(const GcodeFile& file, const Link& link) {
  LabelLines lines;
  bool begun = false;
  bool at_begin = false;       // nothing but such lines stands between this step and a label
  std::vector<size_t> beside;  // such lines directly before this step
  bool* apart = &lines.apart_in_before;  // in what this step stands; null: in no object
  const auto leave = [&] {
    for (const size_t i : beside) {
      if (apart != nullptr && link.steps[i].kind == StepKind::kStay) *apart = true;
    }
    beside.clear();
  };
  for (size_t i = 0; i < link.steps.size(); ++i) {
    const StepKind kind = link.steps[i].kind;
    if (kind == StepKind::kBlank || kind == StepKind::kComment || kind == StepKind::kSlot) continue;
    if (kind == StepKind::kStay || kind == StepKind::kSays) {
      (at_begin ? lines.begins : beside).push_back(i);
      continue;
    }
    const Label label = LabelOfStep(file, link.steps[i]);
    if (label.kind == LabelKind::kEnds && !begun && label.named) {
      lines.ends.insert(lines.ends.end(), beside.begin(), beside.end());
      lines.ends.push_back(i);
      beside.clear();
    }
    leave();
    at_begin = label.kind == LabelKind::kBegins;
    if (at_begin) {
      begun = true;
      lines.begins.push_back(i);
      apart = &lines.apart_in_behind;
    } else if (label.kind == LabelKind::kEnds || kind == StepKind::kLayerMark) {
      if (label.kind == LabelKind::kEnds) lines.begins.clear();
      apart = nullptr;
    }
  }
  leave();
  return lines;
}

uint32_t ObjectBegin(const GcodeFile& file, uint32_t block) {
  const uint32_t object = file.blocks[block].object;
  while (block > 0 && (file.blocks[block].link & kLinkNewLayer) == 0 &&
         file.blocks[block - 1].object == object) {
    --block;
  }
  return block;
}

uint32_t ObjectEnd(const GcodeFile& file, uint32_t block) {
  const uint32_t object = file.blocks[block].object;
  do {
    ++block;
  } while (block < file.blocks.size() && (file.blocks[block].link & kLinkNewLayer) == 0 &&
           file.blocks[block].object == object);
  return block;
}

ExchangedLabels::ExchangedLabels(const GcodeFile& file, const Link& link, uint32_t place,
                                 uint32_t from, uint32_t to)
    : file_(file), link_(link), lines_(LabelLinesOf(file, link)), other_(link.steps.size()) {
  if (file.blocks[place - 1].object != file.blocks[from].object) {
    Exchange(ObjectEnd(file, from), false);
  }
  if (file.blocks[place].object != file.blocks[to].object) Exchange(ObjectBegin(file, to), true);
}

void ExchangedLabels::Exchange(uint32_t other, bool begins) {
  if (other >= file_.blocks.size()) return;
  const Link link = ReadLink(file_, other);
  const LabelLines lines = LabelLinesOf(file_, link);
  const std::vector<size_t>& theirs = begins ? lines.begins : lines.ends;
  const std::vector<size_t>& mine = begins ? lines_.begins : lines_.ends;
  for (size_t k = 0; k < std::min(mine.size(), theirs.size()); ++k) {
    other_[mine[k]] = link.steps[theirs[k]].line.Raw(file_.text);
  }
}

std::string_view ExchangedLabels::LineOf(size_t i) const {
  return other_[i].empty() ? link_.steps[i].line.Raw(file_.text) : other_[i];
}

bool SaysLabelsOnly(const GcodeFile& file, uint32_t block) {
  const Link link = ReadLink(file, block);
  return link.fixed == 0 &&
         std::none_of(link.steps.begin(), link.steps.end(), [](const LinkStep& step) {
           return step.kind == StepKind::kStay || step.kind == StepKind::kSays ||
                  step.kind == StepKind::kComment || step.kind == StepKind::kLayerMark;
         });
}

bool BeginsAlike(const GcodeFile& file, uint32_t one, uint32_t other) {
  return Alike(file, one, other, true);
}

bool EndsAlike(const GcodeFile& file, uint32_t one, uint32_t other) {
  return Alike(file, one, other, false);
}

}  // namespace traverse::gcode

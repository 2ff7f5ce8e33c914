#include "client/gcode/link/label_lines.h"

#include <algorithm>
#include <optional>

#include "client/gcode/dialects/label.h"
#include "client/gcode/text/text.h"

namespace traverse::gcode {
namespace {

Label LabelOfStep(const GcodeFile& file, const LinkStep& step) {
  if (step.kind != StepKind::kLabel) return {};
  return LabelOf(TrimBlanks(step.line.Text(file.text)));
}

// Steps of a link that name an object, and messages and the like that stand right beside these,
// within the object.
struct ObjectLines {
  std::vector<size_t> steps;
  bool apart = false;  // something that stays stands within the object, but not beside its label
};

struct LabelLines {
  ObjectLines before;  // they end the object before, ahead of all that begin one
  ObjectLines behind;  // they begin the object behind, after all that end one
};

using Side = ObjectLines LabelLines::*;

LabelLines LabelLinesOf(const GcodeFile& file, const Link& link) {
  LabelLines lines;
  bool begun = false;
  bool at_begin = false;              // nothing but such lines stands between this step and a label
  std::vector<size_t> beside;         // such lines directly before this step
  bool* apart = &lines.before.apart;  // in what this step stands; null: in no object
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
      (at_begin ? lines.behind.steps : beside).push_back(i);
      continue;
    }
    const Label label = LabelOfStep(file, link.steps[i]);
    if (label.kind == LabelKind::kEnds && !begun && label.named) {
      lines.before.steps.insert(lines.before.steps.end(), beside.begin(), beside.end());
      lines.before.steps.push_back(i);
      beside.clear();
    }
    leave();
    at_begin = label.kind == LabelKind::kBegins;
    if (at_begin) {
      begun = true;
      lines.behind.steps.push_back(i);
      apart = &lines.behind.apart;
    } else if (label.kind == LabelKind::kEnds || kind == StepKind::kLayerMark) {
      if (label.kind == LabelKind::kEnds) lines.behind.steps.clear();
      apart = nullptr;
    }
  }
  leave();
  return lines;
}

// What the lines of one side of the link before block `block` begin with; unset if some of them, or
// something apart from them, stay.
std::optional<std::vector<std::string_view>> NotationsOf(const GcodeFile& file, uint32_t block,
                                                         Side side) {
  const Link link = ReadLink(file, block);
  const ObjectLines lines = LabelLinesOf(file, link).*side;
  std::vector<std::string_view> notations;
  bool stays = lines.apart;
  for (const size_t i : lines.steps) {
    stays = stays || i < link.fixed;
    notations.push_back(LabelOfStep(file, link.steps[i]).notation);
  }
  if (stays) return std::nullopt;
  return notations;
}

// The first block behind the object that `block` is of.
uint32_t ObjectEnd(const GcodeFile& file, uint32_t block) {
  const uint32_t object = file.blocks[block].object;
  do {
    ++block;
  } while (block < file.blocks.size() && (file.blocks[block].link & kLinkNewLayer) == 0 &&
           file.blocks[block].object == object);
  return block;
}

}  // namespace

uint32_t ObjectBegin(const GcodeFile& file, uint32_t block) {
  const uint32_t object = file.blocks[block].object;
  while (block > 0 && (file.blocks[block].link & kLinkNewLayer) == 0 &&
         file.blocks[block - 1].object == object) {
    --block;
  }
  return block;
}

std::vector<std::string_view> LabelledLines(const GcodeFile& file, const Link& link, uint32_t place,
                                            uint32_t from, uint32_t to) {
  std::vector<std::string_view> lines;
  for (const LinkStep& step : link.steps) lines.push_back(step.line.Raw(file.text));
  const auto exchange = [&](uint32_t other, Side side) {
    if (other >= file.blocks.size()) return;
    const Link other_link = ReadLink(file, other);
    const std::vector<size_t> mine = (LabelLinesOf(file, link).*side).steps;
    const std::vector<size_t> theirs = (LabelLinesOf(file, other_link).*side).steps;
    for (size_t k = 0; k < std::min(mine.size(), theirs.size()); ++k) {
      lines[mine[k]] = other_link.steps[theirs[k]].line.Raw(file.text);
    }
  };
  if (file.blocks[place - 1].object != file.blocks[from].object) {
    exchange(ObjectEnd(file, from), &LabelLines::before);
  }
  if (file.blocks[place].object != file.blocks[to].object) {
    exchange(ObjectBegin(file, to), &LabelLines::behind);
  }
  return lines;
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
  if (one == other) return true;
  const auto notations = NotationsOf(file, one, &LabelLines::behind);
  return notations && !notations->empty() &&
         notations == NotationsOf(file, other, &LabelLines::behind);
}

bool EndsAlike(const GcodeFile& file, uint32_t one, uint32_t other) {
  if (one == other) return true;
  const auto notations = NotationsOf(file, one, &LabelLines::before);
  return notations && notations == NotationsOf(file, other, &LabelLines::before);
}

}  // namespace traverse::gcode

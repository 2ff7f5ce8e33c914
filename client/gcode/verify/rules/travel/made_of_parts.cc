// New travel is made of parts that the original has: it leaves a path, travels and arrives as
// travel of the layer does that takes such steps, or else as travel of the print does. So it
// retracts, waits, rises, goes down and primes in an order, at speeds, to heights and by amounts
// of the original's. Travel may be cut into parts in any way that makes it so.

#include <algorithm>
#include <cstdlib>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/link_parts.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

using Parts = std::vector<LinkPart>;

// Of all moves of a link, one after the other.
uint64_t DigestOf(const TraceChunk& chunk, uint32_t link) {
  uint64_t digest = 0;
  for (const TraceMove& move : chunk.MovesOf(link)) digest = Mix(digest, move.identity);
  return digest;
}

// The gap of a loop that begins elsewhere belongs to the loop, and is crossed as fast as that, or
// what follows it, is printed.
bool CrossesGap(const TraceChunk& chunk, uint32_t link) {
  if (link == 0 || chunk.MovesOf(link).empty()) return false;
  const TraceMove& move = chunk.MovesOf(link).front();
  const bool slow = move.feed == chunk.paths[link - 1].feed ||
                    (link < chunk.paths.size() && move.feed == chunk.paths[link].feed);
  return move.kind == MoveKind::kTravel && move.open && slow &&
         move.length_mm() <= LoopGapMm(chunk, link - 1);
}

// What a layer of the original has.
struct LayerParts {
  KnownParts all;
  KnownParts level;  // of travel within the layer
  absl::flat_hash_set<Micro> tail_feeds;
  absl::flat_hash_set<uint64_t> whole;  // DigestOf its links

  // Layers may do the same at speeds and heights of their own, as first layers do.
  bool HasOwn(const LinkPart& part, bool is_level) const {
    if (part.role == LinkPart::kSpeed) {
      return part.steps[0].kind == MoveKind::kTravel && all.HasLike(part) &&
             !tail_feeds.contains(part.steps[0].feed);
    }
    const bool measured =
        std::ranges::any_of(part.steps, [](const PartStep& step) { return step.length_mm > 0; });
    return is_level && !measured && level.HasLike(part);
  }
};

// Which of the parts of a link the layer does not have: one list for each way to cut the link that
// the layer allows. Of travel from the start script only the speeds count.
std::vector<Parts> Missing(const LayerParts& had, const LinkCutter& link, bool from_script) {
  std::vector<Parts> cuts;
  for (Parts& parts : link.AllParts()) {
    std::erase_if(parts, [&](const LinkPart& part) {
      return had.all.Has(part) || (from_script && part.role != LinkPart::kSpeed);
    });
    const bool own = std::ranges::any_of(
        parts, [&](const LinkPart& part) { return had.HasOwn(part, link.level()); });
    if (!own) cuts.push_back(std::move(parts));
  }
  return cuts;
}

// For people.
std::string NameOf(const LinkPart& part) {
  std::string words;
  for (const PartStep& step : part.steps) {
    absl::StrAppend(&words, words.empty() ? "" : ", ", std::string(MoveKindName(step.kind)));
    const bool standing = step.kind == MoveKind::kRetraction || step.kind == MoveKind::kPriming;
    if (standing && step.filament != 0) {
      absl::StrAppendFormat(&words, " of %.4f mm",
                            static_cast<double>(std::abs(step.filament)) * kMicro);
    }
  }
  constexpr const char* kRoles[] = {"leaves by", "goes at the speed of", "arrives by"};
  return absl::StrCat(kRoles[part.role], " ", words);
}

void CheckLink(const LayerPair& layer, const LayerParts& had, const LinkCutter& cutter,
               uint32_t link, Observations& seen) {
  std::vector<Parts> missing =
      Missing(had, cutter, layer.index() == 0 && link == layer.first_path_is());
  const bool none = std::ranges::any_of(missing, [](const Parts& parts) { return parts.empty(); });
  if (none) return;
  const uint32_t line = layer.is().MovesOf(link).front().line;
  Parts own = cutter.Parts();
  std::erase_if(own, [&had](const LinkPart& part) { return had.all.Has(part); });
  const std::string what = own.empty() ? "" : NameOf(own[0]);
  seen.new_links.push_back({std::move(missing), what, {line, layer.index()}});
}

}  // namespace

void ObserveParts(const LayerPair& layer, LayerFindings& findings) {
  LayerParts had;
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    had.whole.insert(DigestOf(layer.was(), link));
    const uint32_t tail = layer.Side(true).TailOf(link);
    for (const TraceMove& move : layer.was().MovesOf(link).first(tail)) {
      had.tail_feeds.insert(move.feed);
    }
    const LinkCutter cutter(layer.was(), link, tail);
    const bool level = cutter.level() && !layer.was().links[link].new_layer;
    for (const LinkPart& part : cutter.Parts()) {
      had.all.Add(part);
      if (level) had.level.Add(part);
    }
  }
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    // At unknown lines every step is that of the original there: scripted_travel.cc.
    if (layer.is().links[link].scripted || had.whole.contains(DigestOf(layer.is(), link))) continue;
    const uint32_t gap = CrossesGap(layer.is(), link) ? 1 : 0;
    const uint32_t skipped = std::max(layer.Side(false).TailOf(link), gap);
    const LinkCutter cutter(layer.is(), link, skipped, &layer);
    CheckLink(layer, had, cutter, link, findings.is);
  }
  findings.was.parts = std::move(had.all);
}

void ObserveLastParts(const LayerPair& layer, LayerFindings& findings) {
  const auto was = static_cast<uint32_t>(layer.was().paths.size());
  const auto is = static_cast<uint32_t>(layer.is().paths.size());
  if (DigestOf(layer.was(), was) == DigestOf(layer.is(), is)) return;
  LayerParts had;
  for (const LinkPart& part : LinkCutter(layer.was(), was, 0).Parts()) had.all.Add(part);
  const LinkCutter cutter(layer.is(), is, layer.Side(false).TailOf(is), &layer);
  CheckLink(layer, had, cutter, is, findings.is);
}

void CompareParts(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const UnprovenLink& link : is.new_links) {
    const auto known = [&was](const LinkPart& part) { return was.parts.Has(part); };
    const bool fine = std::ranges::any_of(
        link.missing, [&](const Parts& parts) { return std::ranges::all_of(parts, known); });
    if (fine) continue;
    breaks.push_back({VerifyRule::kMadeOfParts, 0, link.at,
                      absl::StrCat(link.what, "; no such travel of the original does so")});
  }
}

}  // namespace traverse::gcode

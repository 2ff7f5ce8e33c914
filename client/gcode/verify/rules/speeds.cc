// Feed rate and acceleration of each travel, wipe, lift and retraction are those of the same kind
// of move within the print.

#include <algorithm>
#include <array>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/tails.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

// Unretracted travel is a kind of its own, after those of MoveKind.
constexpr auto kOpenTravel = static_cast<size_t>(MoveKind::kCount);

size_t KindOf(const TraceMove& move) {
  return move.kind == MoveKind::kTravel && move.open ? kOpenTravel : static_cast<size_t>(move.kind);
}

std::string KindName(size_t kind) {
  return std::string(kind == kOpenTravel ? "unretracted travel"
                                         : MoveKindName(static_cast<MoveKind>(kind)));
}

void Note(absl::flat_hash_map<uint64_t, Seen>& map, uint64_t key, const TraceMove& move,
          int64_t layer) {
  Seen& seen = NoteSeen(map, key, move.line, layer);
  if (move.sideways()) {
    seen.longest_mm = std::max(seen.longest_mm, static_cast<float>(move.length_mm()));
  }
}

// Moves along a path without filament, at another speed than the path. `only_new`: except those of
// the original in this layer.
void ObserveTail(const LayerPair& layer, const TraceChunk& chunk, uint32_t link, uint32_t moves,
                 bool only_new, Observations& seen) {
  if (link == 0) return;
  for (uint32_t m = chunk.links[link].first_move; m < chunk.links[link].first_move + moves; ++m) {
    const TraceMove& move = chunk.moves[m];
    if (!move.sideways() || move.feed == chunk.paths[link - 1].feed) continue;
    if (only_new && layer.IsKnown(move)) continue;
    Note(seen.tail_feeds, static_cast<uint64_t>(move.feed), move, layer.index());
  }
}

void ObserveWas(const LayerPair& layer, const Tails& tails, Observations& seen) {
  const TraceChunk& chunk = layer.was();
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    if (layer.Ended()) return;
    const TraceLink& traced = chunk.links[link];
    if (traced.scripted) {
      ObserveScript(chunk, link, seen);
      // What comes behind the script's last line leads to the next path, as fast as that goes.
      for (uint32_t m = traced.first_move + traced.fixed; m < traced.end_move; ++m) {
        const TraceMove& move = chunk.moves[m];
        if (!move.in_print) continue;
        Note(seen.feeds[KindOf(move)], static_cast<uint64_t>(move.feed), move, layer.index());
      }
      continue;
    }
    ObserveTail(layer, chunk, link, tails.At(link), false, seen);
    for (uint32_t m = traced.first_move + tails.At(link); m < traced.end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (!move.in_print) {
        seen.script_signatures.insert(move.signature);
        continue;
      }
      Note(seen.feeds[KindOf(move)], static_cast<uint64_t>(move.feed), move, layer.index());
      Note(seen.accelerations[KindOf(move)], move.acceleration, move, layer.index());
      Note(seen.signatures, move.signature, move, layer.index());
    }
  }
}

using LongestTravels = absl::flat_hash_map<uint64_t, float>;  // by acceleration, mm

LongestTravels LongestOf(const LayerPair& layer) {
  LongestTravels longest;
  const TraceChunk& chunk = layer.was();
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    for (uint32_t m = chunk.links[link].first_move; m < chunk.links[link].end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (move.kind != MoveKind::kTravel || !move.in_print) continue;
      float& of_one = longest[move.acceleration];
      of_one = std::max(of_one, static_cast<float>(move.length_mm()));
    }
  }
  return longest;
}

// All travel to paths of the same settings has the same acceleration, as where those settings stand
// before the travel: then it says nothing of the length.
bool AcceleratesByPath(const LayerPair& layer) {
  const TraceChunk& chunk = layer.was();
  absl::flat_hash_map<uint64_t, uint64_t> of_path;
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    for (uint32_t m = chunk.links[link].first_move; m < chunk.links[link].end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (move.kind != MoveKind::kTravel || !move.in_print) continue;
      const auto known = of_path.try_emplace(chunk.paths[link].acceleration, move.acceleration);
      if (known.first->second != move.acceleration) return false;
    }
  }
  return true;
}

// Some slicers accelerate less on short travel: true if the layer has travel as long as `move` with
// another acceleration, and only much shorter travel with this one.
bool IsTooLong(const TraceMove& move, const LongestTravels& longest) {
  if (move.kind != MoveKind::kTravel) return false;
  const auto length = static_cast<float>(move.length_mm());
  const auto own = longest.find(move.acceleration);
  const float most = own == longest.end() ? 0 : own->second;
  if (!IsMuchLonger(length, most)) return false;
  return std::any_of(longest.begin(), longest.end(), [&](const auto& other) {
    return other.first != move.acceleration && other.second >= length;
  });
}

// Moves of `link` that the original does not have in this layer. The gap of a loop that begins
// elsewhere belongs to the loop, and is crossed as fast as that is printed.
bool IsNew(const LayerPair& layer, uint32_t link, const TraceMove& move) {
  if (!move.in_print || layer.IsKnown(move)) return false;
  const TraceChunk& is = layer.is();
  return move.kind != MoveKind::kTravel || !move.open || link == 0 ||
         move.length_mm() > LoopGapMm(is, link - 1) || move.feed != is.paths[link - 1].feed;
}

// The speeds of unretracted and of retracted travel of a layer.
using TravelFeeds = std::array<absl::flat_hash_set<Micro>, 2>;

TravelFeeds TravelFeedsOf(const LayerPair& layer) {
  TravelFeeds feeds;
  const TraceChunk& was = layer.was();
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    for (uint32_t m = was.links[link].first_move; m < was.links[link].end_move; ++m) {
      const TraceMove& move = was.moves[m];
      if (move.kind != MoveKind::kTravel || !move.in_print) continue;
      feeds[move.open ? 0 : 1].insert(move.feed);
    }
  }
  return feeds;
}

// Slicers treat retracted and unretracted travel alike: in a layer that has none of the kind of
// `move`, the other one counts.
bool HasOther(const TravelFeeds& feeds, const TraceMove& move) {
  if (move.kind != MoveKind::kTravel) return false;
  return feeds[move.open ? 0 : 1].empty() && feeds[move.open ? 1 : 0].contains(move.feed);
}

void ObserveIs(const LayerPair& layer, const Tails& tails, Observations& seen) {
  const TraceChunk& chunk = layer.is();
  const TravelFeeds feeds = TravelFeedsOf(layer);
  const LongestTravels longest = AcceleratesByPath(layer) ? LongestTravels() : LongestOf(layer);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    const TraceLink& traced = chunk.links[link];
    ObserveTail(layer, chunk, link, tails.At(link), true, seen);
    // At unknown lines every step is that of the original there: see CheckScriptedTravels.
    if (traced.scripted) continue;
    for (uint32_t m = traced.first_move + tails.At(link); m < traced.end_move; ++m) {
      const TraceMove& move = chunk.moves[m];
      if (!IsNew(layer, link, move)) continue;
      if (!move.firmware) {
        if (!HasOther(feeds, move)) {
          Note(seen.feeds[KindOf(move)], static_cast<uint64_t>(move.feed), move, layer.index());
        }
        Note(seen.accelerations[KindOf(move)], move.acceleration, move, layer.index());
        if (IsTooLong(move, longest)) {
          seen.long_travels.push_back(
              {move.acceleration, static_cast<float>(move.length_mm()), move.line, layer.index()});
        }
      }
      if (move.filament != 0 && move.kind != MoveKind::kWipe)
        Note(seen.signatures, move.signature, move, layer.index());
    }
  }
}

// What layers may do at speeds of their own, as first layers do.
bool HasLayerSpeed(const TraceMove& move) {
  if (!move.in_print || move.firmware) return false;
  return move.kind != MoveKind::kWipe;
}

// The speeds of one kind of move in a layer of the original.
struct LayerFeeds {
  absl::flat_hash_set<Micro> feeds;
  uint32_t line = 0;  // of the first of them
};

using FeedsByKind = std::array<LayerFeeds, static_cast<size_t>(MoveKind::kCount)>;

FeedsByKind FeedsOf(const LayerPair& layer) {
  FeedsByKind were;
  const TraceChunk& was = layer.was();
  for (uint32_t link = layer.first_path_was(); link < layer.end_path_was(); ++link) {
    for (uint32_t m = was.links[link].first_move; m < was.links[link].end_move; ++m) {
      const TraceMove& move = was.moves[m];
      if (!HasLayerSpeed(move)) continue;
      LayerFeeds& of_kind = were[static_cast<size_t>(move.kind)];
      if (of_kind.feeds.empty()) of_kind.line = move.line;
      of_kind.feeds.insert(move.feed);
    }
  }
  return were;
}

// New moves are as fast as those of their kind in the layer. If it has none of the kind, those of
// the whole file count.
void CheckLayerFeeds(const LayerPair& layer, LayerFindings& findings) {
  const FeedsByKind were = FeedsOf(layer);
  const TraceChunk& is = layer.is();
  const Tails tails(layer, false);
  for (uint32_t link = layer.first_path_is(); link < layer.end_path_is(); ++link) {
    if (layer.Ended()) return;
    for (uint32_t m = is.links[link].first_move + tails.At(link); m < is.links[link].end_move;
         ++m) {
      const TraceMove& move = is.moves[m];
      const LayerFeeds& of_kind = were[static_cast<size_t>(move.kind)];
      if (!HasLayerSpeed(move) || of_kind.feeds.empty() || of_kind.feeds.contains(move.feed) ||
          !IsNew(layer, link, move)) {
        continue;
      }
      findings.breaks.push_back(
          {VerifyRule::kSpeeds, of_kind.line, move.line, layer.index(),
           absl::StrFormat("%s at F%g, as none of this layer in the original",
                           MoveKindName(move.kind), static_cast<double>(move.feed) * 1e-6)});
      return;
    }
  }
}

}  // namespace

void ObserveSpeeds(const LayerPair& layer, LayerFindings& findings) {
  ObserveWas(layer, Tails(layer, true), findings.was);
  ObserveIs(layer, Tails(layer, false), findings.is);
  CheckLayerFeeds(layer, findings);
}

// After the last path there are also moves of the end script, which are no example for the print.
void ObserveLastSpeeds(const LayerPair& layer, LayerFindings& findings) {
  const TraceChunk& was = layer.was();
  const TraceChunk& is = layer.is();
  const TraceLink& last_was = was.links.back();
  absl::flat_hash_set<uint64_t> feeds;
  absl::flat_hash_set<uint64_t> accelerations;
  const auto key = [](const TraceMove& move, uint64_t value) { return Mix(KindOf(move), value); };
  for (uint32_t m = last_was.first_move; m < last_was.end_move; ++m) {
    const TraceMove& move = was.moves[m];
    feeds.insert(key(move, static_cast<uint64_t>(move.feed)));
    accelerations.insert(key(move, move.acceleration));
  }
  for (uint32_t m = is.links.back().first_move; m < is.links.back().end_move; ++m) {
    const TraceMove& move = is.moves[m];
    if (move.firmware || layer.IsKnown(move)) continue;
    const size_t kind = KindOf(move);
    const auto feed = static_cast<uint64_t>(move.feed);
    if (!feeds.contains(key(move, feed))) {
      Note(findings.is.feeds[kind], feed, move, layer.index());
    }
    if (!accelerations.contains(key(move, move.acceleration))) {
      Note(findings.is.accelerations[kind], move.acceleration, move, layer.index());
    }
  }
}

namespace {

// The accelerations that moves of `kind` may have. Slicers treat retracted and
// unretracted travel alike; other moves between paths have that of the path before, or
// that of travel.
bool IsKnownAcceleration(const Observations& was, size_t kind, uint64_t acceleration) {
  constexpr auto kTravel = static_cast<size_t>(MoveKind::kTravel);
  for (const size_t like : {kind, kTravel, kOpenTravel}) {
    if (was.accelerations[like].contains(acceleration)) return true;
  }
  return kind != kTravel && kind != kOpenTravel && was.deposit_accelerations.contains(acceleration);
}

// The longest travel with `acceleration`.
float LongestUnder(const Observations& was, uint64_t acceleration) {
  float longest = 0;
  for (const size_t kind : {static_cast<size_t>(MoveKind::kTravel), kOpenTravel}) {
    const auto found = was.accelerations[kind].find(acceleration);
    if (found != was.accelerations[kind].end()) {
      longest = std::max(longest, found->second.longest_mm);
    }
  }
  return longest;
}

void CompareLengths(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const LongTravel& travel : is.long_travels) {
    const float longest = LongestUnder(was, travel.acceleration);
    if (longest <= 0 || !IsMuchLonger(travel.length_mm, longest)) continue;
    breaks.push_back({VerifyRule::kSpeeds, 0, travel.line, travel.layer,
                      absl::StrFormat("travel of %.2f mm with an acceleration that the original "
                                      "does not use for travel longer than %.2f mm",
                                      travel.length_mm, longest)});
  }
}

// What drips out of the nozzle on a tail depends on how long that takes.
void CompareTails(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  for (const auto& [feed, seen] : is.tail_feeds) {
    const uint64_t key = feed;
    if (was.tail_feeds.contains(key) ||
        std::any_of(was.feeds.begin(), was.feeds.end(),
                    [key](const auto& of_kind) { return of_kind.contains(key); })) {
      continue;
    }
    AddAt(seen,
          {VerifyRule::kSpeeds, 0, 0, -1,
           absl::StrFormat("continues along a path at F%g, as nothing in the original",
                           static_cast<double>(static_cast<Micro>(feed)) * 1e-6)},
          breaks);
  }
}

}  // namespace

void CompareSpeeds(const Observations& was, const Observations& is, std::vector<Finding>& breaks) {
  CompareLengths(was, is, breaks);
  CompareTails(was, is, breaks);
  for (size_t kind = 0; kind < was.feeds.size(); ++kind) {
    // Slicers treat retracted and unretracted travel alike: for a kind that the original does not
    // have, the other one counts.
    size_t like = kind;
    constexpr auto kTravel = static_cast<size_t>(MoveKind::kTravel);
    if (was.feeds[kind].empty() && kind == kOpenTravel) like = kTravel;
    if (was.feeds[kind].empty() && kind == kTravel) like = kOpenTravel;
    for (const auto& [feed, seen] : is.feeds[kind]) {
      if (was.feeds[like].contains(feed)) continue;
      AddAt(seen,
            {VerifyRule::kSpeeds, FirstLineOf(was.feeds[like]), 0, -1,
             absl::StrFormat("%s at F%g, as none in the original", KindName(kind),
                             static_cast<double>(static_cast<Micro>(feed)) * 1e-6)},
            breaks);
    }
    for (const auto& [acceleration, seen] : is.accelerations[kind]) {
      if (IsKnownAcceleration(was, kind, acceleration)) continue;
      AddAt(seen,
            {VerifyRule::kSpeeds, FirstLineOf(was.accelerations[like]), 0, -1,
             absl::StrFormat("%s with an acceleration that none in the original has",
                             KindName(kind))},
            breaks);
    }
  }
}

void ObserveScript(const TraceChunk& was, uint32_t link, Observations& seen) {
  for (uint32_t m = was.links[link].first_move; m < was.links[link].end_move; ++m) {
    seen.script_signatures.insert(was.moves[m].signature);
  }
}

}  // namespace traverse::gcode

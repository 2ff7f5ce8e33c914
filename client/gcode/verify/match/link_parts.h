// The parts of a link: a departure from the path before it, travel, and an arrival at the path
// behind it.
//
//   ==path==| inwards, wipe, retraction, lift | travel | descent, prime |==path==
//             departure                                  arrival
//
// Each part in one form wherever it stands: with heights above the paths, consecutive moves alike
// as one, and without what depends on where the paths lie.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LINK_PARTS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LINK_PARTS_H_

#include <cstdint>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/match/layer_pair.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

struct PartStep {
  MoveKind kind = MoveKind::kTravel;
  bool firmware = false;
  Micro feed = 0;
  uint64_t tool = 0;      // that moves filament
  uint64_t spiral = 0;    // TraceMove::spiral
  Micro filament = 0;     // of a wipe with what is retracted right behind it
  Micro pulled = 0;       // before it primes
  int64_t above_um = 0;   // where it ends: above the path before, if the path behind is lower
  int64_t behind_um = 0;  // and above the path behind
  double length_mm = 0;   // of travel within a departure or an arrival
};

struct LinkPart {
  enum Role : uint8_t { kDeparture, kSpeed, kArrival };
  Role role = kDeparture;
  std::vector<PartStep> steps;  // one of them tells a speed: of travel, or of wipes
  bool in_place = false;        // of a link in which the head moves up and down alone
};

// A link of `chunk`, as it is cut into parts.
class LinkCutter {
 public:
  // Without its first `skipped` moves, those before unknown lines, and those of the start script.
  // Of the link behind the last path only what comes before the head leaves its height. With
  // `known_in`, parts of moves that this layer of the original has are none.
  LinkCutter(const TraceChunk& chunk, uint32_t link, uint32_t skipped,
             const LayerPair* known_in = nullptr);

  bool level() const { return level_; }  // both paths have one height

  // The link cut at its longest travel; at its end if it has none.
  std::vector<LinkPart> Parts() const;

  // The link cut at each of its travel moves, the first four of many; anywhere if it has none, is
  // as short, and wipes or leads to another height.
  std::vector<std::vector<LinkPart>> AllParts() const;

 private:
  bool Travels(size_t i) const { return moves_[i]->kind == MoveKind::kTravel; }
  bool GoesOn(size_t i) const;
  void DropRisesToLayer(double top_mm);
  std::vector<LinkPart> CutAt(size_t first) const;
  PartStep StepOf(size_t i, Micro pulled) const;
  void AddSpeeds(size_t begin, size_t end, std::vector<LinkPart>& parts) const;
  void AddPart(LinkPart::Role role, size_t begin, size_t end, std::vector<LinkPart>& parts) const;

  bool IsKnown(size_t i) const { return known_in_ != nullptr && known_in_->IsKnown(*moves_[i]); }

  const LayerPair* const known_in_;
  std::vector<const TraceMove*> moves_;
  double from_mm_ = 0;
  double to_mm_ = 0;
  bool level_ = true;
};

// The parts that some links have.
class KnownParts {
 public:
  void Add(LinkPart part);
  void Append(const KnownParts& other);

  // Whether there is such a part: of the same steps, at the same speeds and heights, with the same
  // amounts of filament. A spiral may be a straight move up; travel may be shorter. A part in
  // place may lack the lift above the next path.
  bool Has(const LinkPart& part) const;

  // Whether there is one of the same kinds of steps.
  bool HasLike(const LinkPart& part) const;

 private:
  void AddAsItIs(const LinkPart& part);
  bool HasAsItIs(const LinkPart& part) const;

  absl::flat_hash_map<uint64_t, std::vector<LinkPart>> parts_;  // by all that has no slack
  absl::flat_hash_set<uint64_t> forms_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LINK_PARTS_H_

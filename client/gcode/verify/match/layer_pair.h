// One layer of both files, with facts that the rules need again and again.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_PAIR_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_PAIR_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/types/span.h"
#include "client/gcode/verify/match/piece_tree.h"
#include "client/gcode/verify/match/plane.h"
#include "client/gcode/verify/match/visits.h"
#include "client/gcode/verify/trace/trace.h"
#include "client/gcode/work_limit.h"

namespace traverse::gcode {

// Settings that the slicer states at the end of the file.
struct SlicerSettings {
  bool monotonic_top = true;
  bool monotonic_bottom = false;
  bool leads_around_walls = false;  // leads travel around walls
  double clearance_radius_mm = 30;  // around the nozzle, within which other parts hang
  double nozzle_height_mm = 2;      // no other part hangs lower above the tip than this
  double filament_mm = 1.75;        // its diameter
  double least_layer_seconds = 10;  // the greatest of all tools; 10: not stated
};

SlicerSettings ReadSettings(std::string_view text);

// The paths of one file in a layer, with the links before each of them.
struct LayerSide {
  const TraceChunk& chunk;
  const bool original;
  uint32_t first_path = 0;
  uint32_t end_path = 0;
  std::vector<uint32_t> tails = {};  // [link - first_path]
  std::vector<uint32_t> along = {};

  // How many moves at the beginning of a link, or of the one behind the layer, continue along the
  // path before, without filament and no faster than it was printed, and are no travel.
  uint32_t TailOf(uint32_t link) const { return tails[link - first_path]; }

  // The same where they may be faster, lifted, and come after a retraction.
  uint32_t AlongOf(uint32_t link) const { return along[link - first_path]; }
  absl::Span<const TraceMove> MovesAlong(uint32_t link) const {
    return chunk.MovesOf(link).first(AlongOf(link));
  }
};

class LayerPair {
 public:
  // Layer `layer` of both chunks. REQUIRES: their sections hold the same deposits.
  LayerPair(const TraceChunk& was, const TraceChunk& is, size_t layer, const WorkLimit& limit = {});

  // What the sides know of tails, which rules need, but not the shape of the layer.
  void FindTails();

  // True if the time for the files is over: what is found then is not looked at.
  bool Ended() const { return limit_.Ended(); }
  const WorkLimit& limit() const { return limit_; }

  const LayerSide& Side(bool original) const { return original ? side_was_ : side_is_; }
  const TraceChunk& was() const { return was_; }
  const TraceChunk& is() const { return is_; }
  size_t place() const { return layer_; }  // among the layers of the chunks
  int64_t index() const { return was_.layers[layer_].index; }

  uint32_t first_path_was() const { return side_was_.first_path; }
  uint32_t end_path_was() const { return side_was_.end_path; }
  uint32_t first_path_is() const { return side_is_.first_path; }
  uint32_t end_path_is() const { return side_is_.end_path; }

  // Calls visit(side, link) for the links to all paths, first of the original, then of the other
  // file.
  template <typename Visit>
  void ForEachLink(Visit visit) const {
    for (const LayerSide* side : {&side_was_, &side_is_}) {
      for (uint32_t link = side->first_path; link < side->end_path && !Ended(); ++link) {
        visit(*side, link);
      }
    }
  }

  const std::vector<Visit>& visits() const { return visits_; }
  absl::Span<const Visit> SectionVisits(size_t section) const {
    return absl::MakeSpan(visits_).subspan(section_begin_[section],
                                           section_begin_[section + 1] - section_begin_[section]);
  }
  size_t section_count() const { return section_begin_.size() - 1; }
  const TraceSection& SectionWas(size_t section) const {
    return was_.sections[was_.layers[layer_].first_section + section];
  }
  const TraceSection& SectionIs(size_t section) const {
    return is_.sections[is_.layers[layer_].first_section + section];
  }

  // The class of a path of the original: by name or else by shape; ironing also by what
  // lies under it.
  PathClass ClassOf(uint32_t path) const { return FactsOf(path).path_class; }
  bool IsWall(uint32_t path) const { return IsWallClass(ClassOf(path)); }
  bool Closed(uint32_t path) const { return FactsOf(path).closed; }
  bool Outer(uint32_t path) const { return FactsOf(path).outer; }
  absl::Span<const Piece> PiecesOf(uint32_t path) const {
    const Facts& facts = FactsOf(path);
    return absl::MakeSpan(pieces_).subspan(facts.first_piece, facts.piece_count);
  }
  const std::vector<Piece>& pieces() const { return pieces_; }

  // The outer walls of the layer, including overhanging ones.
  const PieceTree& outer_walls() const { return outer_walls_; }

  // True if the original has the same move, from the same point to the same point, in this layer.
  bool IsKnown(const TraceMove& move) const { return known_.contains(move.identity); }

  // True unless `move` of that side is of the other file, and known.
  bool Counts(const LayerSide& side, const TraceMove& move) const {
    return side.original || !IsKnown(move);
  }

  // The links of the other file whose travel nobody sees, and which need neither retract nor lift
  // nor wipe for that (hidden_links.h).
  bool IsHidden(uint32_t link) const { return hidden_.contains(link); }
  void SetHidden(absl::flat_hash_set<uint32_t> links) { hidden_ = std::move(links); }

  // True if the path of the other file that `visit` ends in ends with it; false if that goes on to
  // another path of the original.
  bool EndsPath(const Visit& visit) const {
    return is_.paths[visit.last_path].end_segment == visit.last_segment + 1;
  }

  // The line of the other file with which the visit begins.
  uint32_t LineOf(const Visit& visit) const { return is_.segments[visit.first_segment].line; }

  // The line of the original with which the path begins that path `path` of the other file is a
  // part of.
  uint32_t OriginalLine(uint32_t path) const;

  // True if the travel of `link` without a retraction (`open`), or with one, crosses outer walls.
  // Its ends, which may lie on walls, do not count.
  bool CrossesOuterWalls(const TraceChunk& chunk, uint32_t link, bool open) const;

  // The length of its travel without a retraction if that does so, or comes right over an outer
  // wall that neither of its ends is that near to; else 0. Without `skipped` moves before it.
  double OpenLengthOverWalls(const TraceChunk& chunk, uint32_t link, uint32_t skipped) const;

  // True if the straight move from `a` to `b`, without its ends, crosses an outer wall.
  bool CrossesOuterWall(Point a, Point b) const;

 private:
  // The travel of `link` behind `skipped` moves, without its ends, and its length with them.
  struct Travel {
    std::vector<Piece> moves;
    double length_mm = 0;
  };
  Travel TravelOf(const TraceChunk& chunk, uint32_t link, bool open, uint32_t skipped) const;

  bool CrossesWalls(const Travel& travel) const;
  bool MeetsOuterWall(Point a, Point b) const;

  struct Facts {
    PathClass path_class = PathClass::kUnnamed;
    bool closed = false;
    bool outer = false;
    uint32_t first_piece = 0;
    uint32_t piece_count = 0;
  };

  const Facts& FactsOf(uint32_t path) const { return facts_[path - first_path_was()]; }
  void LearnFacts();
  bool IsLoopToName(uint32_t path) const;
  void LearnShapes();
  bool IsInside(uint32_t path, const PieceTree& loops) const;
  void LearnIroning();
  void Match();

  const TraceChunk& was_;
  const TraceChunk& is_;
  const size_t layer_;
  const WorkLimit limit_;
  LayerSide side_was_;
  LayerSide side_is_;
  std::vector<Facts> facts_;  // [path - first_path_was()]
  std::vector<Piece> pieces_;
  PieceTree outer_walls_;
  std::vector<Visit> visits_;
  std::vector<size_t> section_begin_;  // in visits_
  absl::flat_hash_set<uint64_t> known_;
  absl::flat_hash_set<uint32_t> hidden_;
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_MATCH_LAYER_PAIR_H_

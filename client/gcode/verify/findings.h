// What the rules find in one layer: breaks, and observations to compare with the whole print.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "absl/container/inlined_vector.h"
#include "client/gcode/verify/match/layer_pair.h"
#include "client/gcode/verify/match/link_parts.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// A line of a file, and its layer.
struct Place {
  Place(uint32_t of_line = 0, int64_t of_layer = -1) : line(of_line), layer(of_layer) {}

  uint32_t line;  // 0: none
  int64_t layer;  // -1: not known
};

// A break in a rule's words; names of files and rule are added later.
struct Finding {
  VerifyRule rule = VerifyRule::kSamePrint;
  uint32_t original_line = 0;
  Place at = {};  // in the optimised file
  std::string what = {};
  uint32_t before_line = 0;  // of the optimised file: what has to come before that; 0: nothing
};

// Where moves of one acceleration were seen.
struct Seen {
  std::vector<Place> places;  // not all of a layer, and VerifyReport::kMostBreaks or a few more
  float longest_mm = 0;       // the longest of sideways moves
};

// A travel move between paths, with its heights.
struct TravelProfile {
  // Pieces of the travel move, [from, to] above the layer.
  struct Piece {
    float from_mm = 0;
    float to_mm = 0;
    float length_mm = 0;
  };
  Place at;
  uint64_t ends = 0;  // a digest of its two end points
  absl::InlinedVector<Piece, 2> pieces = {};
};

// The kinds of travel moves: retracted or not, between layers or within one, across outer walls or
// not.
inline constexpr size_t kTravelKinds = 8;

// Which way the heights lead that travel connects.
enum class TravelRise : uint8_t { kLevel, kUp, kDown, kCount };

// The most that the travel between two paths does of something.
struct TravelExtreme {
  float mm = 0;
  Place at;
  TravelRise rise = TravelRise::kLevel;
};

// The travel between two paths.
struct TravelLength {
  float length_mm = 0;
  float open_mm = 0;            // the part of it without a retraction
  float excess_mm = 0;          // beyond the straight line
  bool turns_back = false;      // one of its moves leads back to where the one before began
  bool to_layer = false;        // from another one
  bool retracts = false;        // though maybe not before its first move
  bool was_retracted = false;   // the original's travel to this layer is retracted all the way
  bool was_retracting = false;  // or on the way
  Place at;

  // From one layer to the next, all the way.
  bool retracted_to_layer() const { return to_layer && length_mm > 0 && open_mm == 0; }
};

// Heights above the layer that moves state.
struct StatedHeights {
  absl::flat_hash_set<int64_t> um;
  uint32_t first_line = 0;  // the first that states one; 0: none
};

// The height that a move states, and the slope on which it reaches it; 0: it does not rise.
struct StatedHeight {
  int64_t um = 0;
  int64_t slope = 0;   // um in 10 mm
  bool level = false;  // between two paths of one height
  Place at;
};

// By how much primes of one file push more than was retracted.
struct PrimeBalance {
  struct Odd {
    Micro surplus = 0;
    Place at;
  };
  int64_t links = 0;  // that return all but what rounding takes
  Micro surplus = 0;  // of these together
  Odd most;
  Odd least;

  void Add(Micro surplus_of_link, Place at);
  void Append(const PrimeBalance& other);
};

// A link that the original does not have.
struct UnprovenLink {
  std::vector<std::vector<LinkPart>> missing;  // in its layer: one list for each way to cut it
  std::string what;                            // for people
  Place at;
};

// A wipe, and how it follows its path.
struct Wipe {
  float off_mm = 0;     // at the ends of its moves
  float astray_mm = 0;  // halfway
  float turned_mm = 0;  // by how much an arc of it would lie nearer to the path the other way
  float length_mm = 0;
  float pulled_mm = 0;      // filament
  float steepest = 0;       // the most per mm of one of its longer moves
  float uneven_mm = 0;      // by how much, at some point, its filament is off an even rate
  uint32_t moves = 0;       // of which no more than kMostAlong are compared with its path
  bool turns_back = false;  // somewhere where its path does not
  bool known = true;        // the original has all its moves in this layer
  uint32_t path_line = 0;   // where its path begins in the original
  Place at;                 // line 0: none

  float pull() const { return pulled_mm / length_mm; }
};

// A travel move with an acceleration that only shorter ones of its layer have.
struct LongTravel {
  uint64_t acceleration = 0;
  float length_mm = 0;
  Place at;
};

// The highest or the lowest point of moves, above the bed.
struct ExtremePoint {
  double z_mm = 0;
  Place at;  // line 0: there is no such move
};

// A bend of travel that leads around an outer wall.
struct Detour {
  Place at;
  float excess_mm = 0;
};

// What some layers of one file show.
struct Observations {
  std::array<absl::flat_hash_map<uint64_t, Seen>, static_cast<size_t>(MoveKind::kCount) + 1>
      accelerations;
  KnownParts parts;
  std::vector<UnprovenLink> new_links;  // with parts that their layer does not have
  PrimeBalance primes;
  StatedHeights level_heights;          // by moves between two paths of one height
  StatedHeights other_heights;          // by others
  absl::flat_hash_set<int64_t> slopes;  // um of rise in 10 mm, for moves that rise on the way
  std::vector<StatedHeight> stated;     // by the other file's moves
  ExtremePoint first_highest;           // of the travel from the start script
  ExtremePoint first_lowest;
  std::vector<TravelExtreme> lowest;    // above the higher of the heights it connects, below 0
  std::vector<TravelExtreme> descents;  // how far it leads sideways while descending
  absl::flat_hash_set<uint64_t> deposit_accelerations;  // of the whole file
  std::vector<TravelLength> travel_lengths;             // the greatest of each layer
  std::vector<TravelLength> travels_to_layers;
  std::vector<LongTravel> long_travels;
  std::vector<Detour> detours;           // of the original one for each layer
  bool departs_inside = false;           // by a short move from what is no outer wall: departures.h
  int64_t departures_outside = 0;        // by such moves from outer walls
  int64_t retractions_outside = 0;       // at the ends of outer walls
  std::vector<Finding> lost_departures;  // of travel that leads elsewhere than in the original
  bool poked = false;                    // an open move led along a path and back to its end
  std::vector<Finding> pokes;            // the new ones
  std::array<std::vector<TravelProfile>, kTravelKinds> travels;
  std::vector<Wipe> wipes;

  void Append(const Observations& other);
};

struct LayerFindings {
  std::vector<Finding> breaks;  // in this layer, whatever layer they name
  Observations was;             // everything that the original does
  Observations is;              // what the other file does differently

  Observations& Of(const LayerSide& side) { return side.original ? was : is; }
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

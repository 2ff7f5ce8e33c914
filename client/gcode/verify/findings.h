// What the rules find in one layer: breaks, and observations to compare with the whole print.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/match/link_parts.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// A break in a rule's words; names of files and rule are added later.
struct Finding {
  VerifyRule rule = VerifyRule::kSamePrint;
  uint32_t original_line = 0;
  uint32_t optimised_line = 0;
  int64_t layer = -1;
  std::string what;
  uint32_t before_line = 0;  // of the optimised file: what has to come before that; 0: nothing
};

// Where something was observed.
struct Seen {
  struct Place {
    uint32_t line = 0;
    int64_t layer = -1;
  };
  uint32_t line = 0;
  int64_t layer = -1;
  float longest_mm = 0;  // the longest of sideways moves

  // The next places: so many of each layer, and VerifyReport::kMostBreaks of all.
  std::vector<Place> others = {};
  static constexpr size_t kMostOfALayer = 64;
};

// Notes in a map of one layer that `key` was observed at `line`.
template <typename Map, typename Key>
Seen& NoteSeen(Map& map, const Key& key, uint32_t line, int64_t layer) {
  const auto [found, added] = map.try_emplace(key, Seen{line, layer});
  Seen& seen = found->second;
  if (!added && seen.others.size() < Seen::kMostOfALayer) seen.others.push_back({line, layer});
  return seen;
}

// Adds `finding` for each place of `seen`.
void AddAt(const Seen& seen, Finding finding, std::vector<Finding>& breaks);

// The first line of all of `map`; 0 if it is empty.
template <typename Map>
uint32_t FirstLineOf(const Map& map) {
  uint32_t line = 0;
  for (const auto& [key, seen] : map) {
    if (line == 0 || seen.line < line) line = seen.line;
  }
  return line;
}

// A travel move between paths, with its heights.
struct TravelProfile {
  // Pieces of the travel move, [from, to] above the layer.
  struct Piece {
    float from_mm = 0;
    float to_mm = 0;
    float length_mm = 0;
  };
  uint32_t line = 0;
  int64_t layer = -1;
  uint32_t first = 0;  // in LiftLog::pieces
  uint32_t end = 0;
  uint64_t ends = 0;  // a digest of its two end points
};

// The kinds of travel moves: retracted or not, between layers or within one, across outer walls or
// not.
inline constexpr size_t kTravelKinds = 8;

struct LiftLog {
  std::array<std::vector<TravelProfile>, kTravelKinds> travels;
  std::vector<TravelProfile::Piece> pieces;

  void Append(const LiftLog& other);
};

// How low a travel move goes compared with the heights that it connects.
enum class TravelRise : uint8_t { kLevel, kUp, kDown, kCount };

struct LowestTravel {
  float above_mm = 0;  // the higher of the two heights; less than 0: below it
  uint32_t line = 0;
  int64_t layer = -1;
  TravelRise rise = TravelRise::kLevel;
};

// How far a move leads sideways while descending.
struct Descent {
  float length_mm = 0;
  uint32_t line = 0;
  int64_t layer = -1;
  TravelRise rise = TravelRise::kLevel;  // of the travel that it belongs to
};

// The travel between two paths.
struct TravelLength {
  float length_mm = 0;
  float open_mm = 0;        // the part of it without a retraction
  float excess_mm = 0;      // beyond the straight line
  bool turns_back = false;  // one of its moves leads back to where the one before began
  bool to_layer = false;    // unretracted, from one layer to the next
  bool retracts = false;    // though maybe not before its first move
  // Retracted all the way, from one layer to the next.
  bool retracted_to_layer = false;
  bool was_retracted = false;   // the original's travel to this layer is retracted all the way
  bool was_retracting = false;  // or on the way
  uint32_t line = 0;
  int64_t layer = -1;
};

// Heights above the layer in um, of one kind of lift.
struct LiftHeights {
  absl::flat_hash_map<int64_t, Seen> level;  // between two paths of one height
  absl::flat_hash_map<int64_t, Seen> other;

  absl::flat_hash_map<int64_t, Seen>& Of(bool is_level) { return is_level ? level : other; }
  const absl::flat_hash_map<int64_t, Seen>& Of(bool is_level) const {
    return is_level ? level : other;
  }

  // Whether one of them is `um`. Lifts between paths of one height are compared with their like, if
  // there are any.
  bool Have(int64_t um, bool is_level) const;

  // Where the first of them is that others are compared with; 0 if there is none.
  uint32_t FirstLine() const { return FirstLineOf(Of(!level.empty())); }
};

// The height that a move states, and the slope on which it reaches it; 0: it does not rise.
struct StatedHeight {
  int64_t um = 0;
  int64_t slope = 0;  // um in 10 mm
  bool level = false;
  uint32_t line = 0;
  int64_t layer = -1;
};

// By how much primes of one file push more than was retracted.
struct PrimeBalance {
  struct Odd {
    Micro surplus = 0;
    uint32_t line = 0;
    int64_t layer = -1;
  };
  int64_t links = 0;  // that return all but what rounding takes
  Micro surplus = 0;  // of these together
  Odd most;
  Odd least;

  void Add(Micro surplus_of_link, uint32_t line, int64_t of_layer);
  void Append(const PrimeBalance& other);
};

// A link that the original does not have.
struct UnprovenLink {
  std::vector<std::vector<LinkPart>> missing;  // in its layer: one list for each way to cut it
  std::string what;                            // for people
  uint32_t line = 0;
  int64_t layer = -1;
};

struct WipeDeviation {
  float off_mm = 0;     // at the ends of its moves
  float astray_mm = 0;  // halfway
  float turned_mm = 0;  // by how much an arc of it would lie nearer the other way
  float pull = 0;       // filament retracted per mm
  float steepest = 0;   // the same for its longer moves, one by one; the most
  float uneven_mm = 0;  // by how much, at some point, its filament is off an even rate
  float length_mm = 0;
  bool turns_back = false;  // somewhere where its path does not
  uint32_t line = 0;
  uint32_t original_line = 0;
  int64_t layer = -1;
};

// A travel move with an acceleration that only shorter ones of its layer have.
struct LongTravel {
  uint64_t acceleration = 0;
  float length_mm = 0;
  uint32_t line = 0;
  int64_t layer = -1;
};

// The highest or the lowest point of moves, above the bed.
struct ExtremePoint {
  double z_mm = 0;
  uint32_t line = 0;  // 0: there is no such move
  int64_t layer = -1;
};

// A bend of travel that leads around an outer wall.
struct Detour {
  uint32_t line = 0;
  int64_t layer = -1;
  float excess_mm = 0;
};

// What some layers of one file show.
struct Observations {
  std::array<absl::flat_hash_map<uint64_t, Seen>, static_cast<size_t>(MoveKind::kCount) + 1>
      accelerations;
  KnownParts parts;
  std::vector<UnprovenLink> new_links;  // with parts that their layer does not have
  PrimeBalance primes;
  LiftHeights heights;                  // of moves that state Z
  absl::flat_hash_set<int64_t> slopes;  // um of rise in 10 mm, for moves that rise on the way
  std::vector<StatedHeight> stated;     // by the other file's moves
  ExtremePoint first_highest;           // of the travel from the start script
  ExtremePoint first_lowest;
  std::vector<LowestTravel> lowest;  // travel that goes lower than what it connects
  std::vector<Descent> descents;     // the longest of each travel
  absl::flat_hash_set<uint64_t> deposit_accelerations;  // of the whole file
  std::vector<TravelLength> travel_lengths;             // the greatest of each layer
  std::vector<TravelLength> travels_to_layers;
  std::vector<LongTravel> long_travels;
  std::vector<Detour> detours;           // of the original one for each layer
  bool departs_inside = false;           // by a short move from what is no outer wall: departures.h
  int64_t departures_outside = 0;        // by such moves from outer walls
  int64_t retractions_outside = 0;       // at the ends of outer walls
  std::vector<Finding> lost_departures;  // of travel that leads elsewhere than in the original
  std::vector<Finding> pokes;  // open moves along a path and back to its end; one for each layer
  LiftLog lifts;
  std::vector<WipeDeviation> wipes;

  void Append(const Observations& other);
};

struct LayerFindings {
  std::vector<Finding> breaks;
  Observations was;  // everything that the original does
  Observations is;   // what the other file does differently
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

// What the rules find in one layer: breaks, and what has to be compared with the whole print.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "absl/container/flat_hash_set.h"
#include "client/gcode/verify/report.h"
#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {

// A break as a rule states it; names of files and rule are added to it.
struct Finding {
  VerifyRule rule = VerifyRule::kSamePrint;
  uint32_t original_line = 0;
  uint32_t optimised_line = 0;
  int64_t layer = -1;
  std::string what;
};

// Where something was seen.
struct Seen {
  uint32_t line = 0;
  int64_t layer = -1;
  int64_t count = 0;
  float longest_mm = 0;  // of sideways moves, the longest
};

// Something at one speed, or under one acceleration.
using SpeedKey = uint64_t;

// A way from path to path, as far as its height goes.
struct WayProfile {
  // Pieces of the way, [from, to] above the layer.
  struct Piece {
    float from_mm = 0;
    float to_mm = 0;
    float length_mm = 0;
  };
  uint32_t line = 0;
  int64_t layer = -1;
  uint32_t first = 0;  // in LiftLog::pieces
  uint32_t end = 0;
  uint64_t ends = 0;  // a digest of its two points
};

// The kinds of ways: with filament pulled back or not, between layers or within one, across outer
// walls or not.
inline constexpr size_t kWayKinds = 8;

struct LiftLog {
  std::array<std::vector<WayProfile>, kWayKinds> ways;
  std::vector<WayProfile::Piece> pieces;

  void Append(const LiftLog& other);
};

// How low a way leads beside the heights of what it connects.
enum class WayRise : uint8_t { kLevel, kUp, kDown, kCount };

struct LowestWay {
  float above_mm = 0;  // the higher one of the two heights; less than 0: below it
  uint32_t line = 0;
  int64_t layer = -1;
  WayRise rise = WayRise::kLevel;
};

// How far a move leads sideways on its way down.
struct Descent {
  float length_mm = 0;
  uint32_t line = 0;
  int64_t layer = -1;
  WayRise rise = WayRise::kLevel;  // of the way that it is part of
};

// How often the head rises between two paths.
struct RepeatedLift {
  bool level = false;  // both paths have the same height
  uint32_t times = 0;
  uint32_t line = 0;
  int64_t layer = -1;
};

// A way from path to path.
struct WayLength {
  float length_mm = 0;
  float open_mm = 0;        // of it, with filament not pulled back
  float excess_mm = 0;      // beyond the straight line
  bool turns_back = false;  // one of its moves leads back to where the one before began
  bool to_layer = false;    // with an open nozzle, from one layer to the next
  // With filament pulled back all the way, from one layer to the next.
  bool retracted_to_layer = false;
  bool was_retracted = false;  // the original has filament pulled back on the way to this layer
  uint32_t line = 0;
  int64_t layer = -1;
};

// The height that a move states, and the slope on which it comes to it; 0: it does not rise.
struct StatedHeight {
  int64_t um = 0;
  int64_t slope = 0;  // um in 10 mm
  uint32_t line = 0;
  int64_t layer = -1;
};

// Filament pulled back, and what undoes it.
struct RetractionCycle {
  uint64_t tool = 0;
  Micro pulled = 0;
  Micro pushed = 0;
  bool firmware = false;
  bool early = false;        // pushed before the way is done
  bool in_parts = false;     // pushed bit by bit on the way
  bool idle = false;         // no way between the two
  float late_mm = 0;         // of the way, gone before it was pulled back
  bool pushed_high = false;  // above what is printed on either side
  bool pulled_high = false;
  bool known = false;     // all its moves are moves of the original
  uint64_t identity = 0;  // of all its moves
  uint32_t line = 0;
  int64_t layer = -1;
};

struct WipeDeviation {
  float off_mm = 0;     // where its moves end
  float astray_mm = 0;  // halfway
  float pull = 0;       // filament pulled back per mm of it
  float steepest = 0;   // the same of its longer moves, one by one, the most
  float uneven_mm = 0;  // filament pulled by some point of it more, or less, than evenly
  float length_mm = 0;
  uint32_t line = 0;
  uint32_t original_line = 0;
  int64_t layer = -1;
};

struct Box {
  Point low{1e9, 1e9};
  Point high{-1e9, -1e9};

  void Add(Point p) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y)};
  }
};

// A way under an acceleration that only shorter ones of its layer are under.
struct LongWay {
  uint64_t acceleration = 0;
  float length_mm = 0;
  uint32_t line = 0;
  int64_t layer = -1;
};

// Where a layer's new moves lie farthest to one side.
struct FarPoint {
  Point at;
  uint32_t line = 0;
  int64_t layer = -1;
};

// How high a way leads, above the bed.
struct HighestPoint {
  double z_mm = 0;
  uint32_t line = 0;  // 0: there is no such way
  int64_t layer = -1;
};

// What one file shows in some of its layers.
struct Observations {
  std::array<absl::flat_hash_map<uint64_t, Seen>, static_cast<size_t>(MoveKind::kCount) + 1> feeds;
  std::array<absl::flat_hash_map<uint64_t, Seen>, static_cast<size_t>(MoveKind::kCount) + 1>
      accelerations;
  absl::flat_hash_map<uint64_t, Seen> tail_feeds;  // of what goes on along a path
  absl::flat_hash_map<uint64_t, Seen> signatures;
  absl::flat_hash_set<uint64_t> script_signatures;
  absl::flat_hash_map<int64_t, Seen> heights;  // um above the layer, of moves that state Z
  absl::flat_hash_set<int64_t> slopes;       // um of rise in 10 mm, of moves that rise on their way
  std::vector<StatedHeight> stated;          // what the other file's moves state
  absl::flat_hash_map<int64_t, Seen> rises;  // the same of moves straight up
  HighestPoint first_way;                    // of the way from the start script
  std::vector<LowestWay> lowest;             // ways that lead lower than what they connect
  std::vector<LowestWay> deepest;            // moves straight down that do so
  std::vector<Descent> descents;             // the longest of each way
  absl::flat_hash_map<int64_t, Seen> radii;  // um, of arcs that rise
  std::vector<RepeatedLift> lifts_of_links;  // links that rise more than once
  absl::flat_hash_set<uint64_t> deposit_accelerations;  // of the whole file, as the box is
  std::vector<FarPoint> farthest;
  Box box;                             // of all points
  std::vector<WayLength> way_lengths;  // the greatest of each layer
  std::vector<WayLength> ways_to_layers;
  std::vector<LongWay> long_ways;
  LiftLog lifts;
  std::vector<RetractionCycle> cycles;
  std::vector<WipeDeviation> wipes;

  void Append(const Observations& other);
};

struct LayerFindings {
  std::vector<Finding> breaks;
  Observations was;  // all that the original does
  Observations is;   // what the other file does otherwise
};

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_FINDINGS_H_

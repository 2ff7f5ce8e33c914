#include "client/gcode/verify/rules/rest.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/match/plane.h"

namespace traverse::gcode {
namespace {

// A rest may be shorter by this share.
constexpr double kLeastShare = 0.95;

// Rounding of sums of times.
constexpr double kSlackSeconds = 1e-3;

constexpr double kPlaceMm = 1;
constexpr double kFarCells = 4000;  // no plate is larger

// No layer has more cells with something in them, and no print; of what lies in further ones
// nothing is known.
constexpr size_t kMostCells = 1 << 18;
constexpr size_t kMostTops = 1 << 19;
constexpr double kLeastReachMm = 1.02;
constexpr double kMostReachMm = 4;
constexpr uint64_t kLooks = 100'000;  // at pairs of pieces, and for each piece
constexpr uint64_t kLooksEach = 1'000;
constexpr double kReachWidths = 1.25;
constexpr double kFilamentMm2 = 2.405;  // of 1.75 mm

class Regions {
 public:
  explicit Regions(size_t n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0u); }

  uint32_t Of(uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(uint32_t i, uint32_t j) { parent_[Of(i)] = Of(j); }

 private:
  std::vector<uint32_t> parent_;
};

uint64_t CellOf(double x, double y) {
  const auto index = [](double value) {
    return static_cast<uint32_t>(
        static_cast<int32_t>(std::floor(std::clamp(value, -kFarCells, kFarCells))));
  };
  return uint64_t{index(x)} << 32 | index(y);
}

// Cells with their islands, each once.
class CellSet {
 public:
  using Cell = std::pair<uint64_t, uint32_t>;

  bool full() const { return full_; }

  void Add(const Cell& cell) {
    if (full_ || (!cells_.empty() && cells_.back() == cell)) return;
    cells_.push_back(cell);
    if (cells_.size() < room_) return;
    Tidy();
    full_ = cells_.size() >= kMostCells;
    room_ = 2 * cells_.size() + kLeastRoom;
  }

  // Ascending.
  std::vector<Cell> Take() {
    Tidy();
    return std::move(cells_);
  }

 private:
  static constexpr size_t kLeastRoom = 1 << 16;

  void Tidy() {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
  }

  std::vector<Cell> cells_;
  size_t room_ = kLeastRoom;
  bool full_ = false;
};

class IslandFinder {
 public:
  IslandFinder(const LayerPair& layer, double height_mm)
      : layer_(layer),
        first_(layer.first_path_was()),
        regions_(layer.end_path_was() - first_),
        grid_(layer.pieces(), kPlaceMm) {
    for (uint32_t path = first_; path < layer.end_path_was(); ++path) {
      reach_.push_back(ReachOf(layer.was().paths[path], height_mm));
    }
  }

  PrintedIslands Find() {
    JoinNear();
    NumberIslands();
    NoteTimes();
    NoteCells();
    return std::move(found_);
  }

 private:
  static double ReachOf(const TracePath& path, double height_mm) {
    if (!(path.length_mm > 0) || !(height_mm > 0)) return kLeastReachMm;
    const double area = path.filament_mm / path.length_mm * kFilamentMm2;
    return std::clamp(kReachWidths * area / height_mm, kLeastReachMm, kMostReachMm);
  }

  // Where crowds of pieces lie in one place, to look at all pairs would take long: then the layer
  // is taken for one island.
  void JoinNear() {
    uint64_t left = kLooks + kLooksEach * grid_.pieces().size();
    for (const Piece& piece : grid_.pieces()) {
      if (layer_.Ended()) return;
      const uint32_t one = piece.path - first_;
      grid_.ForEachNear(piece.a, piece.b, reach_[one], [&](uint32_t i) {
        JoinIfNear(piece, grid_.pieces()[i]);
        return --left > 0;
      });
      if (left > 0) continue;
      for (uint32_t path = 1; path < reach_.size(); ++path) regions_.Join(path, 0);
      return;
    }
  }

  void JoinIfNear(const Piece& piece, const Piece& other) {
    const uint32_t one = piece.path - first_;
    const uint32_t two = other.path - first_;
    if (one == two || regions_.Of(one) == regions_.Of(two)) return;
    const double reach = std::max((reach_[one] + reach_[two]) / 2, kLeastReachMm);
    if (DistanceOfPieces(piece.a, piece.b, other.a, other.b) <= reach) regions_.Join(one, two);
  }

  void NumberIslands() {
    constexpr uint32_t kNone = UINT32_MAX;
    std::vector<uint32_t> number(reach_.size(), kNone);
    for (uint32_t path = 0; path < reach_.size(); ++path) {
      uint32_t& of_region = number[regions_.Of(path)];
      if (of_region == kNone) {
        of_region = static_cast<uint32_t>(found_.islands.size());
        PrintedIsland& island = found_.islands.emplace_back();
        island.begun_was = island.begun_is = std::numeric_limits<double>::infinity();
        island.first_was = path;
      }
      found_.islands[of_region].last_was = path;
      island_.push_back(of_region);
    }
    found_.paths = static_cast<uint32_t>(reach_.size());
  }

  void NoteTimes() {
    const TraceChunk& was = layer_.was();
    const TraceChunk& is = layer_.is();
    for (uint32_t path = 0; path < island_.size(); ++path) {
      PrintedIsland& island = found_.islands[island_[path]];
      const TracePath& of_was = was.paths[first_ + path];
      if (of_was.begun_seconds < island.begun_was) {
        island.begun_was = of_was.begun_seconds;
        island.line_was = was.LineOf(of_was);
      }
      island.left_was = std::max(island.left_was, of_was.left_seconds);
    }
    for (const Visit& visit : layer_.visits()) {
      PrintedIsland& island = found_.islands[island_[visit.path - first_]];
      const TracePath& begins = is.paths[visit.first_path];
      if (begins.begun_seconds < island.begun_is) {
        island.begun_is = begins.begun_seconds;
        island.line_is = is.LineOf(begins);
      }
      island.left_is = std::max(island.left_is, is.paths[visit.last_path].left_seconds);
    }
  }

  void NoteCells() {
    CellSet cells;
    for (const Piece& piece : grid_.pieces()) {
      if (layer_.Ended()) return;
      const uint32_t island = island_[piece.path - first_];
      const double steps = std::clamp(std::ceil(DistanceOf(piece.a, piece.b) * 2), 1.0, 1e6);
      for (double step = 0; step <= steps && !cells.full(); ++step) {
        const double share = step / steps;
        cells.Add({CellOf(piece.a.x + (piece.b.x - piece.a.x) * share,
                          piece.a.y + (piece.b.y - piece.a.y) * share),
                   island});
      }
    }
    found_.cells = cells.Take();
  }

  const LayerPair& layer_;
  const uint32_t first_;
  Regions regions_;
  const PieceGrid grid_;
  std::vector<double> reach_;     // [path of the layer]
  std::vector<uint32_t> island_;  // [path of the layer]
  PrintedIslands found_;
};

}  // namespace

PrintedIslands FindPrintedIslands(const LayerPair& layer, double height_mm) {
  return IslandFinder(layer, height_mm).Find();
}

void RestWatch::Take(const PrintedIslands& layer, int64_t index, std::vector<Finding>& breaks) {
  std::vector<bool> broken(layer.islands.size());
  for (const auto& [cell, number] : layer.cells) {
    const auto found = top_.find(cell);
    if (broken[number] || found == top_.end() || found->second.layer == index) continue;
    const Top& below = found->second;
    const PrintedIsland& island = layer.islands[number];
    // Nothing else is printed meanwhile.
    if (below.last_path_was + 1 == paths_ + island.first_was) continue;
    const double rest_was = island.begun_was - below.left_was;
    const double rest_is = island.begun_is - below.left_is;
    if (rest_is >= kLeastShare * std::min(rest_was, least_seconds_) - kSlackSeconds) continue;
    broken[number] = true;
    breaks.push_back(
        {VerifyRule::kRest, island.line_was, island.line_is, index,
         absl::StrFormat("printed %.1f s after the island below; that rests %.1f s in the original"
                         " where %.4g s are enough",
                         rest_is, rest_was, least_seconds_)});
  }
  for (const auto& [cell, number] : layer.cells) {
    const PrintedIsland& island = layer.islands[number];
    if (top_.size() >= kMostTops && !top_.contains(cell)) continue;
    top_[cell] = {island.left_was, island.left_is, paths_ + island.last_was, index};
  }
  paths_ += layer.paths;
}

}  // namespace traverse::gcode

#include "client/gcode/verify/match/layer_pair.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <utility>

#include "client/gcode/verify/match/laid_over.h"
#include "client/gcode/verify/match/slacks.h"
#include "client/gcode/verify/match/stated_settings.h"
#include "client/gcode/verify/match/touched_walls.h"

namespace traverse::gcode {
namespace {

constexpr double kEndSlackMm = 0.25;       // of travel, where it may touch the walls that it joins
constexpr double kLongestTailMm = 1.0;     // of one that leaves its path
constexpr double kStraightCosine = 0.996;  // of 5 degrees
constexpr double kWallsApartMm = 0.9;      // walls of one outline lie no farther apart

// The value of `; NAME = VALUE` in `text`.
std::string_view Setting(std::string_view text, std::string_view name) {
  for (size_t at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    if (at < 2 || text[at - 1] != ' ' || text[at - 2] != ';') continue;
    std::string_view rest = text.substr(at + name.size(), 64);
    if (!rest.starts_with(" = ")) continue;
    rest.remove_prefix(3);
    return rest.substr(0, rest.find_first_of("\r\n"));
  }
  return {};
}

double FlowOf(const TracePath& path) {
  return path.length_mm > 0 ? path.filament_mm / path.length_mm : 0;
}

// Of a very short move rounding tells no more than that it does not lead back.
bool GoesStraightOn(const TraceMove& move, const Piece& last) {
  const double length = move.length_mm();
  const double before = Distance(last.a, last.b);
  if (length <= 0 || before <= 0) return false;
  const double dot = (move.to.x - move.from.x) * (last.b.x - last.a.x) +
                     (move.to.y - move.from.y) * (last.b.y - last.a.y);
  return dot >= (length < kLeastDepartureMm ? 0 : kStraightCosine * length * before);
}

// The moves behind the path that may go along it.
absl::Span<const TraceMove> MovesBeside(const TraceChunk& chunk, uint32_t path) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(path + 1);
  return moves.first(std::min(moves.size(), kMostAlong));
}

// How many moves coast at the beginning of the link behind `path`, whose last line is `last`: no
// faster than the path, they go straight on from there. Slicers coast round corners, too; but what
// leads farther, or to the next path, is travel behind the first of them.
uint32_t CoastingMoves(const TraceChunk& chunk, uint32_t path, const Piece& last) {
  const absl::Span<const TraceMove> moves = chunk.MovesOf(path + 1);
  double length = 0;
  uint32_t m = 0;
  for (; m < moves.size(); ++m) {
    const TraceMove& move = moves[m];
    const bool slow =
        move.kind == MoveKind::kTravel && move.open && move.feed <= chunk.paths[path].feed;
    if (!slow || move.arc || move.z_to_mm != move.z_from_mm) break;
    const double before = std::exchange(length, length + move.length_mm());
    if (m == 0 && !GoesStraightOn(move, last)) return 0;
    if (length > kLongestTailMm) return before > 0 ? 1 : 0;
  }
  const bool leads_on = m == moves.size() && path + 1 < chunk.paths.size();
  return leads_on ? std::min(m, 1u) : m;
}

bool LiesWithin(double mm, Point p, absl::Span<const Piece> pieces) {
  return std::ranges::any_of(
      pieces, [p, mm](const Piece& piece) { return DistanceToPiece(p, piece.a, piece.b) <= mm; });
}

// How near to the path a move along it lies: a short one that leads aside is soon as near, and
// what is no longer than that may be either.
double BesideMm(const TraceMove& move) {
  constexpr double kSlope = 0.125;
  constexpr double kRoundedMm = 0.012;
  const double length = move.length_mm();
  return length <= kOnPathMm ? kOnPathMm : std::clamp(kSlope * length, kRoundedMm, kOnPathMm);
}

// Whether `move` leads along the path, whose pieces are `pieces`, or back along `before` it.
bool LeadsAlong(const TraceMove& move, absl::Span<const TraceMove> before,
                absl::Span<const Piece> pieces, double mm) {
  const auto lies_on = [&](Point p) {
    return std::ranges::any_of(before,
                               [p, mm](const TraceMove& other) {
                                 return DistanceToPiece(p, other.from, other.to) <= mm;
                               }) ||
           LiesWithin(mm, p, pieces);
  };
  return lies_on(move.to) && lies_on(move.middle);
}

// How many moves behind the path, whose pieces are `pieces`, continue along it with the nozzle
// open, no faster than the path, or coast, perhaps round corners.
uint32_t TailMoves(const TraceChunk& chunk, uint32_t path, absl::Span<const Piece> pieces) {
  const absl::Span<const TraceMove> moves = MovesBeside(chunk, path);
  const TracePath& traced = chunk.paths[path];
  const Point before = chunk.StartOf(traced, traced.end_segment - 1);
  const uint32_t coasting = CoastingMoves(chunk, path, {before, chunk.EndOf(traced), path});
  uint32_t m = 0;
  for (; m < moves.size(); ++m) {
    const TraceMove& move = moves[m];
    const bool slow = move.kind == MoveKind::kTravel && move.open && move.feed <= traced.feed;
    if (!slow || move.z_to_mm != move.z_from_mm) break;
    if (m >= coasting && !LeadsAlong(move, moves.first(m), pieces, BesideMm(move))) break;
  }
  return m;
}

// The same at any speed, opened or not, of which the first `tail` are known.
uint32_t AlongMoves(const TraceChunk& chunk, uint32_t path, absl::Span<const Piece> pieces,
                    uint32_t tail) {
  const absl::Span<const TraceMove> moves = MovesBeside(chunk, path);
  uint32_t m = tail;
  for (; m < moves.size(); ++m) {
    const TraceMove& move = moves[m];
    if (!move.sideways()) continue;
    if (move.kind != MoveKind::kTravel || move.z_to_mm != move.z_from_mm) break;
    if (!LeadsAlong(move, moves.first(m), pieces, kOnPathMm)) break;
  }
  return m;
}

// The greatest of `1.5,2,1.5`; 0 if there is no number.
double GreatestOf(std::string_view list) {
  double greatest = 0;
  while (!list.empty()) {
    const std::string_view one = list.substr(0, list.find_first_of(",;"));
    double value = 0;
    std::from_chars(one.data(), one.data() + one.size(), value);
    if (value > greatest) greatest = value;
    list.remove_prefix(std::min(one.size() + 1, list.size()));
  }
  return greatest;
}

}  // namespace

SlicerSettings ReadSettings(std::string_view text) {
  constexpr size_t kEnd = 1 << 18;
  const std::string_view head = text.substr(0, kEnd);
  const std::string_view tail = text.substr(text.size() - std::min(kEnd, text.size()));
  const auto first_of = [&](std::string_view one, std::string_view other) {
    for (const std::string_view part : {tail, head}) {
      for (const std::string_view name : {one, other}) {
        if (const std::string_view value = Setting(part, name); !value.empty()) return value;
      }
    }
    return std::string_view{};
  };
  SlicerSettings settings;
  const std::string_view top = first_of("top_fill_pattern", "top_surface_pattern");
  const std::string_view bottom = first_of("bottom_fill_pattern", "bottom_surface_pattern");
  settings.monotonic_top = top.empty() || top.starts_with("monotonic");
  settings.monotonic_bottom = bottom.starts_with("monotonic");
  settings.leads_around_walls =
      first_of("avoid_crossing_perimeters", "reduce_crossing_wall") == "1";
  // Prints are at most so far apart, heads no higher, and filament no thicker.
  constexpr double kMostStatedMm = 100;
  const auto take = [](double mm, double& stated_mm) {
    if (mm > 0 && mm <= kMostStatedMm) stated_mm = mm;
  };
  const StatedSettings stated = ReadStatedSettings(text);
  take(stated.filament_mm.value_or(0), settings.filament_mm);
  take(stated.head_reach_mm.value_or(0), settings.clearance_radius_mm);
  take(stated.head_above_tip_mm.value_or(0), settings.nozzle_height_mm);
  take(GreatestOf(first_of("extruder_clearance_radius", "extruder_clearance_max_radius")),
       settings.clearance_radius_mm);
  take(GreatestOf(first_of("nozzle_height", "nozzle_height")), settings.nozzle_height_mm);
  settings.least_layer_seconds = stated.least_layer_seconds.value_or(10);
  return settings;
}

LayerPair::LayerPair(const TraceChunk& was, const TraceChunk& is, size_t layer,
                     const WorkLimit& limit)
    : was_(was), is_(is), layer_(layer), limit_(limit), side_was_{was, true}, side_is_{is, false} {
  const TraceLayer& of_was = was.layers[layer];
  const TraceLayer& of_is = is.layers[layer];
  assert(of_was.end_section - of_was.first_section == of_is.end_section - of_is.first_section);
  // Where objects have changed places the original's sections are in the order of the other file.
  side_was_.first_path = UINT32_MAX;
  for (uint32_t s = of_was.first_section; s < of_was.end_section; ++s) {
    side_was_.first_path = std::min(side_was_.first_path, was.sections[s].first_path);
    side_was_.end_path = std::max(side_was_.end_path, was.sections[s].end_path);
  }
  side_is_.first_path = is.sections[of_is.first_section].first_path;
  side_is_.end_path = is.sections[of_is.end_section - 1].end_path;
  LearnFacts();
  LearnShapes();
  LearnIroning();
  std::vector<Piece> outer;
  for (const Piece& piece : pieces_) {
    if (Outer(piece.path)) outer.push_back(piece);
  }
  JoinEqual(outer);
  LeaveOutCrowds(outer);
  outer_walls_ = PieceTree(std::move(outer));
  Match();
}

void LayerPair::LearnFacts() {
  for (uint32_t path = first_path_was(); path < end_path_was(); ++path) {
    const TracePath& traced = was_.paths[path];
    Facts& facts = facts_.emplace_back();
    facts.first_piece = static_cast<uint32_t>(pieces_.size());
    AppendPieces(was_, path, pieces_);
    facts.piece_count = static_cast<uint32_t>(pieces_.size()) - facts.first_piece;
    facts.closed = IsClosed(was_, path);
    facts.path_class = traced.path_class;
    // Whether an overhanging wall is an outer one the rest of its loop tells, if that has a name.
    facts.outer =
        IsWallClass(traced.path_class) && (traced.outer || (traced.overhangs && !traced.inner));
  }
}

// A line out and back also ends where it began.
bool LayerPair::IsLoopToName(uint32_t path) const {
  const Facts& facts = FactsOf(path);
  const bool unsure =
      facts.path_class == PathClass::kUnnamed || facts.path_class == PathClass::kWall;
  return unsure && facts.closed && facts.piece_count > 2;
}

// Loops of files that do not name what they are of: a wall that has no other one on its outer side
// is an outer one. Slicers print outlines counter-clockwise and holes clockwise, so that the
// outside is on the right.
void LayerPair::LearnShapes() {
  std::vector<Piece> loops;
  for (const Piece& piece : pieces_) {
    if (IsLoopToName(piece.path)) loops.push_back(piece);
  }
  if (loops.empty()) return;
  JoinEqual(loops);
  const PieceTree tree(std::move(loops));
  for (uint32_t path = first_path_was(); path < end_path_was() && !Ended(); ++path) {
    if (!IsLoopToName(path)) continue;
    Facts& facts = facts_[path - first_path_was()];
    facts.outer = !IsInside(path, tree);
    facts.path_class = facts.outer ? PathClass::kOuterWall : PathClass::kInnerWall;
  }
}

// True if at most points of the loop another one lies beside it, on its right.
bool LayerPair::IsInside(uint32_t path, const PieceTree& loops) const {
  constexpr size_t kPlaces = 24;
  const absl::Span<const Piece> pieces = PiecesOf(path);
  const size_t step = std::max<size_t>(1, pieces.size() / kPlaces);
  double along = 0;
  double beside = 0;
  for (size_t i = 0; i < pieces.size(); i += step) {
    const Piece& piece = pieces[i];
    const double length = Distance(piece.a, piece.b);
    if (length <= 0) continue;
    const Point middle{(piece.a.x + piece.b.x) / 2, (piece.a.y + piece.b.y) / 2};
    const Point right{(piece.b.y - piece.a.y) / length, (piece.a.x - piece.b.x) / length};
    const Point from{middle.x + 0.02 * right.x, middle.y + 0.02 * right.y};
    const Point to{middle.x + kWallsApartMm * right.x, middle.y + kWallsApartMm * right.y};
    along += length;
    const auto of_other = [path](const Piece& other) { return other.path != path; };
    if (loops.AnyAcross(from, to, of_other)) beside += length;
  }
  return beside * 2 > along;
}

// Ironing that the file calls skin.
void LayerPair::LearnIroning() {
  std::vector<LaidPath> paths(facts_.size());
  bool asks = false;
  for (uint32_t path = first_path_was(); path < end_path_was(); ++path) {
    const PathClass path_class = ClassOf(path);
    LaidPath& laid = paths[path - first_path_was()];
    laid.asked = path_class == PathClass::kSkin || path_class == PathClass::kTop;
    laid.solid = laid.asked || path_class == PathClass::kBottom || IsWallClass(path_class);
    const bool apart = path_class == PathClass::kSkirt || path_class == PathClass::kSupport ||
                       path_class == PathClass::kInterface || path_class == PathClass::kTower ||
                       path_class == PathClass::kScript;
    if (!apart) laid.pieces = PiecesOf(path);
    laid.filament_per_mm = FlowOf(was_.paths[path]);
    asks |= laid.asked;
  }
  if (!asks) return;
  const std::vector<bool> over = LaidOver(paths, limit_);
  for (size_t i = 0; i < over.size(); ++i) {
    if (over[i]) facts_[i].path_class = PathClass::kIroning;
  }
}

void LayerPair::Match() {
  section_begin_.push_back(0);
  const size_t sections = was_.layers[layer_].end_section - was_.layers[layer_].first_section;
  for (size_t k = 0; k < sections; ++k) {
    const std::vector<Visit> visits = FindVisits(was_, SectionWas(k), is_, SectionIs(k), limit_);
    visits_.insert(visits_.end(), visits.begin(), visits.end());
    section_begin_.push_back(visits_.size());
  }
  for (const TraceMove& move : was_.MovesOfLinks(first_path_was(), end_path_was() + 1)) {
    known_.insert(move.identity);
  }
}

void LayerPair::FindTails() {
  for (LayerSide* side : {&side_was_, &side_is_}) {
    const uint32_t first = side->first_path;
    side->tails.assign(side->end_path - first + 1, 0);
    side->along = side->tails;
    const auto note = [side, first](uint32_t path, absl::Span<const Piece> pieces) {
      const uint32_t tail = TailMoves(side->chunk, path, pieces);
      side->tails[path + 1 - first] = tail;
      side->along[path + 1 - first] = AlongMoves(side->chunk, path, pieces, tail);
    };
    // The travel to the layer begins with moves along the last path of the layer before.
    if (first > 0) {
      std::vector<Piece> pieces;
      AppendPieces(side->chunk, first - 1, pieces);
      note(first - 1, pieces);
    }
    for (const Visit& visit : visits_) {
      if (!side->original) note(visit.last_path, PiecesOf(visit.path));
    }
    for (uint32_t path = first; side->original && path < side->end_path; ++path) {
      note(path, PiecesOf(path));
    }
  }
}

uint32_t LayerPair::OriginalLine(uint32_t path) const {
  const auto behind = std::ranges::upper_bound(visits_, path, {}, &Visit::first_path);
  assert(behind != visits_.begin());
  return was_.LineOf((behind - 1)->path);
}

LayerPair::Travel LayerPair::TravelOf(const TraceChunk& chunk, uint32_t link, bool open,
                                      uint32_t skipped) const {
  std::vector<const TraceMove*> moves;
  Travel travel;
  for (const TraceMove& move : chunk.MovesOf(link, skipped)) {
    if (move.kind != MoveKind::kTravel || move.open != open) continue;
    moves.push_back(&move);
    travel.length_mm += move.length_mm();
  }
  const double cut = std::min(kEndSlackMm, 0.2 * travel.length_mm);
  double at = 0;
  for (const TraceMove* move : moves) {
    const double own = move->length_mm();
    const double from = std::clamp(cut - at, 0.0, own);
    const double to = std::clamp(travel.length_mm - cut - at, 0.0, own);
    at += own;
    if (to <= from) continue;
    travel.moves.push_back(
        {Between(move->from, move->to, from / own), Between(move->from, move->to, to / own)});
  }
  return travel;
}

bool LayerPair::CrossesWalls(const Travel& travel) const {
  return std::ranges::any_of(travel.moves,
                             [this](const Piece& move) { return MeetsOuterWall(move.a, move.b); });
}

bool LayerPair::CrossesOuterWalls(const TraceChunk& chunk, uint32_t link, bool open) const {
  return !outer_walls_.empty() && CrossesWalls(TravelOf(chunk, link, open, 0));
}

double LayerPair::OpenLengthOverWalls(const TraceChunk& chunk, uint32_t link,
                                      uint32_t skipped) const {
  const Travel travel = TravelOf(chunk, link, true, skipped);
  const bool meets = CrossesWalls(travel) || TouchesWall(outer_walls_, travel.moves);
  return meets ? travel.length_mm : 0;
}

bool LayerPair::CrossesOuterWall(Point a, Point b) const {
  const double length = Distance(a, b);
  if (length <= 0) return false;
  const double share = std::min(kEndSlackMm / length, 0.2);
  return MeetsOuterWall(Between(a, b, share), Between(b, a, share));
}

bool LayerPair::MeetsOuterWall(Point a, Point b) const {
  return outer_walls_.AnyAcross(a, b, [](const Piece&) { return true; });
}

}  // namespace traverse::gcode

#include "client/gcode/verify/match/link_parts.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "client/gcode/verify/trace/trace.h"

namespace traverse::gcode {
namespace {

void AddMove(MoveKind kind, double x, double z, Micro filament, TraceChunk& chunk) {
  TraceMove move;
  move.kind = kind;
  move.from = chunk.moves.empty() ? Point{} : chunk.moves.back().to;
  move.to = {x, 0};
  move.z_from_mm = chunk.moves.empty() ? .2 : chunk.moves.back().z_to_mm;
  move.z_to_mm = z;
  move.filament = filament;
  move.feed = 100;
  move.in_print = true;
  chunk.moves.push_back(move);
}

// One link, to a path at .4 mm.
TraceChunk ChunkOf(const TraceChunk& moves) {
  TraceChunk chunk = moves;
  chunk.paths.emplace_back().z_mm = .4;
  chunk.links.push_back({0, static_cast<uint32_t>(chunk.moves.size())});
  chunk.links.emplace_back();
  return chunk;
}

// Travel that pulls back and primes on its way, so often.
TraceChunk Pulling(int times) {
  TraceChunk moves;
  for (int i = 0; i < times; ++i) {
    AddMove(MoveKind::kTravel, 1 + 9 * (i % 2), .2, 0, moves);
    AddMove(MoveKind::kRetraction, moves.moves.back().to.x, .2, -100, moves);
    AddMove(MoveKind::kPriming, moves.moves.back().to.x, .2, 100, moves);
  }
  return ChunkOf(moves);
}

// The same with lifts in place of travel.
TraceChunk Lifting(int times) {
  TraceChunk moves;
  for (int i = 0; i < times; ++i) {
    AddMove(MoveKind::kUp, 0, .6, 0, moves);
    AddMove(MoveKind::kRetraction, 0, .6, -100, moves);
    AddMove(MoveKind::kPriming, 0, .6, 100, moves);
    AddMove(MoveKind::kDown, 0, .2, 0, moves);
  }
  return ChunkOf(moves);
}

size_t CutsOf(const TraceChunk& chunk) { return LinkCutter(chunk, 0, 0).AllParts().size(); }

TEST(LinkCutter, CutsAtEachTravel) {
  EXPECT_EQ(CutsOf(Pulling(1)), 1u);
  EXPECT_EQ(CutsOf(Pulling(3)), 3u);
}

// Each way to cut a link is remembered with all its parts until both files are read: those of a
// link of many retractions would take the square of its size.
TEST(LinkCutter, CutsAHostileLinkNoMoreOftenThanALongOne) {
  EXPECT_EQ(CutsOf(Pulling(1000)), CutsOf(Pulling(10)));
  EXPECT_LE(CutsOf(Pulling(1000)), 4u);
  EXPECT_EQ(CutsOf(Lifting(1000)), CutsOf(Lifting(10)));
  EXPECT_LE(CutsOf(Lifting(1000)), 4u);
}

// The arrival at a scarf seam of a layer at .4 mm, from `from_mm`.
LinkPart ArrivalAtSeam(double from_mm) {
  TraceChunk moves;
  AddMove(MoveKind::kRetraction, 0, from_mm, -100, moves);
  moves.moves.back().z_from_mm = from_mm;
  AddMove(MoveKind::kUp, 0, 9, 0, moves);
  AddMove(MoveKind::kTravel, 20, 9, 0, moves);
  AddMove(MoveKind::kDown, 20, .4, 0, moves);
  AddMove(MoveKind::kPriming, 20, .4, 100, moves);
  AddMove(MoveKind::kDown, 20, .22, 0, moves);
  return LinkCutter(ChunkOf(moves), 0, 0).Parts().back();
}

TEST(KnownParts, TheArrivalAtAScarfSeamIsTheSameFromAnyHeight) {
  KnownParts known;
  known.Add(ArrivalAtSeam(.4));

  EXPECT_EQ(ArrivalAtSeam(8).role, LinkPart::kArrival);
  EXPECT_TRUE(known.Has(ArrivalAtSeam(.2)));
  EXPECT_TRUE(known.Has(ArrivalAtSeam(8)));
}

// What leads away from a path at `from_mm` to one at .4 mm: first up to that, where it is higher.
LinkPart DepartureFrom(double from_mm) {
  TraceChunk moves;
  AddMove(MoveKind::kUp, 0, .4, 0, moves);
  moves.moves.back().z_from_mm = from_mm;
  if (from_mm == .4) moves.moves.clear();
  AddMove(MoveKind::kRetraction, 0, .4, -100, moves);
  moves.moves.back().z_from_mm = .4;
  AddMove(MoveKind::kTravel, 20, .4, 0, moves);
  AddMove(MoveKind::kPriming, 20, .4, 100, moves);
  const auto parts = LinkCutter(ChunkOf(moves), 0, 0).Parts();
  const auto departs = [](const LinkPart& part) { return part.role == LinkPart::kDeparture; };
  return *std::find_if(parts.begin(), parts.end(), departs);
}

TEST(KnownParts, ADepartureToTheNextLayerIsTheSameWithinALayerWithoutTheWayUp) {
  KnownParts known;
  known.Add(DepartureFrom(.2));
  KnownParts within;
  within.Add(DepartureFrom(.4));

  EXPECT_EQ(DepartureFrom(.2).steps.size(), 2u);
  EXPECT_TRUE(known.Has(DepartureFrom(.4)));
  EXPECT_FALSE(within.Has(DepartureFrom(.2)));
}

}  // namespace
}  // namespace traverse::gcode

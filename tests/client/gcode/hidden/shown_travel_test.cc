// What Policy::kFast makes of travel in whole prints: which stays retracted since somebody would
// see it, which is open, and which is led around a wall. The verifier agrees with each of these
// files.

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"
#include "client/gcode/link/link_looks.h"
#include "client/gcode/plan/travel_rules.h"
#include "client/gcode/rewrite.h"
#include "client/gcode/verify/verifier.h"
#include "tests/client/gcode/support/read_text.h"
#include "tests/client/gcode/support/stack.h"

namespace traverse::gcode {
namespace {

using testing::Stack;

enum class Goes { kRetracted, kOpen, kBent };

std::string Name(Goes goes) {
  return goes == Goes::kRetracted ? "retracted" : goes == Goes::kOpen ? "open" : "bent";
}

std::string Fast(const std::string& text, double longest_mm = 30) {
  RewriteOptions options;
  options.policy = Policy::kFast;
  options.allow.max_hidden_travel_mm = longest_mm;
  const auto rewrite = RewriteGcode(*testing::Read(text), {}, options);
  EXPECT_TRUE(rewrite.ok()) << rewrite.status();
  EXPECT_EQ(rewrite->unproven, "");
  EXPECT_TRUE(CheckGcode(text, "a", rewrite->text, "b").ok());
  return rewrite->text;
}

// How travel goes, in layer `layer` of `text`, to the path that begins at `to`.
Goes GoesTo(const std::string& text, size_t layer, Point to) {
  const std::shared_ptr<GcodeFile> file = testing::Read(text);
  const RetractionHabit habit = HabitOfLooks(*file, 30);
  const std::vector<LinkLook> looks = LooksOfLinks(*file, layer, habit);
  for (size_t i = 0; i < looks.size(); ++i) {
    const Block& block = file->blocks[file->layers[layer].first_block + i];
    if (Distance(file->modes[block.mode].InMm(block.first), to) > 1e-3) continue;
    if (looks[i].retracts) return Goes::kRetracted;
    const double straight = Distance(
        file->modes[block.mode].InMm(file->blocks[file->layers[layer].first_block + i - 1].last),
        to);
    return static_cast<double>(block.travel_mm) > straight + 0.01 ? Goes::kBent : Goes::kOpen;
  }
  ADD_FAILURE() << "no path begins at " << to.x << " " << to.y;
  return Goes::kRetracted;
}

// Five layers of a box of 20 mm, the third of which is looked at: with `adds` to it, to the one
// below and to the one above it.
struct Case {
  std::string name;
  std::function<void(Stack&)> below;
  std::function<void(Stack&)> here;
  std::function<void(Stack&)> above;
  Point to;
  Goes goes;
};

void Box(Stack& stack) { stack.Box(0, 0, 20); }

// Three letters: what stands on top of the box.
void Text(Stack& stack) {
  for (const double x : {2.0, 8.0, 14.0}) stack.Box(x, 7, 5);
}

void WithHole(Stack& stack) { stack.Wall(8, 5, 4).Box(0, 0, 20); }

void Small(Stack& stack) { stack.Box(0, 0, 9); }

void Slotted(Stack& stack) {
  stack.Loop({0, 0, 20, 0, 20, 20, 12, 20, 12, 12, 8, 12, 8, 20, 0, 20});
  stack.Line(2, 17, 4).Line(14, 17, 4).Line(2, 4, 16).Line(2, 8, 16);
}

// In the box the travel to the second line leads from (18, 4) to (2, 10).
const Point kSecondLine{2, 10};

std::vector<Case> Cases() {
  return {
      {"inside", Box, Box, Box, kSecondLine, Goes::kOpen},
      {"leaves its wall", Box, Box, Box, {2, 4}, Goes::kOpen},
      {"top surface beside an island", Box, Box, Small, kSecondLine, Goes::kRetracted},
      {"top surface around text", Box, Box, Text, kSecondLine, Goes::kRetracted},
      {"overhang", Small, Box, Box, kSecondLine, Goes::kRetracted},
      {"bridge over a hole", WithHole, Box, Box, kSecondLine, Goes::kRetracted},
      {"hole that the next layer closes", Box, WithHole, Box, kSecondLine, Goes::kBent},
      {"hole that the next layer begins", Box, Box, WithHole, kSecondLine, Goes::kRetracted},
      {"around a hole", WithHole, WithHole, WithHole, kSecondLine, Goes::kBent},
      {"around a slot", Slotted, Slotted, Slotted, {14, 17}, Goes::kBent},
      {"around a slot that the layer above covers by half",
       Slotted,
       Slotted,
       Small,
       {14, 17},
       Goes::kRetracted},
      {"to a visible wall",
       Box,
       [](Stack& s) { s.Box(0, 0, 20).Wall(0, 0, 20); },
       Box,
       {0, 0},
       Goes::kRetracted},
      {"to another part",
       [](Stack& s) { s.Box(0, 0, 20).Box(30, 0, 20); },
       [](Stack& s) { s.Box(0, 0, 20).Box(30, 0, 20); },
       [](Stack& s) { s.Box(0, 0, 20).Box(30, 0, 20); },
       {30, 0},
       Goes::kRetracted},
      {"an outer wall that is open", Box, [](Stack& s) { s.Box(0, 0, 20).Corner(9, 6, 4); }, Box,
       kSecondLine, Goes::kRetracted},
      {"an outer wall that crosses itself", Box,
       [](Stack& s) {
         s.Loop({7, 3, 13, 11, 7, 11, 13, 3}).Box(0, 0, 20);
       },
       Box, kSecondLine, Goes::kRetracted},
      {"another tool", Box,
       [](Stack& s) { s.Box(0, 0, 20).Add("T1\n").Box(30, 0, 20).Add("T0\n"); }, Box, kSecondLine,
       Goes::kRetracted},
  };
}

// Slow retractions, so that detours are worth it.
std::string Slow(const std::string& text) {
  return absl::StrReplaceAll(text, {{"E-.8 F2100", "E-.8 F240"}, {"E.8 F2100", "E.8 F240"}});
}

std::string PrintOf(const Case& it) {
  Stack stack;
  Box(stack.Layer(0.2));
  it.below(stack.Layer(0.4));
  it.here(stack.Layer(0.6));
  it.above(stack.Layer(0.8));
  Box(stack.Layer(1));
  return Slow(stack.Text());
}

TEST(ShownTravel, StaysRetracted) {
  for (const Case& it : Cases()) {
    EXPECT_EQ(Name(GoesTo(Fast(PrintOf(it)), 2, it.to)), Name(it.goes)) << it.name;
  }
}

TEST(ShownTravel, OfTheFirstAndTheLastLayerStaysRetracted) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6, 0.8}) stack.Layer(z).Box(0, 0, 20);
  const std::string fast = Fast(stack.Text());
  for (const size_t layer : {0u, 3u}) {
    EXPECT_EQ(Name(GoesTo(fast, layer, kSecondLine)), "retracted");
  }
  for (const size_t layer : {1u, 2u}) EXPECT_EQ(Name(GoesTo(fast, layer, kSecondLine)), "open");
}

TEST(ShownTravel, LongerThanAllowedStaysRetracted) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(0, 0, 20);
  EXPECT_EQ(Name(GoesTo(Fast(stack.Text(), 18), 1, kSecondLine)), "open");
  EXPECT_EQ(Name(GoesTo(Fast(stack.Text(), 17), 1, kSecondLine)), "retracted");
  EXPECT_EQ(Name(GoesTo(Fast(stack.Text(), 0), 1, kSecondLine)), "retracted");
}

TEST(ShownTravel, IsLedAroundWallsOnlyWhereThatTakesLessTime) {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) Slotted(stack.Layer(z));
  EXPECT_EQ(Name(GoesTo(Fast(Slow(stack.Text())), 1, {14, 17})), "bent");
  EXPECT_EQ(Name(GoesTo(Fast(Slow(stack.Text()), 12), 1, {14, 17})), "retracted");
  EXPECT_EQ(Name(GoesTo(Fast(stack.Text()), 1, {14, 17})), "retracted");
}

std::string Boxes() {
  Stack stack;
  for (const double z : {0.2, 0.4, 0.6}) stack.Layer(z).Box(0, 0, 20);
  return stack.Text();
}

// What was found to be saved is what the file as written saves, around walls too.
TEST(ShownTravel, IsForecastAsItIsWritten) {
  Stack slotted;
  for (const double z : {0.2, 0.4, 0.6}) Slotted(slotted.Layer(z));
  for (const std::string& text : {Boxes(), Slow(slotted.Text())}) {
    RewriteOptions options;
    options.policy = Policy::kFast;
    const auto fast = RewriteGcode(*testing::Read(text), {}, options);
    ASSERT_TRUE(fast.ok()) << fast.status();
    const double saved = fast->before.seconds - fast->after.seconds;
    ASSERT_GT(saved, 0.005 * fast->before.seconds);
    EXPECT_NEAR((fast->forecast.given_seconds - fast->forecast.seconds) / saved, 1, 0.02);
  }
}

// With E counted on from the beginning.
std::string WithAbsoluteE(const std::string& text) {
  std::string out;
  double e = 0;
  for (size_t at = 0; at < text.size();) {
    const size_t end = text.find('\n', at) + 1;
    std::string line = text.substr(at, end - at);
    at = end;
    const size_t word = line.find(" E");
    if (line[0] == 'G' && word != std::string::npos) {
      size_t length = 0;
      e += std::stod(line.substr(word + 2), &length);
      line.replace(word + 2, length, absl::StrFormat("%.5f", e));
    }
    out += line == "M83\n" ? "M82\n" : line;
  }
  return out;
}

TEST(ShownTravel, IsToldApartHoweverFilamentIsCounted) {
  const std::string firmware =
      absl::StrReplaceAll(Boxes(), {{"G1 E-.8 F2100", "G10"}, {"G1 E.8 F2100", "G11"}});
  for (const std::string& text : {Boxes(), WithAbsoluteE(Boxes()), firmware}) {
    const std::string fast = Fast(text);
    EXPECT_EQ(Name(GoesTo(fast, 1, kSecondLine)), "open");
    EXPECT_EQ(Name(GoesTo(fast, 0, kSecondLine)), "retracted");
  }
}

// Each retraction is part of what is printed.
TEST(ShownTravel, StaysRetractedWherePrimesPushMoreOrLess) {
  for (const char* prime : {"G1 E.82 F2100", "G1 E.78 F2100"}) {
    const std::string text = absl::StrReplaceAll(Boxes(), {{"G1 E.8 F2100", prime}});
    EXPECT_EQ(Name(GoesTo(Fast(text), 1, kSecondLine)), "retracted") << prime;
  }
}

// Firmware pulls filament back in the third layer, and never pushes it again.
TEST(ShownTravel, StaysRetractedWhereTheNozzleCountsAsClosed) {
  std::string text = PrintOf(Cases()[0]);
  text.insert(text.find("G1 E-.8", text.find("Z0.6")), "G10\n");
  const std::string fast = Fast(text);
  EXPECT_EQ(Name(GoesTo(fast, 1, kSecondLine)), "open");
  EXPECT_EQ(Name(GoesTo(fast, 3, kSecondLine)), "retracted");
}

// Loops that are called infill are no walls; where nothing has a name, all loops are.
TEST(ShownTravel, StaysRetractedWithinWallsThatAreNotKnown) {
  const std::string misnamed = absl::StrReplaceAll(Boxes(), {{";TYPE:External perimeter\n", ""}});
  EXPECT_EQ(Name(GoesTo(Fast(misnamed), 1, kSecondLine)), "retracted");
  const std::string unnamed = absl::StrReplaceAll(misnamed, {{";TYPE:Internal infill\n", ""}});
  EXPECT_EQ(Name(GoesTo(Fast(unnamed), 1, kSecondLine)), "open");
}

TEST(ShownTravel, OfLayersOfOnePathAndOfManyIslands) {
  Stack one;
  for (const double z : {0.2, 0.4, 0.6}) one.Layer(z).Wall(0, 0, 20);
  EXPECT_EQ(Fast(one.Text()), one.Text());
  Stack many;
  for (const double z : {0.2, 0.4, 0.6}) {
    many.Layer(z);
    for (int i = 0; i < 100; ++i) many.Box(25 * (i % 10), 25 * (i / 10), 20);
  }
  const std::string fast = Fast(many.Text());
  for (const int i : {0, 45, 99}) {
    const double x = 25 * (i % 10);
    const double y = 25 * (i / 10);
    EXPECT_EQ(Name(GoesTo(fast, 1, {x + 2, y + 10})), "open");
    if (i == 0) continue;
    EXPECT_EQ(Name(GoesTo(fast, 1, {x, y})), "retracted");
  }
}

// Slicers may go short ways slowly, and short ways alone are open in the file.
TEST(ShownTravel, WhatIsHiddenGoesAsItWouldIfItWereSeen) {
  Stack stack;
  stack.Add("M204 S2000\n");
  for (const double z : {.2, .4, .6, .8, 1.}) {
    stack.Layer(z).Wall(0, 0, 20).Line(2, 4, 16).Line(18.4, 4, 1).Line(2, 10, 16).Line(2, 16, 16);
  }
  const std::string text = absl::StrReplaceAll(
      stack.Text(),
      {{Stack::Retracted(18.4, 4), "M204 S500\n" + Stack::Open(18.4, 4) + "M204 S2000\n"}});
  ASSERT_NE(text, stack.Text());

  const std::string fast = Fast(text);

  EXPECT_EQ(GoesTo(text, 2, kSecondLine), Goes::kRetracted);
  EXPECT_EQ(GoesTo(fast, 2, kSecondLine), Goes::kOpen);
  const std::vector<std::string> in_file = absl::StrSplit(text, "M204 S500\n");
  const std::vector<std::string> in_fast = absl::StrSplit(fast, "M204 S500\n");
  EXPECT_EQ(in_fast.size(), in_file.size()) << fast;
}

}  // namespace
}  // namespace traverse::gcode

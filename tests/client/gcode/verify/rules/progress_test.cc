// Lines that tell how far the print is: client/gcode/verify/rules/progress.

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

TEST(VerifyProgress, KeepsItsSequence) {
  const std::string a = kHead + "M73 P1\n" + kSquare + "M73 P2\n" + kZigzag;
  EXPECT_EQ(
      Broken(a, With(With(With(a, "M73 P1", "M73 P3"), "M73 P2", "M73 P1"), "M73 P3", "M73 P2")),
      "progress");
  EXPECT_EQ(Broken(a, kHead + "M73 P1\nM73 P2\n" + kSquare + kZigzag), "");
}

// Behind all that a printer does, too.
TEST(VerifyProgress, KeepsTheTimesThatTheFileEndsWith) {
  const std::string a = kHead + kSquare + kZigzag + "; printing time = 4m 0s\n";
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "4m", "5m")), "progress");
  EXPECT_EQ(Broken(a, With(a, "; printing time = 4m 0s\n", "")), "progress");
  EXPECT_EQ(Broken(a, a + "; printing time = 5m 0s\n"), "progress");
  EXPECT_EQ(Broken(a, a + "M73 P100\n"), "progress");
}

// `count` lines of 10 mm beside each other; before the second one of each pair stands "M73 P" with
// the share that is printed then.
std::vector<std::string> Lines(int count) {
  std::vector<std::string> lines;
  for (int i = 0; i < count; ++i) {
    lines.push_back(absl::StrCat("G1 X0 Y", 2 * i, " F9000\n",
                                 i % 2 == 1 ? absl::StrCat("M73 P", 100 * i / count, "\n") : "",
                                 ";TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n"));
  }
  return lines;
}

std::string Joined(const std::vector<std::string>& lines) {
  std::string text = kHead;
  for (const std::string& line : lines) text += line;
  return text;
}

constexpr uint32_t kRules = RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kProgress);

TEST(VerifyProgress, StandsWhereItIsTrue) {
  const std::string a = Joined(Lines(20));
  std::vector<std::string> lines = Lines(20);
  std::string marks;
  for (std::string& line : lines) {
    const size_t at = line.find("M73");
    if (at == std::string::npos) continue;
    const size_t end = line.find('\n', at) + 1;
    marks += line.substr(at, end - at);
    line.erase(at, end - at);
  }
  std::vector<std::string> late = lines;
  late.back().insert(0, marks);
  std::vector<std::string> early = lines;
  early.front().insert(0, marks);

  EXPECT_EQ(Broken(a, Joined(late), {}, kRules), "progress");
  EXPECT_EQ(Broken(a, Joined(early), {}, kRules), "progress");
  EXPECT_EQ(Broken(a, a, {}, kRules), "");
}

TEST(VerifyProgress, IsToldInManyWays) {
  for (const char* line : {"M117 50%\n", "M118 Half of it, 50 % done\n", "; elapsed time: 20\n",
                           "SET_DISPLAY_TEXT MSG=\"time left 20s\"\n", "M532 X50 L1\n"}) {
    std::vector<std::string> lines = Lines(20);
    for (std::string& other : lines) {
      if (const size_t at = other.find("M73"); at != std::string::npos) {
        other.erase(at, other.find('\n', at) + 1 - at);
      }
    }
    std::vector<std::string> true_there = lines;
    true_there[10].insert(0, line);
    std::vector<std::string> late = lines;
    late.back().insert(0, line);

    EXPECT_EQ(Broken(Joined(true_there), Joined(late), {}, kRules), "progress") << line;
    EXPECT_EQ(Broken(Joined(true_there), Joined(true_there), {}, kRules), "") << line;
  }
}

TEST(VerifyProgress, MayBeAsFarOffAsInTheOriginal) {
  std::vector<std::string> lines = Lines(20);
  lines[11] = With(lines[11], "M73 P55\n", "M73 P20\n");
  const std::string a = Joined(lines);
  std::swap(lines[4], lines[6]);

  EXPECT_EQ(Broken(a, Joined(lines), {}, kRules), "");
}

// Half of the file is its end script: a share may be one of either.
TEST(VerifyProgress, MayCountTheEndScript) {
  const auto print = [](int seconds, int before) {
    std::string text = kHead;
    for (int i = 0; i < 10; ++i) {
      absl::StrAppend(&text, i == before ? "; elapsed time: 5\n" : "", "G1 X0 Y", 2 * i, " F",
                      i == 9 ? 600.0 / seconds : 600000.0,
                      "\n;TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n");
    }
    return text + "G1 X160 F600\n";  // 15 s
  };
  const std::string a = print(6, 5);

  EXPECT_EQ(Broken(a, print(1, 4), {}, RuleBit(VerifyRule::kProgress)), "");  // of the file
  EXPECT_EQ(Broken(a, print(1, 3), {}, RuleBit(VerifyRule::kProgress)), "");  // of the print
  EXPECT_EQ(Broken(a, print(1, 1), {}, RuleBit(VerifyRule::kProgress)), "progress");
  EXPECT_EQ(Broken(a, print(1, 7), {}, RuleBit(VerifyRule::kProgress)), "progress");
}

// The layer before saves more than the others: a line at the begin of its section, which all
// paths keep, is late there. Elsewhere in between it is no farther off.
TEST(VerifyProgress, MayStandBetweenItsPlaceAndWhereItIsTrue) {
  const auto print = [](int seconds, int before) {
    std::string text = kHead;
    for (int i = 0; i < 20; ++i) {
      absl::StrAppend(&text, i == 10 ? ";LAYER_CHANGE\nG1 Z.4 F9000\n" : "", "G1 X0 Y", 2 * i, " F",
                      i == 15 ? 600.0 / seconds : 600000.0, "\n", i == before ? "M73 P25\n" : "",
                      ";TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n");
    }
    return text;
  };
  const std::string a = print(20, 10);

  EXPECT_EQ(Broken(a, print(1, 10), {}, kRules), "");
  EXPECT_EQ(Broken(a, print(1, 7), {}, kRules), "");
  EXPECT_EQ(Broken(a, print(1, 5), {}, kRules), "");
  EXPECT_EQ(Broken(a, print(1, 4), {}, kRules), "progress");
  EXPECT_EQ(Broken(a, print(1, 12), {}, kRules), "progress");
}

// A line of 10 mm with a place on either side of it, and none within it.
TEST(VerifyProgress, StandsWhereNoPlaceIsNearer) {
  const auto print = [](int seconds, int before) {
    std::string text = kHead;
    for (int i = 0; i < 8; ++i) {
      absl::StrAppend(&text, "G1 X0 Y", 2 * i, " F", i == 7 ? 600.0 / seconds : 600000.0, "\n",
                      i == before ? "; elapsed time: 4\n" : "",
                      ";TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n");
    }
    return text;
  };
  const std::string a = print(6, 4);  // at 4 of 14 s: 2.5 of 8.7

  EXPECT_EQ(Broken(a, print(1, 2), {}, kRules), "");
  EXPECT_EQ(Broken(a, print(1, 3), {}, kRules), "");
  EXPECT_EQ(Broken(a, print(1, 1), {}, kRules), "progress");
  EXPECT_EQ(Broken(a, print(1, 5), {}, kRules), "progress");
}

TEST(VerifyProgress, MayStandBetweenTheSegmentsOfAPath) {
  const std::string line = "G1 X0 Y0 F9000\n;TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n";
  const std::string path = "G1 X0 Y5 F9000\n;TYPE:Internal infill\nG1 F600\nG1 X10 E.3\n";
  const std::string half = "G1 X20 E.3\n";

  EXPECT_EQ(
      Broken(kHead + line + path + "M73 P66\n" + half, kHead + path + "M73 P66\n" + half + line, {},
             kRules | RuleBit(VerifyRule::kCommands)),
      "progress");
  EXPECT_EQ(
      Broken(kHead + path + half + "M73 P66\n" + line, kHead + line + path + "M73 P66\n" + half, {},
             kRules | RuleBit(VerifyRule::kCommands)),
      "");
}

// Nothing but its first deposit shows that a layer has begun.
TEST(VerifyProgress, BehindTheMarkOfALayerBelongsToIt) {
  const std::string next = ";LAYER_CHANGE\nG1 Z.4 F9000\n";
  std::vector<std::string> lines = Lines(20);
  std::string marks;
  for (std::string& line : lines) {
    const size_t at = line.find("M73");
    if (at == std::string::npos) continue;
    const size_t end = line.find('\n', at) + 1;
    marks += line.substr(at, end - at);
    line.erase(at, end - at);
  }
  const auto first = [&lines](const std::string& before) {
    return With(Joined(lines), ";TYPE", before + ";TYPE");
  };
  const std::string low = "G1 X0 Y0 F9000\n;TYPE:Internal infill\nG1 F600\nG1 X1 E.03\n";
  const std::string a = kHead + low + next + Joined(Lines(20)).substr(kHead.size());
  const std::string b = kHead + low + next + first(marks).substr(kHead.size());

  EXPECT_EQ(Broken(a, b, {}, kRules), "progress");
  EXPECT_EQ(Broken(a, a, {}, kRules), "");
}

}  // namespace
}  // namespace traverse::gcode

// Retractions as parts of travel, and all primes together:
// client/gcode/verify/rules/{retractions,travel/made_of_parts}.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_replace.h"
#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints
using ::testing::HasSubstr;

constexpr uint32_t kRules = RuleBit(VerifyRule::kSamePrint) | RuleBit(VerifyRule::kMadeOfParts) |
                            RuleBit(VerifyRule::kRetractions) | RuleBit(VerifyRule::kStandstill);

std::string Broken(const std::string& original, const std::string& optimised,
                   Policy policy = Policy::kSafe) {
  VerifyPermissions permissions;
  permissions.policy = policy;
  return testing::Broken(original, optimised, permissions, kRules);
}

TEST(VerifyRetractions, AreNoDeeperAndPairsOfTheOriginal) {
  const std::string deeper =
      With(kTwo, Travel("X0 Y5"), "G1 E-1.8 F2100\nG1 X0 Y5 F9000\nG1 E1.8 F2100\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + deeper), "made_of_parts");
  const std::string uneven =
      With(kTwo, Travel("X0 Y5"), "G1 E-.8 F2100\nG1 X0 Y5 F9000\nG1 E.8 F2100\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + uneven), "made_of_parts");
}

// Where a tool is unloaded it is pulled back and pushed more than once.
TEST(VerifyRetractions, NoPartOfOneIsMissing) {
  const std::string a = kHead + kTwo + "G1 E-5 F2100\nG1 E2 F2000\nG1 E-9 F2100\nT1\n" +
                        "G1 E12 F2100\n" + Line("Internal infill", "X0 Y9", "X9 Y9");
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_NE(testing::Broken(a, With(a, "G1 E2 F2000\n", ""), Policy::kFree), "");
}

// 0.1 um each: the pair passes for the same one.
TEST(VerifyRetractions, PrimeNoMoreAllInAll) {
  std::string a = kHead;
  std::string more = kHead;
  for (int y = 0; y < 200; ++y) {
    const std::string line =
        Line("Internal infill", absl::StrCat("X0 Y", y), absl::StrCat("X9 Y", y));
    a += line;
    more += With(line, "G1 E1 F2100\n", "G1 E1.0001 F2100\n");
  }
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, "G1 E1 F2100\n", "G1 E1.0001 F2100\n")), "");
  EXPECT_EQ(Broken(a, more), "retractions");
  EXPECT_EQ(Broken(more, a), "retractions");
}

// Where more links retract than in the original, of which each returns just what it took.
TEST(VerifyRetractions, PrimeNoMoreInLinksThatDidNotRetract) {
  std::string a = kHead;
  std::string b = kHead;
  for (int y = 0; y < 200; ++y) {
    const std::string to = absl::StrCat("X0 Y", y);
    const std::string line = Line("Internal infill", to, absl::StrCat("X9 Y", y));
    a += y % 10 == 0 ? line : With(line, Travel(to), "G1 " + to + " F9000\n");
    b += line;
  }
  const auto primed = [&b](const std::string& amount) {
    return absl::StrReplaceAll(b, {{"G1 E1 F2100\n", "G1 E" + amount + " F2100\n"}});
  };
  EXPECT_EQ(Broken(a, b), "");
  EXPECT_EQ(Broken(a, primed("1.0001")), "retractions");
  EXPECT_EQ(Broken(a, primed("1.00001")), "");
}

TEST(VerifyRetractions, MayBeMoreOrFewer) {
  const std::string fewer = With(kOneTurned, Travel("X0 Y5"), "G1 X0 Y5 F9000\n");
  const std::string third =
      "G1 X0 Y6 F9000\nG1 F1800\nG1 X9 Y6 E.3\n" + Line("Internal infill", "X0 Y8", "X9 Y8");
  EXPECT_EQ(Broken(kHead + kTwo + third, kHead + fewer + third), "");
  EXPECT_EQ(Broken(kHead + fewer + third, kHead + kOneTurned + third), "");
  // Where no way is open, none is to be.
  EXPECT_EQ(testing::Broken(kHead + kTwo, kHead + fewer), "open_travel");
}

// CuraEngine primes a little before some paths.
TEST(VerifyRetractions, PrimeNoEarlierThanTheFileDoes) {
  const auto early = [](const std::string& at) {
    return With(kTwo, Travel("X0 Y5"),
                "G1 E-1 F2100\nG1 " + at + " F9000\nG1 E1 F2100\nG1 X0 Y5 F9000\n");
  };
  const std::string next = kNextLayer + early("X.27 Y4.85");
  const std::string a = kHead + early("X.18 Y4.9") + next;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, kHead + early("X.225 Y4.875") + next), "");
  EXPECT_THAT(Broken(a, kHead + early("X.72 Y4.6") + next), HasSubstr("made_of_parts"));
}

// CuraEngine primes where another travel begins, and retracts again for that one: what it primes
// for a path it primes there.
TEST(VerifyRetractions, FilamentForAPathComesBackWhereItBegins) {
  const auto twice = [](const std::string& end) {
    return With(
        kTwo, Travel("X0 Y5"),
        "G1 E-1 F2100\nG1 X.36 Y4.8 F9000\nG1 E1 F2100\nG1 X0 Y5 F9000\nG1 E-1 F2100\n" + end);
  };
  const std::string a = kHead + twice("G1 E1 F2100\n") + kNextLayer + kTwo;
  EXPECT_EQ(Broken(a, a), "");
  const std::string early = "G1 E-1 F2100\nG1 X.36 Y4.8 F9000\nG1 E1 F2100\nG1 X0 Y5 F9000\n";
  EXPECT_EQ(
      Broken(a, kHead + twice("G1 E1 F2100\n") + kNextLayer + With(kTwo, Travel("X0 Y5"), early)),
      "made_of_parts");
}

// What the firmware primes is not what the extruder pulled.
TEST(VerifyRetractions, AreUndoneByWhatDidThem) {
  const std::string both = With(Travel("X0 Y5"), "G1 E1 F2100\n", "G11\nG1 E1 F2100\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Travel("X0 Y5"), both)), "made_of_parts");
}

TEST(VerifyRetractions, TheLastOneIsNoDeeper) {
  const std::string end = "G1 E-1 F2100\nM104 S0\nM84\n";
  EXPECT_EQ(Broken(kHead + kTwo + end, kHead + kTwo + With(end, "E-1", "E-1.9")), "made_of_parts");
  EXPECT_EQ(Broken(kHead + kTwo + end, kHead + kOneTurned + end), "");
}

// A loop ends where it began: what is pulled back there and pushed before it is in one place.
TEST(VerifyRetractions, AreForAWay) {
  const std::string on = Travel("X5 Y10") + ";TYPE:Internal infill\nG1 F1800\nG1 X0 Y10 E.3\n";
  const std::string a = kHead + Line("Internal infill", "X0 Y5", "X9 Y5") + kSquare + on;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, kWall, "G1 E-1\nG1 E1\n" + kWall)), "made_of_parts");
}

TEST(VerifyRetractions, AreMeasuredInInchesAsInMillimetres) {
  const std::string a =
      With("G20\n" + kHead + kTwo, Travel("X0 Y5"), "G1 E-.04 F80\nG1 X0 Y5 F350\nG1 E.04 F80\n");
  EXPECT_EQ(Broken(a, a), "");
  // By 0.0025 mm.
  EXPECT_THAT(Broken(a, With(a, "G1 E.04", "G1 E.0399")), HasSubstr("made_of_parts"));
  // By 0.0005 mm, which is how words in inches are rounded.
  EXPECT_EQ(Broken(a, With(a, "G1 E.04", "G1 E.03998")), "");
}

TEST(VerifyRetractions, AreDoneBeforeTheTravelAndUndoneBehindIt) {
  const std::string pushed_halfway =
      "G1 E-1 F2100\nG1 X4.5 Y2.5 F9000\nG1 E.5 F2100\nG1 X0 Y5 F9000\nG1 E.5 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Travel("X0 Y5"), pushed_halfway)),
            "made_of_parts");
  const std::string pulled_halfway = "G1 X4 Y2 F9000\nG1 E-1 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  EXPECT_THAT(Broken(kHead + kTwo, kHead + With(kTwo, Travel("X0 Y5"), pulled_halfway)),
              HasSubstr("made_of_parts"));
  const std::string half_pulled =
      "G1 E-.5 F2100\nG1 X4.5 Y2.5 F9000\nG1 E-.5 F2100\nG1 X0 Y5 F9000\nG1 E1 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Travel("X0 Y5"), half_pulled)),
            "made_of_parts");
  EXPECT_EQ(Broken(kHead + With(kTwo, Travel("X0 Y5"), half_pulled),
                   kHead + With(kTwo, Travel("X0 Y5"), half_pulled)),
            "");
}

TEST(VerifyRetractions, AreForAWayAlone) {
  const std::string idle = Travel("X0 Y5") + "G1 E-1 F2100\nG1 E1 F2100\n";
  EXPECT_EQ(Broken(kHead + kTwo, kHead + With(kTwo, Travel("X0 Y5"), idle)), "made_of_parts");
  const std::string one_idle = With(kTwo, Travel("X0 Y5"), idle);
  EXPECT_EQ(Broken(kHead + one_idle, kHead + one_idle), "");
}

TEST(VerifyRetractions, FilamentIsPulledBackOnTheSameSideOfALabel) {
  const std::string travel = Travel("X0 Y5");
  const std::string inside =
      "G1 E-1 F2100\n; stop printing object a\n" + With(travel, "G1 E-1 F2100\n", "");
  const std::string outside = "; stop printing object a\n" + travel;
  const std::string a = kHead + With(kTwo, travel, inside);
  const std::string b = kHead + With(kTwo, travel, outside);
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, b), "retractions");
  EXPECT_EQ(Broken(b, a), "retractions");
}

TEST(VerifyRetractions, AreNotDoneInMoreParts) {
  const std::string pull = "G1 E-1 F2100\nG1 X0 Y5 F9000\n";
  const std::string halves = "G1 E-.5 F2100\nG1 E-.5\nG1 X0 Y5 F9000\n";
  const std::string push = "G1 X0 Y5 F9000\nG1 E1 F2100\n";
  const std::string a = kHead + kTwo + Line("Internal infill", "X0 Y8", "X9 Y8");
  const std::string in_parts = With(a, pull, halves);
  EXPECT_EQ(Broken(a, in_parts), "made_of_parts");
  EXPECT_EQ(Broken(a, With(a, push, "G1 X0 Y5 F9000\nG1 E.5 F2100\nG1 E.5\n")), "made_of_parts");
  EXPECT_EQ(Broken(in_parts, in_parts), "");
  EXPECT_EQ(Broken(in_parts, a), "");
  // Nor do others, and scripts, tell anything of it.
  const std::string longer = "G1 E-2 F2100\nG1 E-1\nG1 X0 Y0 F9000\nG1 E3 F2100\n" +
                             std::string(";TYPE:Internal infill\nG1 F1800\nG1 X9 Y0 E.3\n");
  EXPECT_EQ(Broken(a + longer, in_parts + longer), "made_of_parts");
  const std::string script = "M976\nG1 E-.5 F2100\nG1 E-.5\nG1 E1\n";
  EXPECT_THAT(Broken(a + script + kTwo, in_parts + script + kTwo), HasSubstr("made_of_parts"));
}

}  // namespace
}  // namespace traverse::gcode

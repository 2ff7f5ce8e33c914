// Verifying: client/gcode/verify.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "absl/strings/str_replace.h"
#include "client/gcode/read/reader.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/mutation.h"
#include "tests/client/gcode/support/random_order.h"
#include "tests/client/gcode/support/samples.h"
#include "tests/client/gcode/support/verified.h"

namespace traverse::gcode {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// What is printed, and nothing of how: rules/ has the other rules.
std::string Difference(const std::string& original, const std::string& optimised) {
  return std::string(VerifyGcode(original, "a", optimised, "b", OnlySamePrint()).message());
}

// `text` with the first `from` replaced.
std::string With(std::string text, const std::string& from, const std::string& to) {
  const size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return text.replace(at, from.size(), to);
}

const std::string kPrusa = testing::kPrusaSample;
const std::string kCura = testing::kCuraSample;

TEST(VerifyGcode, CatchesAHundredMutations) {
  const std::vector<std::string> names = {"ps_brackets24_rel_labels", "ps_clusters13_brim_skirt",
                                          "ps_hooks_support_bridge", "sl_vase_rack_restart_extra"};
  std::vector<std::string> originals;
  VerifyOptions options;
  options.permissions = VerifyPermissions{VerifyPermissions::Policy::kFree};
  for (const std::string& path : testing::KeptFiles()) {
    if (std::find(names.begin(), names.end(), testing::NameOf(path)) == names.end()) continue;
    originals.push_back(testing::TextOf(path));
    const std::string& text = originals.back();
    ASSERT_EQ(VerifyGcode(text, "a", text, "b", options), absl::OkStatus());
  }
  ASSERT_EQ(originals.size(), names.size());

  for (uint64_t seed = 1; seed <= 100; ++seed) {
    const size_t file = seed % originals.size();
    const testing::Mutation mutation = testing::Mutate(originals[file], seed);
    EXPECT_FALSE(VerifyGcode(originals[file], "a", mutation.text, "b", options).ok())
        << "seed " << seed << ", " << names[file] << ": " << mutation.what;
  }
}

TEST(VerifyGcode, ATextPrintsWhatItPrints) {
  EXPECT_EQ(Difference(kPrusa, kPrusa), "");
  EXPECT_EQ(Difference(kCura, kCura), "");
  EXPECT_EQ(Difference("", ""), "");
  EXPECT_EQ(Difference(kPrusa, testing::WithCrLf(kPrusa)), "");
}

// The second line after the change pushes 1 mm, whether its register counts on or anew.
TEST(VerifyGcode, RegistersCountOnInOtherUnits) {
  const std::string head = "M82\nG1 F100\nG20\nG1 X1 Y0 E.1 F100\nG21\n";
  EXPECT_EQ(Difference(head + "G1 X30 Y0 E3.54\n", head + "G92 E0\nG1 X30 Y0 E1\n"), "");
  EXPECT_NE(Difference(head + "G1 X30 Y0 E3.54\n", head + "G92 E0\nG1 X30 Y0 E3.44\n"), "");
}

TEST(VerifyGcode, NamesBothLines) {
  const std::string changed = With(kPrusa, "G1 X40 Y30 E.4", "G1 X40 Y30 E.5");

  EXPECT_EQ(Difference(kPrusa, changed),
            "b:34: lines 6 to 42 of a do not print `G1 X40 Y30 E.5` under the same conditions");
}

TEST(VerifyGcode, DirectionAndOrderWithinASectionAreFree) {
  const std::string a = "M83\nG1 F600 X1 E1\nG0 X5\nG1 X6 E1\n";
  const std::string b = "M83\nG1 F600\nG0 X6\nG1 X5 E1\nG0 X1\nG1 X0 E1\n";

  EXPECT_EQ(Difference(a, b), "");
}

TEST(VerifyGcode, ArcsMayTurnRound) {
  const std::string a = "M83\nG1 F600\nG2 X10 Y0 I5 J0 E1\n";
  const std::string b = "M83\nG1 F600\nG0 X10\nG3 X0 Y0 I-5 J0 E1\n";
  const std::string other_side = "M83\nG1 F600\nG0 X10\nG2 X0 Y0 I-5 J0 E1\n";

  EXPECT_EQ(Difference(a, b), "");
  EXPECT_THAT(Difference(a, other_side), HasSubstr("b:4"));
}

// Found by fuzzing: from its other end such an arc has another radius, and lies elsewhere.
TEST(VerifyGcode, ArcsThatEndBesideTheirCircleMayNotTurnRound) {
  const std::string a = "M83\nG1 F600\nG0 X30\nG2 X0 Y0 I-3 J0 E1\n";
  const std::string b = "M83\nG1 F600\nG3 X30 Y0 I27 J0 E1\n";

  EXPECT_THAT(Difference(a, b), HasSubstr("b:3"));
  const auto file = ReadGcode(a + "G0 X5\nG1 X6 E1\n", "a");
  ASSERT_TRUE(file.ok());
  EXPECT_NE((*file)->blocks[0].flags & kBlockPinned, 0);
}

TEST(VerifyGcode, NothingCrossesALineThatIsNotKnown) {
  const std::string a = "M83\nG1 F600 X1 E1\nM600\nG1 X5\nG1 X6 E1\n";
  const std::string b = "M83\nG1 F600\nG0 X5\nG1 X6 E1\nM600\nG0 X0\nG1 X1 E1\n";

  EXPECT_THAT(Difference(a, b), HasSubstr("b:4: lines 2 to 3 of a do not print `G1 X6 E1`"));
}

TEST(VerifyGcode, AtALineThatIsNotKnownTheHeadIsWhereItWas) {
  const std::string a = "M83\nG1 F600 X1 Y0 E1\nG0 X5 Y5\nG1 Z5\nPARK\nG1 Z0\nG0 X7 Y0\nG1 X8 E1\n";

  for (const auto& [there, elsewhere] :
       {std::pair("X5 Y5", "X6 Y5"), std::pair("X5 Y5", "X5 Y6"), std::pair("Z5", "Z6")}) {
    EXPECT_THAT(Difference(a, With(a, there, elsewhere)), HasSubstr("b:5: the head is elsewhere"))
        << elsewhere;
  }
  EXPECT_THAT(Difference(a, With(a, "PARK", "G1 E-1\nPARK\nG1 E1")),
              HasSubstr("b:6: the retraction differs from that at a:5"));
}

TEST(VerifyGcode, FencesKeepTheirOrderAndCommentsTheirSection) {
  const std::string a = "M83\nM104 S200\nG1 F600 X1 E1\n; note\nM104 S210\nG0 X2\nG1 X3 E1\n";

  EXPECT_THAT(Difference(a, With(a, "M104 S210\n", "")), HasSubstr("a"));
  EXPECT_THAT(Difference(a, With(a, "S210", "S211")),
              HasSubstr("b:5: a different line from the one at a:5"));
  EXPECT_THAT(Difference(a, With(a, "; note\nM104 S210\n", "M104 S210\n; note\n")),
              HasSubstr("`; note`"));
}

// The first path of a layer may bring its comment along, whichever it was in the original.
TEST(VerifyGcode, CommentsAtAChangeOfHeightBelongToWhatComesAfterIt) {
  const std::string down = "M83\nG1 F600 X1 E1\nG0 X2\nG1 X3 E1\n";
  const std::string a = down + "G1 Z1\nG0 X5\nG1 X6 E1\n; note\nG0 X8\nG1 X9 E1\n";
  const std::string b = down + "G1 Z1\n; note\nG0 X9\nG1 X8 E1\nG0 X6\nG1 X5 E1\n";

  EXPECT_EQ(Difference(a, b), "");
  EXPECT_EQ(Difference(b, a), "");
  EXPECT_THAT(Difference(b, With(With(b, "; note\n", ""), "G0 X2\n", "; note\nG0 X2\n")),
              HasSubstr("b:3: lines 2 to 4 of a do not have `; note`"));
}

TEST(VerifyGcode, NothingIsPrintedWhileRetracted) {
  const std::string a = "M83\nG1 F600 X1 E1\nG1 E-1\nG0 X5\nG1 E1\nG1 X6 E1\n";

  EXPECT_THAT(Difference(a, With(a, "G1 E1\n", "")),
              HasSubstr("b:5: lines 2 to 6 of a do not print `G1 X6 E1`"));
  // Whether to retract at all is travel's own affair.
  EXPECT_EQ(Difference(a, "M83\nG1 F600 X1 E1\nG0 X5\nG1 X6 E1\n"), "");
}

TEST(VerifyGcode, TravelMayNotBeLower) {
  const std::string a = "M83\nG1 Z1\nG1 F600 X1 E1\nG0 X5\nG1 X6 E1\n";

  EXPECT_THAT(Difference(a, With(a, "G0 X5", "G1 Z.5\nG0 X5\nG1 Z1")), HasSubstr("travels lower"));
}

TEST(VerifyGcode, TheFanHasToBeAsItWasAtTheEnd) {
  const std::string a = "M83\nM106 S9\nG1 F600 X1 E1\nM107\n";
  EXPECT_THAT(Difference(a, With(a, "M107\n", "")), HasSubstr("the fan differs from that"));
}

TEST(VerifyGcode, TheMarkOfAnEarlierRunDoesNotCount) {
  EXPECT_EQ(Difference(kPrusa, "; optimised by Traverse 1\n" + kPrusa), "");
  EXPECT_EQ(Difference("; optimised by Traverse 1\n" + kPrusa, kPrusa), "");
}

TEST(VerifyGcode, ATextThatGoesOnIsAnother) {
  EXPECT_THAT(Difference(kPrusa, kPrusa + "M600\n"), HasSubstr("b:"));
  EXPECT_THAT(Difference(kPrusa + "M600\n", kPrusa), HasSubstr(""));
}

}  // namespace
}  // namespace traverse::gcode

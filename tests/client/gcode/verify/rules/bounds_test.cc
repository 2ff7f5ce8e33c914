// Where travel moves lead, and how: client/gcode/verify/rules/bounds.

#include <gtest/gtest.h>

#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

const std::string kTo = "G1 X0 Y5 F9000\n";

TEST(VerifyBounds, NoTravelOvershoots) {
  const std::string a = kHead + kTwo;
  EXPECT_EQ(Broken(a, With(a, kTo, "G1 X-.5 Y5.3 F9000\n" + kTo), Policy::kFree), "bounds");
  EXPECT_EQ(Broken(a, With(a, kTo, "G1 X4.5 Y2.5 F9000\n" + kTo), Policy::kFree), "");
}

// A long travel that bends a little is hardly longer for it.
TEST(VerifyBounds, NoLongTravelBendsALittle) {
  const std::string travel = "G1 X90 Y5 F9000\n";
  const std::string more = With(With(kOther, "X9 Y5 ", "X99 Y5 "), kTo, travel);
  const std::string a = kHead + kOne + more;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X49.5 Y2.8 F9000\n" + travel)), "bounds");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X49.5 Y2.51 F9000\n" + travel)), "");
  // Nor does it go back and forth, as far as that is.
  const std::string to = "G1 X89.7 Y5 F9000\n" + travel;
  EXPECT_EQ(Broken(With(a, travel, to), With(a, travel, to + to)), "bounds");
}

// The first travel of the file leads around, and yet a new one is straight.
TEST(VerifyBounds, NoTravelBendsThoughOthersDo) {
  const std::string around = With(kTwo, kTo, "G1 X30 Y30 F9000\n" + kTo);
  const std::string more = Line("Internal infill", "X0 Y20", "X9 Y20");
  const std::string bent = With(more, "G1 X0 Y20 F9000\n", "G1 X5 Y14 F9000\nG1 X0 Y20 F9000\n");
  EXPECT_EQ(Broken(kHead + around + more, kHead + around + bent, Policy::kFree), "bounds");
  EXPECT_EQ(Broken(kHead + around + bent, kHead + around + bent, Policy::kFree), "");
}

// A hole in the way, and a slicer that leads travel around walls: by its settings, or as one sees.
TEST(VerifyBounds, TravelsMayBendAroundAWallWhereTheFileDoes) {
  const std::string hole = kSquare + Line("Internal infill", "X5 Y10.6", "X8 Y10.6");
  const std::string straight = "G1 X24 Y10.6 F9000\n";
  const std::string behind =
      Travel("X24 Y10.6") + ";TYPE:Internal infill\nG1 F1800\nG1 X28 Y10.6 E.3\n";
  const std::string plain = kHead + hole + behind;
  const std::string a = plain + "; avoid_crossing_perimeters = 1\n";
  const auto bent = [&](const std::string& bends) {
    return Broken(a, With(a, straight, bends + straight), Policy::kFree);
  };
  EXPECT_EQ(bent("G1 X9.6 Y9.6 F9000\nG1 X20.4 Y9.6\n"), "");
  EXPECT_EQ(bent("G1 X9.6 Y9.6 F9000\n"), "bounds");
  EXPECT_EQ(bent("G1 X9.6 Y9.6 F9000\nG1 X20.4 Y9.6\nG1 X25 Y10.6\n"), "bounds");
  const std::string around = "G1 X9.6 Y9.6 F9000\nG1 X20.4 Y9.6\n" + straight;
  EXPECT_EQ(Broken(plain, With(plain, straight, around), Policy::kFree), "bounds");
  // One that leads the other way, in another layer.
  const std::string back =
      With(Line("Internal infill", "X5 Y10.6", "X4 Y10.6"), "G1 X5 Y10.6 F9000\n",
           "G1 X20.4 Y9.6 F9000\nG1 X9.6 Y9.6\nG1 X5 Y10.6\n");
  const std::string own =
      plain + kNextLayer + kSquare + Line("Internal infill", "X24 Y10.6", "X28 Y10.6") + back;
  EXPECT_EQ(Broken(own, own), "");
  EXPECT_EQ(Broken(own, With(own, straight, around), Policy::kFree), "");
}

// Along the wall, with an open nozzle, to one that lies beside it.
TEST(VerifyBounds, NoTravelIsLedAlongAWall) {
  const std::string infill = ";TYPE:Internal infill\nG1 F1800\nG1 X15 Y15 E.3\n";
  const std::string a = kHead + kSquare + "G1 X12 Y12 F9000\n" + infill;
  const std::string along = With(a, "G1 X12 Y12 F9000\n", "G1 X14 Y10 F9000\nG1 X12 Y12 F9000\n");
  EXPECT_EQ(Broken(a, along, Policy::kFree), "open_travel bounds");
}

TEST(VerifyBounds, NoTravelSweepsAlongAnArcOfItsOwn) {
  const std::string a = kHead + kTwo;
  const std::string arc = With(a, kTo, "G2 X0 Y5 I-4.5 J2.5 F9000\n");
  EXPECT_EQ(Broken(a, arc), "bounds");
  EXPECT_EQ(Broken(arc, arc), "");
  EXPECT_EQ(Broken(arc, a), "");
  // Of the original, the line of the path that the travel leads to.
  EXPECT_NE(FirstMessage(a, arc).find("b:11: travel along an arc"), std::string::npos);
  EXPECT_NE(FirstMessage(a, arc).find("(bounds; a:15)"), std::string::npos) << FirstMessage(a, arc);
  // Nor from one point of the path before to another one.
  const std::string along = kHead + With(kSquare, "G1 X10 Y10 E.4\n", "G1 X10 Y10.5 E.4\n") +
                            "G1 X10 Y14 F1200\nG1 X50 Y50 F9000\n" + kWall + "G1 X60 Y50 E.4\n";
  EXPECT_EQ(Broken(along, along), "");
  EXPECT_NE(Broken(along, With(along, "G1 X10 Y14 F1200", "G3 X10 Y14 I0 J1.75 F1200")), "");
}

TEST(VerifyBounds, NoWayLeadsFarAway) {
  const std::string far = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-90 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + far), "bounds");
  EXPECT_EQ(Broken(kHead + far, kHead + far), "");
  const std::string near = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X-1 Y5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + near, kHead + near), "");
}

TEST(VerifyBounds, AWayWindsNoMoreThanWaysDo) {
  const std::string frame = Line("Internal infill", "X60 Y60", "X50 Y60");
  const std::string astray = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X40 Y50 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo + frame, kHead + astray + frame), "bounds");
  const std::string back = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X0 Y5 F9000\nG1 X9 Y0\nG1 X0 Y5\n");
  EXPECT_EQ(Broken(kHead + kTwo, kHead + back), "bounds");
  const std::string in_two = With(kTwo, "G1 X0 Y5 F9000\n", "G1 X4.5 Y2.5 F9000\nG1 X0 Y5 F9000\n");
  EXPECT_EQ(Broken(kHead + kTwo + frame, kHead + in_two + frame), "");
}

// However fast: the nozzle is open over what has just been printed.
TEST(VerifyBounds, NoTravelGoesAlongAFinishedLoopUnlessTheOriginalDoes) {
  const std::string rest = "G1 X30 Y15 F9000\n;TYPE:Internal infill\nG1 F1800\nG1 X31 Y15 E.3\n";
  const std::string along = "G1 X20 Y10 F9000\nG1 X20 Y20 F9000\n";
  const std::string a = kHead + kSquare + "G1 X10 Y40 F9000\n" + rest;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, kHead + kSquare + along + rest), "bounds");
  EXPECT_EQ(Broken(kHead + kSquare + along + rest, kHead + kSquare + along + rest), "");
}

// Some slicers leave paths by a short move; for others it is a detour like any.
TEST(VerifyBounds, ShortDetoursAreThoseOfTheFile) {
  const std::string travel = "G1 X0 Y5 F9000\n";
  const std::string a = kHead + kTwo + kNextLayer + kTwo;
  const std::string aside = "G1 X9 Y.7 F9000\n" + travel;
  EXPECT_EQ(Broken(a, With(a, travel, aside)), "bounds");
  const std::string departs =
      With(kHead + kZigzag + kTwo, "G1 X0 Y0 F9000\n", "G1 X10 Y10.3 F9000\nG1 X0 Y0\n");
  EXPECT_EQ(Broken(departs, departs), "");
  EXPECT_EQ(Broken(departs, With(departs, travel, aside)), "bounds") << "another path is left so";
  // To another point, from the same path.
  const std::string elsewhere =
      With(kHead + kZigzag + kOther + kOne, travel, "G1 X10 Y10.3 F9000\nG1 X0 Y5\n");
  EXPECT_EQ(Broken(departs, elsewhere), "");
  EXPECT_EQ(Broken(departs, With(elsewhere, "Y10.3 F9000", "Y10.4 F9000")), "bounds");
}

// Moves along the path that was just printed, where the original has such: wherever that ends.
TEST(VerifyBounds, TravelsBackAlongThePathAreThoseOfTheFile) {
  const std::string loop = With(kSquare, ";TYPE:External perimeter", ";TYPE:Skirt");
  const std::string begun = With(kSquareElsewhere, ";TYPE:External perimeter", ";TYPE:Skirt");
  const auto behind = [](const std::string& print, const std::string& back) {
    return kHead + print + "G1 E-1 F2100\n" + back + "G1 X0 Y0 F9000\nG1 E1 F2100\n" +
           ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y0 E.3\n";
  };
  const std::string a = behind(loop, "G1 X10 Y10.3 F9000\n");
  EXPECT_EQ(Broken(a, behind(begun, "G1 X19.7 Y10 F9000\n")), "");
  EXPECT_EQ(Broken(a, behind(begun, "G1 X19.5 Y10 F9000\n")), "bounds");
  EXPECT_EQ(Broken(a, behind(begun, "G1 X19.7 Y9.9 F9000\n")), "bounds");
}

// What stands behind unknown lines at the first layer is no script, but travel to its first path.
TEST(VerifyBounds, TheFirstTravelOfAllGoesStraight) {
  const std::string start = "M83\nG28\nG1 X.4 Y9 Z.2 F9000\n;LAYER_CHANGE\nM971 S11\n";
  const std::string travel = "G1 X0 Y0 F9000\n";
  const std::string a = start + travel + ";TYPE:Internal infill\nG1 F1800\nG1 X9 Y0 E.3\n" + kOther;
  EXPECT_EQ(Broken(a, a), "");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 X0 F9000\nG1 Y0\n")), "bounds");
  EXPECT_EQ(Broken(a, With(a, travel, "G1 Y0 F9000\nG1 X0\n")), "bounds");
  // Though other travel leaves its path by a short move.
  const std::string departs = With(a, "G1 X0 Y5 F9000\n", "G1 X9 Y.7 F9000\nG1 X0 Y5\n");
  EXPECT_EQ(Broken(departs, With(departs, travel, "G1 X0 F9000\nG1 Y0\n")), "bounds");
}

}  // namespace
}  // namespace traverse::gcode

// The time of moves at their stated speeds, as the writer and the verifier count it apart.

#include "client/gcode/measure/nominal_time.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "client/gcode/machine/interpreter.h"
#include "client/gcode/verify/machine/verify_machine.h"
#include "client/gcode/verify/trace/clock.h"

namespace traverse::gcode {
namespace {

double AsWritten(const std::string& text) {
  Interpreter interpreter(text);
  double seconds = 0;
  for (Step step; interpreter.Next(step);) seconds += NominalSeconds(step, interpreter.state());
  return seconds;
}

double AsVerified(const std::string& text) {
  VerifyMachine machine(text);
  double seconds = 0;
  for (VerifyLine line; machine.Next(line);) seconds += SecondsOf(line, machine);
  return seconds;
}

void ExpectTakes(const std::string& lines, double seconds) {
  const std::string text = "M83\nG1 X10 Y10 Z1 F600\n" + lines;
  const double before = AsWritten("M83\nG1 X10 Y10 Z1 F600\n");
  EXPECT_NEAR(AsWritten(text) - before, seconds, 1e-6) << lines;
  EXPECT_NEAR(AsVerified(text) - before, seconds, 1e-6) << lines;
}

constexpr double kTurn = 2 * std::numbers::pi;  // of a circle of 1 mm

TEST(NominalTime, OfLinesIsTheirLengthOverTheirSpeed) {
  ExpectTakes("G1 X13 Y14 E1\n", 0.5);
  ExpectTakes("G0 X13 Y14 Z13\n", 1.3);
  ExpectTakes("G1 E-2\nG1 E2 F1200\n", 0.2 + 0.1);
  ExpectTakes("G1 Z2 F60\n", 1);
  ExpectTakes("G1 X13 Y14 E-1\n", 0.5);
}

TEST(NominalTime, OfArcsIsAlongThem) {
  ExpectTakes("G2 X12 Y10 I1 J0 E1\n", kTurn / 2 / 10);
  ExpectTakes("G3 X11 Y11 I0 J1 E1\n", kTurn / 4 / 10);
  ExpectTakes("G2 X11 Y11 I0 J1 E1\n", kTurn * 3 / 4 / 10);
  ExpectTakes("G2 X11 Y11 R1 E1\n", kTurn / 4 / 10);
  ExpectTakes("G2 X11 Y11 R-1 E1\n", kTurn * 3 / 4 / 10);
  ExpectTakes("G2 X14 Y10 R1 E1\n", kTurn / 10);  // farther than such an arc reaches
  ExpectTakes("G2 X12 Y10 I1 J0\n", kTurn / 2 / 10);
}

TEST(NominalTime, OfCirclesIsAlongThemWhateverTheyDo) {
  ExpectTakes("G2 X10 Y10 I1 J0 E1\n", kTurn / 10);
  ExpectTakes("G3 I1 E1\n", kTurn / 10);
  ExpectTakes("G2 I1 J0\n", kTurn / 10);
  // A spiral lift.
  ExpectTakes("G17\nG3 Z1.4 I1.217 J0 P1 F600\n", std::hypot(1.217 * kTurn, .4) / 10);
}

TEST(NominalTime, OfDwellsIsWhatTheyState) {
  ExpectTakes("G4 P500\n", 0.5);
  ExpectTakes("G4 S2\n", 2);
  ExpectTakes("G1 E-2\nG4 P300\nG1 X20\nG1 E2\n", 0.2 + 0.3 + 1 + 0.2);
}

TEST(NominalTime, OfFirmwareRetractionOnlyTheMachineKnows) { ExpectTakes("G10\nG11\n", 0); }

TEST(NominalTime, OfRelativeMovesAndOfMovesInInches) {
  ExpectTakes("G91\nG1 Z1 F600\nG90\n", 0.1);
  ExpectTakes("G91\nG1 X3 Y4 E1\nG90\n", 0.5);
}

}  // namespace
}  // namespace traverse::gcode

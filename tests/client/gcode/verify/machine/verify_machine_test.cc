#include "client/gcode/verify/machine/verify_machine.h"

#include <gtest/gtest.h>

#include <string>

namespace traverse::gcode {
namespace {

bool IsRetractedAfter(const std::string& text) {
  VerifyMachine machine(text);
  VerifyLine line;
  while (machine.Next(line)) {
  }
  return machine.retracted();
}

TEST(VerifyMachine, WhatComesBackAllButAThirtiethIsBack) {
  EXPECT_TRUE(IsRetractedAfter("M83\nG1 E-1 F2100\n"));
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E1\n"));
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E.97\n"));
  EXPECT_TRUE(IsRetractedAfter("M83\nG1 E-1 F2100\nG1 E.9\n"));
  // In two pulls, the deepest of which counts.
  EXPECT_FALSE(IsRetractedAfter("M83\nG1 E-.5 F2100\nG1 E-.5\nG1 E.97\n"));
}

}  // namespace
}  // namespace traverse::gcode

#include "client/gcode/machine/machine_limits.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/gcode/gcode_job.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/read/reader.h"
#include "client/input/input_job.h"

namespace traverse::gcode {
namespace {

MachineLimits Read(const std::string& text) {
  const absl::StatusOr<MachineLimits> limits = ReadMachineLimits(text, "printer.cfg");
  EXPECT_TRUE(limits.ok()) << limits.status();
  return limits.ok() ? *limits : MachineLimits();
}

std::string FaultOf(const std::string& text) {
  const absl::StatusOr<MachineLimits> limits = ReadMachineLimits(text, "printer.cfg");
  EXPECT_FALSE(limits.ok()) << text;
  return std::string(limits.status().message());
}

constexpr char kPrinter[] =
    "# a comment\r\n"
    "[stepper_z]\n"
    "max_accel: 7\n"
    "[printer]\n"
    "kinematics: corexy\n"
    "Max_Velocity = 300   # mm/s\n"
    "max_accel: 3000 ; mm/s^2\n";

TEST(MachineLimits, OfKlipperWithItsDefaults) {
  const MachineLimits limits = Read(kPrinter);

  EXPECT_TRUE(limits.klipper);
  EXPECT_EQ(limits.max_speed, 300);
  EXPECT_EQ(limits.max_accel, 3000);
  EXPECT_EQ(limits.corner_speed, 5);
  EXPECT_EQ(limits.cruise_ratio, 0.5);
  EXPECT_EQ(limits.max_z_speed, 300);
  EXPECT_EQ(limits.z_accel, 3000);
  EXPECT_EQ(limits.extruder_corner_speed, 1);
}

TEST(MachineLimits, OfKlipperWithAllOfThem) {
  const MachineLimits limits = Read(std::string(kPrinter) +
                                    "square_corner_velocity: 0\n"
                                    "minimum_cruise_ratio: 0.25\n"
                                    "max_z_velocity: 10\n"
                                    "max_z_accel: 100\n"
                                    "[gcode_macro START]\n"
                                    "gcode:\n"
                                    "  max_velocity: none\n"
                                    "\n"
                                    "\tmax_accel: none\n"
                                    "[firmware_retraction]\n"
                                    "retract_length: 0.8\n"
                                    "retract_speed: 35\n"
                                    "unretract_speed: 20\n"
                                    "[extruder]\n"
                                    "max_extrude_only_velocity: 60\n");

  EXPECT_EQ(limits.corner_speed, 0);
  EXPECT_EQ(limits.cruise_ratio, 0.25);
  EXPECT_EQ(limits.max_z_speed, 10);
  EXPECT_EQ(limits.z_accel, 100);
  EXPECT_EQ(limits.firmware_retract_length, 0.8);
  EXPECT_EQ(limits.firmware_retract_speed, 35);
  EXPECT_EQ(limits.firmware_prime_speed, 20);
  EXPECT_EQ(limits.max_e_speed, 60);
}

TEST(MachineLimits, OfKlipperBeforeThereWasACruiseRatio) {
  EXPECT_EQ(Read(std::string(kPrinter) + "max_accel_to_decel: 750\n").cruise_ratio, 0.75);
  EXPECT_EQ(Read(std::string(kPrinter) + "max_accel_to_decel: 9000\n").cruise_ratio, 0);
}

TEST(MachineLimits, FaultsOfKlipperNameTheLine) {
  EXPECT_EQ(FaultOf("[printer]\nmax_velocity: fast\nmax_accel: 1\n"),
            "printer.cfg:2: max_velocity: \"fast\" is not a number above 0 and up to 1e9");
  for (const char* bad : {"0", "-1", "nan", "inf", "1e10", "", "300 mm"}) {
    const std::string text = absl::StrFormat("[printer]\nmax_velocity: 3\nmax_accel: %s\n", bad);
    EXPECT_EQ(FaultOf(text).find("printer.cfg:3: max_accel: "), 0u) << bad;
  }
  EXPECT_EQ(FaultOf(std::string(kPrinter) + "minimum_cruise_ratio: 1\n"),
            "printer.cfg:8: minimum_cruise_ratio: \"1\" is not a number from 0 to below 1");
  EXPECT_EQ(FaultOf("[printer\n"), "printer.cfg:1: a section without a ]");
  EXPECT_EQ(FaultOf("[printer]\nmax_accel: 1\n"), "printer.cfg: [printer] has no max_velocity");
  EXPECT_EQ(FaultOf("[include machine.cfg]\n[printer]\nmax_velocity: 1\n"),
            "printer.cfg: [printer] has no max_accel; files that it includes are not read");
  EXPECT_EQ(FaultOf("[extruder]\n"), "printer.cfg: it has no [printer]");
  EXPECT_EQ(FaultOf("[PRINTER]\nmax_velocity: 1\nmax_accel: 1\n"),
            "printer.cfg: it has no [printer]");
  EXPECT_EQ(FaultOf("[include *.cfg]\n"),
            "printer.cfg: it has no [printer]; files that it includes are not read");
}

using Files = std::map<std::string, std::vector<IncludedFile>>;

// Files by the patterns that mean them, whoever includes them.
ReadIncludes IncludesFrom(const Files& files) {
  return [&files](const std::string& pattern,
                  const std::string& from) -> absl::StatusOr<std::vector<IncludedFile>> {
    const auto found = files.find(pattern);
    if (found == files.end()) return absl::NotFoundError(pattern + " of " + from);
    return found->second;
  };
}

TEST(MachineLimits, OfIncludedFilesCountWhereTheyAreIncluded) {
  const Files files = {
      {"base.cfg", {{"b/base.cfg", "[printer]\nmax_velocity: 1\nmax_accel: 2\n[include more*]\n"}}},
      {"more*",
       {{"b/more1", "[printer]\nmax_accel: 3\n"},
        {"b/more2", "max_accel: 9\n[printer]\nmax_accel: 4\n"}}}};
  const std::string text = "[include  base.cfg ]\nmax_accel: 7\n[printer]\nmax_velocity: 5\n";

  const auto limits = ReadMachineLimits(text, "printer.cfg", IncludesFrom(files));

  ASSERT_TRUE(limits.ok()) << limits.status();
  EXPECT_EQ(limits->max_speed, 5);
  EXPECT_EQ(limits->max_accel, 4) << "of the last one, and only in its section";
}

TEST(MachineLimits, FaultsOfIncludedFilesNameThem) {
  const Files files = {{"bad.cfg", {{"d/bad.cfg", "\n[printer]\nmax_velocity: -1\n"}}},
                       {"*.cfg", {{"d/self.cfg", "[include *.cfg]\n"}}},
                       {"good.cfg", {{"d/good.cfg", ""}}}};
  const auto fault_of = [&files](const std::string& text) {
    return std::string(
        ReadMachineLimits(text, "printer.cfg", IncludesFrom(files)).status().message());
  };

  EXPECT_EQ(fault_of("[include bad.cfg]\n"),
            "d/bad.cfg:3: max_velocity: \"-1\" is not a number above 0 and up to 1e9");
  EXPECT_EQ(fault_of("\n[include none.cfg]\n"), "printer.cfg:2: none.cfg of printer.cfg");
  EXPECT_EQ(fault_of("[include *.cfg]\n"), "d/self.cfg:1: files include each other, or too deeply");
  EXPECT_EQ(fault_of("[include good.cfg]\n[printer]\nmax_accel: x\n"),
            "printer.cfg:3: max_accel: \"x\" is not a number above 0 and up to 1e9");
  EXPECT_EQ(fault_of("[include good.cfg]\n"), "printer.cfg: it has no [printer]");
}

// As it leaves a printer: a mark of UTF-8, odd blanks, a block that the machine saved, a delta.
TEST(MachineLimits, OfKlipperAsPeopleWriteIt) {
  const MachineLimits limits = Read(
      "\xEF\xBB\xBF[ printer ]  # mine\r\n"
      "kinematics:delta\r\n"
      "max_velocity   =   250.5\r\n"
      "MAX_ACCEL:1e3 # was 3000\r\n"
      "max_z_velocity : 150\t; of all towers\r\n"
      "delta_radius: 174.75\r\n"
      "[gcode_macro HELLO]\r\n"
      "gcode:\r\n"
      "    {% set max_velocity = 1 %}\r\n"
      "  [printer]\r\n"
      "[printer]\r\n"
      "square_corner_velocity=8\r\n"
      "#*# <---------------------- SAVE_CONFIG ---------------------->\r\n"
      "#*# DO NOT EDIT THIS BLOCK OR BELOW. The contents are auto-generated.\r\n"
      "#*# [extruder]\r\n"
      "#*# control = pid\r\n"
      "#*# [printer]\r\n"
      "#*# delta_radius = 173.1\r\n");

  EXPECT_EQ(limits.max_speed, 250.5);
  EXPECT_EQ(limits.max_accel, 1000);
  EXPECT_EQ(limits.max_z_speed, 150);
  EXPECT_EQ(limits.corner_speed, 8);
}

TEST(MachineLimits, OfKlipperWhereEachAxisHasItsOwnTheSlowerCounts) {
  const MachineLimits limits = Read(
      "[printer]\nkinematics: limited_cartesian\nmax_x_velocity: 400\nmax_y_velocity: 300\n"
      "max_x_accel: 9000\nmax_y_accel: 12000\nmax_velocity: 500\nmax_accel: 15000\n");

  EXPECT_EQ(limits.max_speed, 300);
  EXPECT_EQ(limits.max_accel, 9000);
  EXPECT_EQ(Read("[printer]\nmax_x_velocity: 400\nmax_velocity: 200\nmax_accel: 1\n").max_speed,
            200);
}

// Klipper's own defaults, not those of a file that says nothing.
TEST(MachineLimits, FirmwareRetractionHasKlippersDefaults) {
  const MachineLimits limits = Read(std::string(kPrinter) +
                                    "[firmware_retraction]\n"
                                    "unretract_extra_length: 0.05\n");

  EXPECT_EQ(limits.firmware_retract_length, 0);
  EXPECT_EQ(limits.firmware_retract_speed, 20);
  EXPECT_EQ(limits.firmware_prime_speed, 10);
  EXPECT_EQ(limits.firmware_prime_extra, 0.05);
  EXPECT_FALSE(Read(kPrinter).firmware_retract_length.has_value());
}

// What terminals save of M503: who said each line, answers, the newer and the older comments.
TEST(MachineLimits, OfMarlinAsTerminalsShowIt) {
  const MachineLimits limits = Read(
      ">>> M503\n"
      "Recv: echo:  G21    ; Units in mm (mm)\n"
      "Recv: echo:; Maximum feedrates (units/s):\n"
      "Recv: echo:  M203 X300.00 Y300.00 Z40.00 E100.00\n"
      "Recv: echo:Maximum Acceleration (mm/s2):\n"
      "echo:  M201 X 3000.00 Y 2500.00 Z100.00 E5000.00\n"
      "  M204 P1500.00 R1250.00 T1600.00\n"
      "echo:; Advanced (B<min_segment_time_us> S<min_feedrate> T<min_travel_feedrate> "
      "J<junc_dev>):\n"
      "echo:  M205 B20000.00 S0.00 T0.00 J0.01\n"
      "echo:  M207 S2.50 F2700.00 Z0.00\n"
      "echo:  M208 S0.10 F480.00\n"
      "echo:  M301 P22.20 I1.08 D114.00\n"
      "ok\n");

  EXPECT_EQ(limits.max_speed, 300);
  EXPECT_EQ(limits.max_accel, 2500);
  EXPECT_EQ(limits.travel_accel, 1600);
  EXPECT_DOUBLE_EQ(limits.junction_deviation.value_or(0), 0.01);
  EXPECT_DOUBLE_EQ(limits.firmware_retract_length.value_or(0), 2.5);
  EXPECT_DOUBLE_EQ(limits.firmware_retract_speed.value_or(0), 45);
  EXPECT_DOUBLE_EQ(limits.firmware_prime_extra.value_or(0), 0.1);
  EXPECT_DOUBLE_EQ(limits.firmware_prime_speed.value_or(0), 8);
}

TEST(MachineLimits, OfMarlinInInches) {
  const MachineLimits limits = Read("echo:  G20 ; Units in inches\nM203 X10\nM201 X100\n");

  EXPECT_DOUBLE_EQ(limits.max_speed.value_or(0), 254);
  EXPECT_DOUBLE_EQ(limits.max_accel.value_or(0), 2540);
}

TEST(MachineLimits, OfRepRapFirmwareInMillimetersPerMinute) {
  const MachineLimits limits = Read(
      "M208 X0 Y0 Z0 S1 ; the least that axes reach\n"
      "M566 X900.00 Y600.00 Z60.00 E120.00\n"
      "M203 X18000 Y12000 Z900 E3600\n"
      "M201 X500 Y400 Z20 E250\n");

  EXPECT_DOUBLE_EQ(limits.corner_speed.value_or(0), 10);
  EXPECT_DOUBLE_EQ(limits.max_speed.value_or(0), 200);
  EXPECT_DOUBLE_EQ(limits.max_z_speed.value_or(0), 15);
  EXPECT_DOUBLE_EQ(limits.max_accel.value_or(0), 400);
  EXPECT_FALSE(limits.firmware_prime_extra.has_value());
}

TEST(MachineLimits, OfMarlin) {
  const MachineLimits limits = Read(
      "; of M503\n"
      "echo:; Maximum Acceleration (units/s2):\n"
      "echo:  M201 X3000.00 Y2000.00 Z100.00 E5000.00\n"
      "M203 X200 Y250 Z12 E120 ; mm/s\n"
      "M92 X80 Y80\n"
      "M204 S900\n"
      "M204 P1500 R1250\n"
      "M205 X8 Y7\n"
      "echo:Filament settings: Disabled\n");

  EXPECT_FALSE(limits.klipper);
  EXPECT_DOUBLE_EQ(limits.max_accel.value_or(0), 2000);
  EXPECT_DOUBLE_EQ(limits.z_accel.value_or(0), 100);
  EXPECT_DOUBLE_EQ(limits.max_speed.value_or(0), 200);
  EXPECT_DOUBLE_EQ(limits.max_z_speed.value_or(0), 12);
  EXPECT_DOUBLE_EQ(limits.max_e_speed.value_or(0), 120);
  EXPECT_DOUBLE_EQ(limits.print_accel.value_or(0), 1500);
  EXPECT_DOUBLE_EQ(limits.travel_accel.value_or(0), 900);
  EXPECT_DOUBLE_EQ(limits.retract_accel.value_or(0), 1250);
  EXPECT_DOUBLE_EQ(limits.corner_speed.value_or(0), 7);
}

TEST(MachineLimits, FaultsOfMarlin) {
  EXPECT_EQ(FaultOf("M203 X200\nM201 X0\n"),
            "printer.cfg:2: M201 X: not a number above 0 and up to 1e9");
  EXPECT_EQ(FaultOf("M204 P1000 P2000\n"), "printer.cfg:1: M204: its words cannot be read");
  EXPECT_EQ(FaultOf("M203 X200\nfast\n"), "printer.cfg:2: neither a command nor a comment");
  const char* neither =
      "printer.cfg: neither a Klipper configuration, with [printer], nor lines of M201 to M205";
  EXPECT_EQ(FaultOf("fast\n"), neither);
  EXPECT_EQ(FaultOf("M92 X80\n"), neither);
  EXPECT_EQ(FaultOf(""), neither);
  EXPECT_EQ(FaultOf(std::string("\0\xff\x01", 3)), neither);
}

TEST(MachineLimits, ReplaceThoseOfTheProfile) {
  MachineProfile profile;
  ApplyLimits(Read("M201 X3000 Y2000 Z100 E5000\nM203 X200 Y250 Z12 E120\n"
                   "M204 P1500 R1250 T900\nM205 X8 Y7\n"),
              profile);

  EXPECT_DOUBLE_EQ(profile.max_accel, 2000);
  EXPECT_DOUBLE_EQ(profile.z_accel, 100);
  EXPECT_DOUBLE_EQ(profile.max_speed, 200);
  EXPECT_DOUBLE_EQ(profile.max_z_speed, 12);
  EXPECT_DOUBLE_EQ(profile.max_e_speed, 120);
  EXPECT_DOUBLE_EQ(profile.print_accel, 1500);
  EXPECT_DOUBLE_EQ(profile.travel_accel, 900);
  EXPECT_DOUBLE_EQ(profile.retract_accel, 1250);
  EXPECT_DOUBLE_EQ(profile.corner_speed, 7);
  ApplyLimits(Read(std::string(kPrinter) + "minimum_cruise_ratio: 0.25\n"), profile);
  EXPECT_DOUBLE_EQ(profile.cruise_ratio, 0.25);
}

TEST(MachineLimits, ACornerIsMissedByTheJunctionDeviation) {
  MachineProfile profile;
  ApplyLimits(Read("M204 P1000\nM205 J0.02\n"), profile);

  // v^2 = a r, where r (sqrt 2 - 1) is the deviation.
  EXPECT_NEAR(profile.corner_speed, std::sqrt(1000 * 0.02 / (std::sqrt(2) - 1)), 1e-9);
}

TEST(MachineLimits, FirmwareRetractsAndPrimesAsTheyState) {
  const std::string retraction =
      std::string(kPrinter) + "[firmware_retraction]\nretract_length: 0.8\nretract_speed: 35\n";
  MachineProfile profile;
  ApplyLimits(Read(retraction), profile);

  EXPECT_EQ(profile.firmware_retract_length, 0.8);
  EXPECT_EQ(profile.firmware_retract_speed, 35);
  EXPECT_EQ(profile.firmware_prime_speed, 10);
  ApplyLimits(Read(retraction + "unretract_speed: 20\n"), profile);
  EXPECT_EQ(profile.firmware_retract_speed, 35);
  EXPECT_EQ(profile.firmware_prime_speed, 20);
}

TEST(MachineLimits, FilamentAloneMayWhatExtrudingMay) {
  MachineProfile profile;
  ApplyLimits(Read(kPrinter), profile);

  // Lines of 4 * 0.4^2 mm^2 of filament of 1.75 mm.
  EXPECT_NEAR(profile.max_e_speed, 79.82, 0.01);
  EXPECT_NEAR(profile.retract_accel, 798.2, 0.1);
}

TEST(MachineLimits, StandInPlaceOfWhatAFileStates) {
  const std::string text =
      "; generated by PrusaSlicer 2.7.4\n"
      "M204 P500 ; not for Klipper\n"
      "G1 X10 Y10 Z0.2 F6000\n"
      ";LAYER_CHANGE\n;TYPE:Perimeter\n"
      "G1 X60 E2 F12000\n"
      "G1 X60 Y20 F12000\n"
      "G1 X10 E2\n"
      "M104 S0\n"
      "; machine_max_acceleration_extruding = 800\n";
  const auto seconds = [&](const std::string& machine) {
    GcodeOptions options;
    if (!machine.empty()) options.machine = Read(machine);
    const absl::StatusOr<InputJob> job = ReadGcodeJob("M83\n" + text, "part.gcode", options);
    EXPECT_TRUE(job.ok()) << job.status();
    return job.ok() ? Sum(MeasureLayers(*job->gcode)).seconds : 0;
  };

  const double stated = seconds("");
  const double slow = seconds("[printer]\nmax_velocity: 50\nmax_accel: 3000\n");
  const double fast = seconds("[printer]\nmax_velocity: 300\nmax_accel: 9000\n");
  EXPECT_GT(slow, 110 / 50.0);
  EXPECT_LT(slow, stated * 2);
  EXPECT_LT(fast, stated);
  EXPECT_LT(seconds("M204 S3000\n"), stated);
  EXPECT_GT(seconds("M203 X50 Y50\n"), 110 / 50.0);
}

}  // namespace
}  // namespace traverse::gcode

// Which paths of the original the other file prints: client/gcode/verify/match/visits.

#include "client/gcode/verify/match/visits.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "tests/client/gcode/verify/small_prints.h"

namespace traverse::gcode {
namespace {

using namespace testing;  // NOLINT: the small prints

std::string Repeated(const std::string& text, int times) {
  std::string all = kHead;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

// Each is compared with a few others, not with all.
TEST(FindVisits, EqualLoopsInOnePlaceTakeLittleTime) {
  constexpr int kLoops = 20'000;
  const std::string named = Repeated(kSquare, kLoops);
  const std::string unnamed = Repeated(With(kSquare, ";TYPE:External perimeter\n", ""), kLoops);
  const auto begin = std::chrono::steady_clock::now();

  EXPECT_EQ(Broken(named, named), "");
  EXPECT_EQ(Broken(named, Repeated(kSquareElsewhere, kLoops), Policy::kFree), "");
  EXPECT_EQ(Broken(unnamed, unnamed), "");

  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

// One of them is another one.
TEST(FindVisits, EqualLoopsAreTakenOnceEach) {
  const std::string a = Repeated(kSquare, 40) + kTwo;
  EXPECT_EQ(Broken(a, Repeated(kSquare, 40) + kTwo), "");
  EXPECT_EQ(Broken(a, Repeated(kSquare, 39) + kSquareTurned + kTwo), "direction");
  EXPECT_EQ(Broken(a, Repeated(kSquare, 41) + kTwo), "same_print");
}

}  // namespace
}  // namespace traverse::gcode

// Numbers for people: client/report/numbers.

#include "client/report/numbers.h"

#include <gtest/gtest.h>

namespace traverse::report {
namespace {

TEST(Numbers, ReadWell) {
  EXPECT_EQ(Change(100, 68.8), "31.2 % less");
  EXPECT_EQ(Change(100, 104), "4.0 % more");
  EXPECT_EQ(Change(100, 100.01), "the same");
  EXPECT_EQ(Change(0, 0), "the same");
  EXPECT_EQ(Change(0, 5), "100.0 % more");
  EXPECT_EQ(Duration(0.44), "0.4 s");
  EXPECT_EQ(Duration(9.96), "10 s");
  EXPECT_EQ(Duration(59.6), "1 min 0 s");
  EXPECT_EQ(Duration(39060), "10 h 51 min");
  EXPECT_EQ(Duration(273600), "3 d 4 h");
  EXPECT_EQ(Length(812.44), "812.4 mm");
  EXPECT_EQ(Length(15024.2), "15.02 m");
  EXPECT_EQ(Length(593331), "593.3 m");
  EXPECT_EQ(Length(12'440'000), "12.44 km");
}

}  // namespace
}  // namespace traverse::report

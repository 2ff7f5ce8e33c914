#include "server/net/turns.h"

#include <gtest/gtest.h>

#include <string>

namespace traverse {
namespace {

std::string TakeAll(Turns<char>& turns) {
  std::string taken;
  while (!turns.empty()) taken += turns.TakeNext();
  return taken;
}

TEST(TurnsTest, EachAddressHasOneAfterTheOther) {
  Turns<char> turns;
  for (const char thing : std::string("abcd")) turns.Add("1.1.1.1", thing);
  turns.Add("2.2.2.2", 'X');
  EXPECT_EQ(turns.TakeNext(), 'a');
  turns.Add("3.3.3.3", 'Y');
  turns.Add("2.2.2.2", 'Z');
  EXPECT_EQ(turns.size(), 6u);
  EXPECT_EQ(TakeAll(turns), "XbYZcd");
  EXPECT_EQ(turns.size(), 0u);
}

TEST(TurnsTest, OfTheAddressWithMostTheLastGoes) {
  Turns<char> turns;
  EXPECT_EQ(turns.most(), 0u);
  turns.Add("1.1.1.1", 'a');
  turns.Add("2.2.2.2", 'X');
  turns.Add("2.2.2.2", 'Y');
  EXPECT_EQ(turns.most(), 2u);
  EXPECT_EQ(turns.of("2.2.2.2"), 2u);
  EXPECT_EQ(turns.of("3.3.3.3"), 0u);
  EXPECT_EQ(turns.TakeLastOfMost(), 'Y');
  EXPECT_EQ(turns.most(), 1u);
  EXPECT_EQ(turns.TakeLastOfMost(), 'a');
  EXPECT_EQ(TakeAll(turns), "X");
}

}  // namespace
}  // namespace traverse

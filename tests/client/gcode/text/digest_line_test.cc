#include "client/gcode/text/digest_line.h"

#include <gtest/gtest.h>

#include <string>

namespace traverse::gcode {
namespace {

// The digest is that of "G28\n", by md5sum.
const char kDigest[] = "; MD5:bed3f671261ea5abc6be16b782d1c47b\n";

TEST(DigestLine, IsThatOfAllBehindIt) {
  std::string text = std::string(kDigest) + "G28\n";
  EXPECT_TRUE(StatesItsDigest(text));
  EXPECT_FALSE(StatesItsDigest(text + "G28\n"));
  EXPECT_FALSE(StatesItsDigest("G28\n"));
  EXPECT_FALSE(StatesItsDigest("; MD5:"));
  EXPECT_FALSE(StatesItsDigest(""));
}

TEST(DigestLine, IsRenewedInTheSameForm) {
  for (const std::string form : {"; MD5:d41d8cd98f00b204e9800998ecf8427e\r\n",
                                 "; MD5: D41D8CD98F00B204E9800998ECF8427E\n"}) {
    std::string text = form + "G28\n";
    ASSERT_FALSE(StatesItsDigest(text));

    RenewDigest(text);

    EXPECT_TRUE(StatesItsDigest(text));
    EXPECT_EQ(text.size(), form.size() + 4);
    EXPECT_EQ(text.find('D', 8) != std::string::npos, form.find('D', 8) != std::string::npos);
  }
}

}  // namespace
}  // namespace traverse::gcode

#include "server/rpc/call_info.h"

#include <gtest/gtest.h>

namespace traverse {
namespace {

TEST(PeerHost, IsThePeerWithoutItsPort) {
  EXPECT_EQ(PeerHost("ipv4:10.0.0.7:41234"), "ipv4:10.0.0.7");
  EXPECT_EQ(PeerHost("ipv6:[::1]:50051"), "ipv6:[::1]");
}

TEST(TraceId, IsThatOfAValidTraceparentOnly) {
  const std::string id = "0af7651916cd43dd8448eb211c80319c";
  EXPECT_EQ(TraceId("00-" + id + "-b7ad6b7169203331-01"), id);
  EXPECT_EQ(TraceId("00-" + id + "-0000000000000000-01"), "");
  EXPECT_EQ(TraceId("00-00000000000000000000000000000000-b7ad6b7169203331-01"), "");
  EXPECT_EQ(TraceId("00-" + id), "");
  EXPECT_EQ(TraceId(""), "");
}

TEST(NewJobId, IsSixteenDigitsAndAnotherEachTime) {
  EXPECT_EQ(NewJobId().size(), 16u);
  EXPECT_EQ(NewJobId().find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(NewJobId(), NewJobId());
}

TEST(MetadataText, EscapesWhatMetadataMayNotHave) {
  EXPECT_EQ(MetadataText("plate-7_a"), "plate-7_a");
  EXPECT_EQ(MetadataText("plate 7"), "plate%207");
  EXPECT_EQ(MetadataText("100%"), "100%25");
  EXPECT_EQ(MetadataText("\xc3\xa9\n"), "%C3%A9%0A");
}

}  // namespace
}  // namespace traverse

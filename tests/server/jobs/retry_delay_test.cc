#include "server/jobs/retry_delay.h"

#include <gtest/gtest.h>

#include <string>

#include "absl/strings/cord.h"
#include "google/rpc/error_details.pb.h"

namespace traverse {
namespace {

absl::Duration DelayIn(const absl::Status& status) {
  const auto payload = status.GetPayload("type.googleapis.com/google.rpc.RetryInfo");
  if (!payload.has_value()) return absl::InfiniteDuration();
  google::rpc::RetryInfo info;
  EXPECT_TRUE(info.ParseFromString(std::string(*payload)));
  return absl::Seconds(info.retry_delay().seconds()) +
         absl::Nanoseconds(info.retry_delay().nanos());
}

TEST(WithRetryDelay, CarriesTheWholeDelay) {
  for (const absl::Duration delay : {absl::Milliseconds(1), absl::Milliseconds(250),
                                     absl::Seconds(1), absl::Milliseconds(2750)}) {
    const absl::Status status = WithRetryDelay(absl::ResourceExhaustedError("full"), delay);

    EXPECT_EQ(DelayIn(status), delay);
    EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
    EXPECT_EQ(status.message(), "full");
  }
}

}  // namespace
}  // namespace traverse

// The service's own messages as files: client/formats/api_format.

#include "client/formats/api_format.h"

#include <gtest/gtest.h>

#include <string>

#include "client/formats/detect.h"
#include "client/formats/read_input.h"
#include "tests/support/golden.h"

namespace traverse {
namespace {

TEST(ApiFormat, BothFormsGiveBackTheJob) {
  InputJob job = *ReadInput(testing::DataPath("damat/two_islands.damat"));
  job.options.set_seed(18446744073709551615u);
  job.options.mutable_cost()->mutable_time()->set_speed_mm_s(120);
  job.layers[0].set_z_mm(0.1);

  const InputJob json = *ParseInput(*WriteApiJson(job), "a");
  const InputJob proto = *ParseInput(*WriteApiProto(job), "a");

  EXPECT_EQ(json.format, InputFormat::kJson);
  EXPECT_EQ(proto.format, InputFormat::kProto);
  for (const InputJob* again : {&json, &proto}) {
    EXPECT_EQ(again->options.DebugString(), job.options.DebugString());
    ASSERT_EQ(again->layers.size(), job.layers.size());
    for (size_t i = 0; i < job.layers.size(); ++i) {
      EXPECT_EQ(again->layers[i].SerializeAsString(), job.layers[i].SerializeAsString());
    }
  }
}

TEST(ApiFormat, RefusesEveryCutThatLeavesAMessageOpen) {
  InputJob job = *ReadInput(testing::DataPath("damat/two_islands.damat"));
  job.layers.resize(1);
  const std::string bytes = *WriteApiProto(job);

  constexpr size_t kEmptyOptions = 2;  // a whole message by themselves
  for (size_t length = kEmptyOptions + 1; length < bytes.size(); ++length) {
    EXPECT_FALSE(ReadApiProto(bytes.substr(0, length), "a.pb").ok()) << length;
  }
}

}  // namespace
}  // namespace traverse

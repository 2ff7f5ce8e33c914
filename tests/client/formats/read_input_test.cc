// Jobs of any format: client/formats/read_input.

#include "client/formats/read_input.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/formats/detect.h"
#include "tests/client/formats/formats.h"
#include "tests/support/golden.h"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

TEST(ParseInput, ContentGoesBeforeExtension) {
  const absl::StatusOr<InputJob> job = ParseInput(kDamatText, "wrong.gcode");

  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(job->format, InputFormat::kDamat);
  EXPECT_EQ(job->name, "wrong.gcode");
}

TEST(ParseInput, ErrorsAreOneLineWithTheName) {
  const auto error = [](const std::string& bytes, const std::string& name) {
    const absl::StatusOr<InputJob> job = ParseInput(bytes, name);
    EXPECT_EQ(job.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(job.status().message()), Not(HasSubstr("\n")));
    return std::string(job.status().message());
  };

  EXPECT_EQ(error("", "a.damat"), "a.damat: the file is empty");
  EXPECT_EQ(error(" \r\n", "-"), "standard input: the file is empty");
  EXPECT_EQ(error("hello", "a"),
            "a: neither its content nor its name says DAMAT, G-code, JSON, protobuf or GTSPLIB");
  EXPECT_EQ(error("hello", "a.damat"), "a.damat:1: not a DAMAT record: \"hello\"");
  EXPECT_EQ(error(std::string("\n\x00\x01", 3), "a.damat"),
            "a.damat:2: not a DAMAT record: \"??\"");
  EXPECT_EQ(error(std::string("\x12\x00\x12\x05", 4), "a"),
            "a: not a whole OptimizeBatchRequest: damaged or cut short");
  EXPECT_THAT(error("{\"layers\": [{\"id\": 1,]}", "a.json"),
              StartsWith("a.json: not an OptimizeBatchRequest: "));
  EXPECT_THAT(error("{\"no_such_field\": 1}", "a.json"), HasSubstr("no_such_field"));
}

TEST(ReadInput, ReadsAFileByName) {
  const absl::StatusOr<InputJob> job = ReadInput(testing::DataPath("damat/two_islands.damat"));

  ASSERT_TRUE(job.ok()) << job.status();
  EXPECT_EQ(job->layers.size(), 3u);
}

}  // namespace
}  // namespace traverse

#include "server/rpc/request_reader.h"

#include <gmock/gmock.h>
#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/util/message_differencer.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "tests/server/support/service_fixture.h"
#include "tests/support/status_matchers.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using google::protobuf::util::MessageDifferencer;
using ::testing::HasSubstr;
using testing::StatusIs;

constexpr char kType[] = "traverse.v1.OptimizeBatchRequest";

// `bytes` in slices of at most `slice_bytes`.
grpc::ByteBuffer Sliced(const std::string& bytes, size_t slice_bytes) {
  std::vector<grpc::Slice> slices;
  for (size_t at = 0; at < bytes.size(); at += slice_bytes) {
    slices.emplace_back(bytes.substr(at, slice_bytes));
  }
  return grpc::ByteBuffer(slices.data(), slices.size());
}

TEST(RequestReader, CountsWhatAMessageComesToBeforeItIsParsed) {
  v1::OptimizeBatchRequest request;
  for (int i = 0; i < 1000; ++i) request.add_layers()->add_islands();
  v1::Layer& large = *request.add_layers();
  for (int i = 0; i < 5000; ++i) large.add_islands();
  RequestReader reader;

  grpc::ByteBuffer message = Sliced(request.SerializeAsString(), 1000);
  ASSERT_OK(reader.Open(kType, message));
  EXPECT_GT(reader.footprint_bytes(), 6000 * 215);

  message = Sliced(request.SerializeAsString(), 1000);
  EXPECT_THAT(reader.Open(kType, message, {.parts_of_layer = 4000}),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("layers[1000]")));
  message = Sliced(request.SerializeAsString(), 1000);
  EXPECT_THAT(reader.Open(kType, message, {.footprint_bytes = 1 << 20}),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("1 MiB")));
}

// A batch of one layer that is `bytes` on the wire.
std::string BatchOf(const std::string& bytes) {
  std::string length;
  for (size_t left = bytes.size(); true; left >>= 7) {
    length.push_back(static_cast<char>(left < 128 ? left : (left & 127) | 128));
    if (left < 128) break;
  }
  return '\x12' + length + bytes;
}

std::string Repeated(const std::string& bytes, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += bytes;
  return all;
}

// Fields that no version knows are kept by protobuf until the message is refused: two bytes are an
// empty text, or a group, of 48 bytes and more.
TEST(RequestReader, CountsWhatItDoesNotKnow) {
  constexpr int kFields = 10'000;
  const std::string empty_texts = Repeated({'\x7a', '\x00'}, kFields);
  const std::string groups = Repeated("\x7b\x7c", kFields);
  const std::string in_a_group = "\x7b" + Repeated(std::string{'\x72', '\x00'}, kFields) + "\x7c";
  for (const std::string& layer : {empty_texts, groups, in_a_group}) {
    RequestReader reader;
    grpc::ByteBuffer message = Sliced(BatchOf(layer), 1000);

    ASSERT_OK(reader.Open(kType, message));

    EXPECT_GT(reader.footprint_bytes(), kFields * 64);
  }
}

// Children of a node are a byte each on the wire, and eight or more in memory.
TEST(RequestReader, CountsPackedNumbersAsTheyAreInMemory) {
  v1::OptimizeBatchRequest request;
  v1::InOrder& node = *request.add_layers()->mutable_plan()->add_nodes()->mutable_in_order();
  for (int i = 0; i < 10'000; ++i) node.add_children(1);
  RequestReader reader;
  grpc::ByteBuffer message = Sliced(request.SerializeAsString(), 1000);

  ASSERT_OK(reader.Open(kType, message));

  EXPECT_GT(reader.footprint_bytes(), 10'000 * 12);
}

TEST(RequestReader, OptionsMayHaveNoMoreBytesThanMeanAnything) {
  v1::OptimizeBatchRequest request;
  request.mutable_options()->set_job_id(std::string(900'000, 'x'));
  RequestReader reader;
  grpc::ByteBuffer message = Sliced(request.SerializeAsString(), 1000);
  ASSERT_OK(reader.Open(kType, message));

  const std::string twice = request.SerializeAsString() + request.SerializeAsString();
  message = Sliced(twice, 1000);
  EXPECT_THAT(reader.Open(kType, message),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("options")));

  // Two bytes each, of which protobuf makes fifty.
  const std::string unknown = BatchOf(Repeated(std::string{'\x7a', '\x00'}, 5000));
  message = Sliced('\x0a' + unknown.substr(1), 1000);
  EXPECT_THAT(reader.Open(kType, message),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("parts")));
}

// What the reader makes of a message in pieces of `piece_bytes`.
absl::StatusOr<v1::OptimizeBatchRequest> ReadAll(grpc::ByteBuffer message, int64_t piece_bytes) {
  RequestReader reader;
  if (absl::Status status = reader.Open(kType, message); !status.ok()) return status;
  EXPECT_EQ(message.Length(), 0u);
  v1::OptimizeBatchRequest read;
  if (reader.has_options()) *read.mutable_options() = reader.options();
  while (reader.left() > 0) {
    const int64_t before = reader.left();
    const absl::Status status = reader.Read(piece_bytes, [&read](const v1::Layer& layer) {
      *read.add_layers() = layer;
      return absl::OkStatus();
    });
    if (!status.ok()) return status;
    EXPECT_LT(reader.left(), before);
  }
  EXPECT_EQ(reader.layers(), read.layers_size());
  return read;
}

TEST(RequestReader, ReadsWhatWasWrittenHoweverItIsCut) {
  v1::OptimizeBatchRequest request = testing::MakeBatch(23, "greedy");
  request.mutable_layers(7)->Clear();
  request.mutable_options()->set_job_id("a job");
  const std::string bytes = request.SerializeAsString();
  for (const size_t slice_bytes : {size_t{1}, size_t{7}, size_t{100}, bytes.size()}) {
    for (const int64_t piece_bytes : {int64_t{1}, int64_t{500}, int64_t{1} << 20}) {
      ASSERT_OK_AND_ASSIGN(const v1::OptimizeBatchRequest read,
                           ReadAll(Sliced(bytes, slice_bytes), piece_bytes));
      EXPECT_TRUE(MessageDifferencer::Equals(read, request)) << slice_bytes << " " << piece_bytes;
    }
  }
}

// Whatever one layer is: a slice may be as long as the message.
TEST(RequestReader, AsksWhetherToGoOnWithinALayerToo) {
  v1::OptimizeBatchRequest request;
  v1::Layer& layer = *request.add_layers();
  for (int i = 0; i < 100'000; ++i) layer.add_islands();
  const std::string bytes = request.SerializeAsString();
  for (const int most : {3, 15, 1000}) {
    int asked = 0;
    RequestReader reader;
    grpc::ByteBuffer message = Sliced(bytes, bytes.size());
    absl::Status status = reader.Open(kType, message, {}, [&] { return ++asked < most; });
    if (status.ok()) {
      EXPECT_GT(asked, 10);
      status = reader.Read(1, [](const v1::Layer&) { return absl::OkStatus(); });
    }
    EXPECT_EQ(status.ok(), most == 1000) << status;
    if (status.ok()) {
      EXPECT_GT(asked, 20);
    }
    EXPECT_LE(asked, most);
  }
}

TEST(RequestReader, NothingAtAllIsAJobWithoutLayers) {
  ASSERT_OK_AND_ASSIGN(const v1::OptimizeBatchRequest read, ReadAll(grpc::ByteBuffer(), 100));

  EXPECT_EQ(read.ByteSizeLong(), 0u);
}

TEST(RequestReader, OptionsMayStandAnywhereAndSeveralTimes) {
  v1::OptimizeBatchRequest first, last;
  first.mutable_options()->set_job_id("a");
  first.mutable_options()->set_seed(3);
  last.mutable_options()->set_job_id("b");
  const std::string layers = testing::MakeBatch(2).SerializeAsString();
  const std::string bytes = first.SerializeAsString() + layers + last.SerializeAsString() + layers;
  v1::OptimizeBatchRequest expected;
  ASSERT_TRUE(expected.ParseFromString(bytes));

  ASSERT_OK_AND_ASSIGN(const v1::OptimizeBatchRequest read, ReadAll(Sliced(bytes, 11), 1));

  EXPECT_TRUE(MessageDifferencer::Equals(read, expected));
}

TEST(RequestReader, WhatOnlyALaterVersionKnowsIsUnimplemented) {
  EXPECT_THAT(ReadAll(Sliced("\x18\x01", 2), 100),
              StatusIs(absl::StatusCode::kUnimplemented, HasSubstr("field number 3 ")));
}

TEST(RequestReader, AFaultOfTheTakerEndsIt) {
  grpc::ByteBuffer message = Sliced(testing::MakeBatch(9).SerializeAsString(), 50);
  RequestReader reader;
  ASSERT_OK(reader.Open(kType, message));
  int taken = 0;

  const absl::Status status = reader.Read(1 << 20, [&taken](const v1::Layer&) {
    return ++taken == 4 ? absl::OutOfRangeError("enough") : absl::OkStatus();
  });

  EXPECT_THAT(status, StatusIs(absl::StatusCode::kOutOfRange, "enough"));
  EXPECT_EQ(taken, 4);
}

// It accepts exactly what protobuf does, but for fields that are not known.
TEST(RequestReader, AgreesWithProtobufOnDamagedMessages) {
  const google::protobuf::LogSilencer silencer;
  std::mt19937_64 random(5);
  const std::string good = testing::MakeBatch(3, "greedy").SerializeAsString();
  int accepted = 0;
  for (int i = 0; i < 20'000; ++i) {
    std::string bytes = good;
    for (uint64_t n = 1 + random() % 3; n > 0; --n) {
      bytes[random() % bytes.size()] = static_cast<char>(random());
    }
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    v1::OptimizeBatchRequest parsed;
    const bool parses = parsed.ParseFromString(bytes);

    const auto read =
        ReadAll(Sliced(bytes, 1 + random() % 64), 1 + static_cast<int>(random() % 99));

    if (read.status().code() == absl::StatusCode::kUnimplemented) continue;
    ASSERT_EQ(read.ok(), parses) << "input " << i << ": " << read.status();
    if (!parses) continue;
    ++accepted;
    ASSERT_EQ(read->SerializeAsString(), parsed.SerializeAsString()) << "input " << i;
  }
  EXPECT_GT(accepted, 1000);
}

}  // namespace
}  // namespace traverse

// JSON to messages: client/formats/message_json.

#include "client/formats/message_json.h"

#include <gmock/gmock.h>
#include <google/protobuf/util/json_util.h>
#include <gtest/gtest.h>

#include <random>
#include <set>
#include <string>
#include <utility>

#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using ::testing::HasSubstr;

absl::Status StatusOfJson(const std::string& json) {
  v1::OptimizeBatchRequest request;
  return ReadMessageJson(json, request);
}

std::string FaultOfJson(const std::string& json) {
  return std::string(StatusOfJson(json).message());
}

// Sets each field of `message` with the probability of a half, lists to a few values.
class RandomMessage {
 public:
  explicit RandomMessage(unsigned seed) : random_(seed) {}

  void Fill(Message& message, int depth = 0) {
    const auto& reflection = *message.GetReflection();
    for (int i = 0; i < message.GetDescriptor()->field_count(); ++i) {
      const FieldDescriptor& field = *message.GetDescriptor()->field(i);
      if (!Yes() || depth > 6) continue;
      const int times = field.is_repeated() ? 1 + static_cast<int>(random_() % 3) : 1;
      for (int time = 0; time < (field.is_map() ? 1 : times); ++time) {
        FillField(message, field, reflection, depth);
      }
    }
  }

 private:
  bool Yes() { return random_() % 2 == 0; }

  void FillField(Message& message, const FieldDescriptor& field,
                 const google::protobuf::Reflection& reflection, int depth) {
    const bool list = field.is_repeated();
    switch (field.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE: {
        const double value = std::uniform_real_distribution<>(-1e6, 1e6)(random_);
        return list ? reflection.AddDouble(&message, &field, value)
                    : reflection.SetDouble(&message, &field, value);
      }
      case FieldDescriptor::CPPTYPE_UINT32: {
        const auto value = static_cast<uint32_t>(random_());
        return list ? reflection.AddUInt32(&message, &field, value)
                    : reflection.SetUInt32(&message, &field, value);
      }
      case FieldDescriptor::CPPTYPE_UINT64:
        return reflection.SetUInt64(&message, &field, random_() * uint64_t{4'000'000'007});
      case FieldDescriptor::CPPTYPE_BOOL:
        return reflection.SetBool(&message, &field, Yes());
      case FieldDescriptor::CPPTYPE_STRING:
        return reflection.SetString(&message, &field, Yes() ? "a \"b\"\n\xc3\xa9" : "x");
      case FieldDescriptor::CPPTYPE_ENUM:
        return reflection.SetEnumValue(&message, &field, static_cast<int>(random_() % 3));
      case FieldDescriptor::CPPTYPE_MESSAGE: {
        Message& part = list ? *reflection.AddMessage(&message, &field)
                             : *reflection.MutableMessage(&message, &field);
        if (field.message_type()->full_name() != "google.protobuf.Duration") {
          return Fill(part, depth + 1);
        }
        return part.GetReflection()->SetInt64(&part, part.GetDescriptor()->field(0),
                                              static_cast<int>(random_() % 1000));
      }
      default:
        FAIL() << field.full_name() << " is of a type that no field had";
    }
  }

  std::mt19937_64 random_;
};

TEST(MessageJson, ReadsWhatProtobufWritesUnderBothNames) {
  for (unsigned seed = 1; seed <= 300; ++seed) {
    v1::OptimizeBatchRequest request;
    RandomMessage(seed).Fill(request);
    for (const bool proto_names : {false, true}) {
      google::protobuf::util::JsonPrintOptions options;
      options.preserve_proto_field_names = proto_names;
      options.always_print_primitive_fields = seed % 2 == 0;
      options.always_print_enums_as_ints = seed % 3 == 0;
      std::string json;
      ASSERT_TRUE(google::protobuf::util::MessageToJsonString(request, &json, options).ok());

      v1::OptimizeBatchRequest again;
      const absl::Status status = ReadMessageJson(json, again);

      ASSERT_TRUE(status.ok()) << "seed " << seed << ": " << status << "\n" << json;
      EXPECT_EQ(again.DebugString(), request.DebugString()) << "seed " << seed;
    }
  }
}

TEST(MessageJson, TakesTheMappingsOtherSpellings) {
  v1::OptimizeBatchRequest request;
  const absl::Status status = ReadMessageJson(
      R"( {"options": {"seed": 7, "timeLimit": "1.5s", "strategy": null, "deposition": 0},
           "layers": [{"id": "18446744073709551615", "zMm": "0.25", "islands": [
             {"contours": [{"points": [1, 2.0, -3e0, 4], "entries": [1.0]}]}]}, {}]} )",
      request);

  ASSERT_TRUE(status.ok()) << status;
  EXPECT_EQ(request.options().time_limit().nanos(), 500'000'000);
  EXPECT_FALSE(request.options().has_strategy());
  EXPECT_EQ(request.layers(0).id(), 18446744073709551615u);
  EXPECT_EQ(request.layers(0).z_mm(), 0.25);
  EXPECT_EQ(request.layers(0).islands(0).contours(0).points(2), -3);
  EXPECT_EQ(request.layers(0).islands(0).contours(0).entries(0), 1u);
  EXPECT_EQ(request.layers_size(), 2);
}

TEST(MessageJson, NamesThePlaceAndTheReason) {
  const std::pair<const char*, const char*> cases[] = {
      {R"({"layers": [{}, {"id": 1, "id": 1}]})", "layers[1].id: given twice"},
      {R"({"layers": [{"z_mm": 1, "zMm": 1}]})", "layers[0].z_mm: given twice"},
      {R"({"options": {"strategy": {"options": {"a": "1", "a": "1"}}}})",
       "options.strategy.options[\"a\"]: given twice"},
      {R"({"options": {"strategy": {"options": {"a": 1}}}})",
       "options.strategy.options[\"a\"]: 1 is not text"},
      {R"({"layers": [{"islands": [{}, {"contours": [{"points": [0, "x"]}]}]}]})",
       "layers[0].islands[1].contours[0].points[1]: \"x\" is not a number"},
      {R"({"layers": [{"id": -1}]})",
       "layers[0].id: -1 is not a whole number from 0 to 18446744073709551615"},
      {R"({"layers": [{"exposed_paths": [4294967296]}]})",
       "layers[0].exposed_paths[0]: 4294967296 is not a whole number from 0 to 4294967295"},
      {R"({"layers": [{"id": 1.5}]})",
       "layers[0].id: 1.5 is not a whole number from 0 to 18446744073709551615"},
      {R"({"layers": [{"walls": [{"closed": "true"}]}]})",
       "layers[0].walls[0].closed: \"true\" is not true or false"},
      {R"({"layers": [[]]})", "layers[0]: a list is not its value"},
      {R"({"layers": {}})", "layers: an object is not a list"},
      {R"({"layers": 3})", "layers: 3 is not a list"},
      {R"({"layers": [3]})", "layers[0]: 3 is not an object"},
      {R"({"layers": [null]})", "layers[0]: null is not a value"},
      {R"({"options": {"job_id": {"a": 1}}})", "options.job_id: an object is not its value"},
      {R"({"options": {"time_limit": "soon"}})",
       "options.time_limit: \"soon\" is not a time such as \"1.5s\""},
      {R"({"options": {"cost": {"length": {}, "time": {}}}})",
       "options.cost.time: given beside length"},
      {R"({"layers": [{"isles": []}]})", "layers[0]: field \"isles\" is unknown to this version"},
      {R"({"isles\n": []})", "field \"isles\\n\" is unknown to this version"},
      {R"({"options": {"deposition": "SIDEWAYS"}})",
       "options.deposition: \"SIDEWAYS\" is unknown to this version"},
      {"[]", "a list is not an object"},
      {"3", "3 is not an object"},
      {"null", "null is not an object"},
  };
  for (const auto& [json, fault] : cases) EXPECT_EQ(FaultOfJson(json), fault) << json;
}

TEST(MessageJson, NamesThePlaceOfWhatIsNotJson) {
  for (const char* bad : {"NaN", "1e999", "01", "+1", "0x1", "tru", "'a'", "\"\xff\"", ""}) {
    const std::string json = std::string(R"({"layers": [{"islands": [{"id": )") + bad + "}]}]}";
    EXPECT_THAT(FaultOfJson(json), HasSubstr("layers[0].islands[0].id: ")) << bad;
    EXPECT_TRUE(absl::IsInvalidArgument(StatusOfJson(json))) << bad;
  }
  for (const char* bad :
       {"", " ", "{", "{}{}", "{\"layers\": [", "{\"layers\": []},", "\xef\xbb"}) {
    EXPECT_TRUE(absl::IsInvalidArgument(StatusOfJson(bad))) << bad;
  }
}

TEST(MessageJson, CodesAreThoseOfTheService) {
  EXPECT_TRUE(absl::IsUnimplemented(StatusOfJson(R"({"layers": [{"isles": []}]})")));
  EXPECT_TRUE(absl::IsUnimplemented(StatusOfJson(R"({"options": {"deposition": "X"}})")));
  EXPECT_TRUE(absl::IsInvalidArgument(StatusOfJson(R"({"layers": 3})")));
}

TEST(MessageJson, IsNotDeeperThanTheMessages) {
  constexpr int kDeep = 1'000'000;
  const std::string lists = "{\"layers\": " + std::string(kDeep, '[');
  EXPECT_EQ(FaultOfJson(lists), "layers[0]: a list is not its value");
  std::string objects;
  for (int i = 0; i < kDeep; ++i) objects += "{\"layers\":[";
  EXPECT_EQ(FaultOfJson(objects), "layers[0]: field \"layers\" is unknown to this version");
}

TEST(MessageJson, FaultsAreShortLinesOfPlainText) {
  const std::string long_text(100'000, 'a');
  for (const std::string& json :
       {"{\"" + long_text + "\": 1}", "{\"layers\": \"" + long_text + "\"}",
        "{\"layers\": [" + long_text + "]}", std::string("{\"layers\": \"\x01\x1b[2J\"}")}) {
    const std::string fault = FaultOfJson(json);
    EXPECT_LT(fault.size(), 400u);
    for (const char c : fault) EXPECT_TRUE(c >= ' ' && c <= '~') << fault;
  }
}

// Fields of `type` and of the messages in it that the reader has no rule for.
void CollectUnread(const Descriptor& type, std::set<std::string>& seen,
                   std::set<std::string>& unread) {
  if (!seen.insert(type.full_name()).second) return;
  for (int i = 0; i < type.field_count(); ++i) {
    const FieldDescriptor& field = *type.field(i);
    const Descriptor* part = field.message_type();
    const bool of_others = part != nullptr && part->full_name().starts_with("google.") &&
                           part->full_name() != "google.protobuf.Duration";
    if (field.type() == FieldDescriptor::TYPE_BYTES ||
        field.type() == FieldDescriptor::TYPE_FLOAT || of_others ||
        (part != nullptr && field.is_repeated() && part->full_name().starts_with("google.")) ||
        (field.is_map() && part->map_value()->message_type() != nullptr)) {
      unread.insert(field.full_name());
    }
    if (part != nullptr && !part->full_name().starts_with("google.")) {
      CollectUnread(*part, seen, unread);
    }
  }
}

TEST(MessageJson, KnowsEveryKindOfFieldOfTheApi) {
  std::set<std::string> seen, unread;
  CollectUnread(*v1::OptimizeBatchRequest::descriptor(), seen, unread);
  EXPECT_GT(seen.size(), 15u);
  EXPECT_THAT(unread, ::testing::IsEmpty());
}

}  // namespace
}  // namespace traverse

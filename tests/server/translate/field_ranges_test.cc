#include "server/translate/field_ranges.h"

#include <gmock/gmock.h>
#include <google/protobuf/descriptor.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "absl/strings/match.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "server/translate/translate.h"
#include "tests/support/status_matchers.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using ::testing::AnyOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::StatusIs;

bool IsNumber(const FieldDescriptor& field) {
  const FieldDescriptor::CppType type = field.cpp_type();
  return type != FieldDescriptor::CPPTYPE_MESSAGE && type != FieldDescriptor::CPPTYPE_STRING &&
         type != FieldDescriptor::CPPTYPE_ENUM && type != FieldDescriptor::CPPTYPE_BOOL;
}

bool IsDuration(const FieldDescriptor& field) {
  return field.message_type() != nullptr &&
         field.message_type()->full_name() == "google.protobuf.Duration";
}

// All fields that hold numbers, in `message` and below, by the name that the table has for them.
void Collect(const Descriptor* message, std::set<const Descriptor*>& seen,
             std::map<std::string, const FieldDescriptor*>& fields) {
  if (!seen.insert(message).second) return;
  for (int i = 0; i < message->field_count(); ++i) {
    const FieldDescriptor* field = message->field(i);
    if (IsNumber(*field) || IsDuration(*field)) {
      fields[absl::StrCat(message->name(), ".", field->name())] = field;
    } else if (field->message_type() != nullptr) {
      Collect(field->message_type(), seen, fields);
    }
  }
}

std::map<std::string, const FieldDescriptor*> NumericFields() {
  std::set<const Descriptor*> seen;
  std::map<std::string, const FieldDescriptor*> fields;
  Collect(v1::OptimizeBatchRequest::descriptor(), seen, fields);
  Collect(v1::OptimizeRequest::descriptor(), seen, fields);
  return fields;
}

std::string ReadFile(const std::string& path) {
  std::ifstream file(path);
  EXPECT_TRUE(file.good()) << path;
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

// The comment above a field, in one line.
std::string CommentOf(const FieldDescriptor& field) {
  const std::string text = ReadFile(absl::StrCat(TRAVERSE_PROTO_DIR, "/", field.file()->name()));
  std::istringstream lines(text);
  std::string comment;
  bool in_message = false;
  for (std::string line; std::getline(lines, line);) {
    if (absl::StartsWith(line, "message ")) {
      in_message = line == absl::StrCat("message ", field.containing_type()->name(), " {");
    }
    const size_t begin = line.find_first_not_of(' ');
    if (begin == std::string::npos) continue;
    if (line.compare(begin, 3, "// ") == 0) {
      absl::StrAppend(&comment, line.substr(begin + 2));
      continue;
    }
    if (in_message && absl::StrContains(line, absl::StrCat(" ", field.name(), " = "))) {
      return comment;
    }
    comment.clear();
  }
  ADD_FAILURE() << field.full_name() << " has no comment";
  return "";
}

// Whether `comment` says "from LEAST to GREATEST", however the numbers are written.
bool States(const std::string& comment, const FieldRange& range) {
  for (size_t at = comment.find("rom "); at != std::string::npos;
       at = comment.find("rom ", at + 1)) {
    std::istringstream words(comment.substr(at + 4));
    std::string least, to, greatest;
    words >> least >> to >> greatest;
    while (!greatest.empty() &&
           (greatest.back() == '.' || greatest.back() == ',' || greatest.back() == ';')) {
      greatest.pop_back();
    }
    double first = 0;
    double last = 0;
    if (to == "to" && absl::SimpleAtod(least, &first) && absl::SimpleAtod(greatest, &last) &&
        first == range.least && last == range.greatest) {
      return true;
    }
  }
  return false;
}

// A field is added with its range, or its comment says that any value will do (a label, a seed), or
// of what list it is a position.
TEST(FieldRanges, EveryNumberOfARequestHasOne) {
  for (const auto& [name, field] : NumericFields()) {
    const std::string comment = CommentOf(*field);
    const FieldRange* range = nullptr;
    for (const FieldRange& row : FieldRanges()) {
      if (name == row.field) range = &row;
    }
    if (range == nullptr) {
      EXPECT_THAT(comment,
                  AnyOf(HasSubstr("any value"), HasSubstr("Position"), HasSubstr("index from 0")))
          << name << " is not in the table";
    } else {
      EXPECT_TRUE(States(comment, *range)) << name << ":" << comment;
    }
  }
}

TEST(FieldRanges, EveryRowIsOfAField) {
  const auto fields = NumericFields();
  for (const FieldRange& row : FieldRanges()) {
    EXPECT_EQ(fields.count(row.field), 1u) << row.field;
    EXPECT_LE(row.least, row.greatest) << row.field;
    EXPECT_EQ(&RangeOf(row.field), &row);
  }
}

TEST(FieldRanges, ErrorsNamePlaceValueAndRange) {
  const FieldRange range{"X.y", 1e-3, 1e5, /*or_zero=*/true};

  EXPECT_OK(CheckRange(range, 0, "x.y"));
  EXPECT_OK(CheckRange(range, 1e-3, "x.y"));
  EXPECT_OK(CheckRange(range, 1e5, "x.y"));
  EXPECT_THAT(CheckRange(range, 5e-324, "x.y"),
              StatusIs(absl::StatusCode::kInvalidArgument,
                       StartsWith("x.y: 4.94066e-324 is not 0 or from 0.001 to 100000")));
  EXPECT_THAT(CheckRange(range, std::numeric_limits<double>::quiet_NaN(), "x.y"),
              StatusIs(absl::StatusCode::kInvalidArgument, "x.y: not finite"));
}

// Each of these crashed or hung some strategy, or spoilt a metric.
TEST(FieldRanges, VanishingFiguresAreRefused) {
  for (const double tiny : {5e-324, 1e-320, 1e-306, 1e-5}) {
    v1::JobOptions options;
    options.mutable_cost()->mutable_time()->set_speed_mm_s(tiny);
    EXPECT_THAT(JobFromProto(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                                StartsWith("options.cost.time.speed_mm_s: ")));
    options.mutable_cost()->mutable_time()->set_speed_mm_s(100);
    options.mutable_cost()->mutable_time()->set_accel_mm_s2(tiny);
    EXPECT_THAT(JobFromProto(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                                StartsWith("options.cost.time.accel_mm_s2: ")));
    options.clear_cost();
    options.set_idle_speed_mm_s(tiny);
    EXPECT_THAT(JobFromProto(options), StatusIs(absl::StatusCode::kInvalidArgument,
                                                StartsWith("options.idle_speed_mm_s: ")));
    v1::Layer layer;
    layer.mutable_cost()->mutable_time()->set_speed_mm_s(tiny);
    EXPECT_THAT(LayerFromProto(layer, 7, false),
                StatusIs(absl::StatusCode::kInvalidArgument,
                         StartsWith("layers[7].cost.time.speed_mm_s: ")));
  }
}

}  // namespace
}  // namespace traverse

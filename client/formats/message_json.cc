#include "client/formats/message_json.h"

#include <google/protobuf/duration.pb.h>
#include <google/protobuf/util/time_util.h>

#include <cassert>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <string>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "client/files/json.h"

namespace traverse {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

constexpr size_t kMostShown = 60;

// As it may stand in a message.
std::string Shown(const std::string& text) {
  std::string out = absl::CHexEscape(text.substr(0, kMostShown));
  if (text.size() > kMostShown) out += "...";
  return absl::StrCat("\"", out, "\"");
}

std::string Shown(const JsonScalar& value) {
  return std::visit(
      [](const auto& of_type) -> std::string {
        using T = std::decay_t<decltype(of_type)>;
        if constexpr (std::is_same_v<T, std::string>) {
          return Shown(of_type);
        } else if constexpr (std::is_same_v<T, bool>) {
          return of_type ? "true" : "false";
        } else {
          return absl::StrCat(of_type);
        }
      },
      value);
}

std::optional<double> ToDouble(const JsonScalar& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* number = std::get_if<int64_t>(&value)) return static_cast<double>(*number);
  if (const auto* number = std::get_if<uint64_t>(&value)) return static_cast<double>(*number);
  double number = 0;
  const auto* text = std::get_if<std::string>(&value);
  if (text != nullptr && absl::SimpleAtod(*text, &number)) return number;
  return std::nullopt;
}

// A whole number of type T, if `value` is one.
template <typename T>
std::optional<T> ToWhole(const JsonScalar& value) {
  if (const auto* number = std::get_if<int64_t>(&value)) {
    if (std::in_range<T>(*number)) return static_cast<T>(*number);
  } else if (const auto* number = std::get_if<uint64_t>(&value)) {
    if (std::in_range<T>(*number)) return static_cast<T>(*number);
  } else if (const auto* number = std::get_if<double>(&value)) {
    // 2^digits is the first that T has no room for, and a double.
    const double end = std::ldexp(1.0, std::numeric_limits<T>::digits);
    const double begin = std::is_signed_v<T> ? -end : 0;
    if (*number >= begin && *number < end && std::floor(*number) == *number) {
      return static_cast<T>(*number);
    }
  } else if (const auto* text = std::get_if<std::string>(&value)) {
    T number = 0;
    if (absl::SimpleAtoi(*text, &number)) return number;
  }
  return std::nullopt;
}

absl::Status Not(const JsonScalar& value, const char* wanted) {
  return absl::InvalidArgumentError(absl::StrCat(Shown(value), " is not ", wanted));
}

bool IsDuration(const FieldDescriptor& field) {
  return field.message_type() != nullptr &&
         field.message_type() == google::protobuf::Duration::descriptor();
}

// Sets, or adds to, one field. The functions of Reflection come in pairs for each type.
class FieldSetter {
 public:
  FieldSetter(Message& message, const FieldDescriptor& field)
      : message_(message), field_(field), reflection_(*message.GetReflection()) {}

  absl::Status Set(const JsonScalar& value) {
    switch (field_.cpp_type()) {
      case FieldDescriptor::CPPTYPE_DOUBLE:
        return SetDouble(value);
      case FieldDescriptor::CPPTYPE_UINT32:
        return SetWhole<uint32_t>(value, &Reflection::AddUInt32, &Reflection::SetUInt32);
      case FieldDescriptor::CPPTYPE_UINT64:
        return SetWhole<uint64_t>(value, &Reflection::AddUInt64, &Reflection::SetUInt64);
      case FieldDescriptor::CPPTYPE_INT32:
        return SetWhole<int32_t>(value, &Reflection::AddInt32, &Reflection::SetInt32);
      case FieldDescriptor::CPPTYPE_INT64:
        return SetWhole<int64_t>(value, &Reflection::AddInt64, &Reflection::SetInt64);
      case FieldDescriptor::CPPTYPE_BOOL:
        if (!std::holds_alternative<bool>(value)) return Not(value, "true or false");
        return Put(std::get<bool>(value), &Reflection::AddBool, &Reflection::SetBool);
      case FieldDescriptor::CPPTYPE_ENUM:
        return SetEnum(value);
      case FieldDescriptor::CPPTYPE_STRING:
        if (!std::holds_alternative<std::string>(value)) return Not(value, "text");
        return SetText(std::get<std::string>(value));
      default:
        return IsDuration(field_) ? SetDuration(value) : Not(value, "an object");
    }
  }

 private:
  template <typename T, typename Add, typename SetOne>
  absl::Status Put(T value, Add add, SetOne set) {
    if (field_.is_repeated()) {
      (reflection_.*add)(&message_, &field_, value);
    } else {
      (reflection_.*set)(&message_, &field_, value);
    }
    return absl::OkStatus();
  }

  template <typename T, typename Add, typename SetOne>
  absl::Status SetWhole(const JsonScalar& value, Add add, SetOne set) {
    const std::optional<T> whole = ToWhole<T>(value);
    if (whole) return Put(*whole, add, set);
    return absl::InvalidArgumentError(absl::StrCat(Shown(value), " is not a whole number from ",
                                                   std::numeric_limits<T>::min(), " to ",
                                                   std::numeric_limits<T>::max()));
  }

  absl::Status SetDouble(const JsonScalar& value) {
    const std::optional<double> number = ToDouble(value);
    if (!number) return Not(value, "a number");
    return Put(*number, &Reflection::AddDouble, &Reflection::SetDouble);
  }

  absl::Status SetText(const std::string& text) {
    if (field_.is_repeated()) {
      reflection_.AddString(&message_, &field_, text);
    } else {
      reflection_.SetString(&message_, &field_, text);
    }
    return absl::OkStatus();
  }

  absl::Status SetEnum(const JsonScalar& value) {
    const std::optional<int32_t> number = ToWhole<int32_t>(value);
    if (number) return Put(*number, &Reflection::AddEnumValue, &Reflection::SetEnumValue);
    const auto* name = std::get_if<std::string>(&value);
    if (name == nullptr) return Not(value, "the name of a value");
    const auto* found = field_.enum_type()->FindValueByName(*name);
    if (found == nullptr) {
      return absl::UnimplementedError(absl::StrCat(Shown(*name), " is unknown to this version"));
    }
    return Put(found->number(), &Reflection::AddEnumValue, &Reflection::SetEnumValue);
  }

  absl::Status SetDuration(const JsonScalar& value) {
    google::protobuf::Duration duration;
    const auto* text = std::get_if<std::string>(&value);
    if (text == nullptr || !google::protobuf::util::TimeUtil::FromString(*text, &duration)) {
      return Not(value, "a time such as \"1.5s\"");
    }
    reflection_.MutableMessage(&message_, &field_)->CopyFrom(duration);
    return absl::OkStatus();
  }

  Message& message_;
  const FieldDescriptor& field_;
  const Reflection& reflection_;
};

// What is read: an object that stands for a message, or for a map of it.
struct Frame {
  Message* message = nullptr;
  const FieldDescriptor* field = nullptr;  // whose value comes next; of a map, the map
  bool is_map = false;
  bool in_list = false;
  int index = 0;                    // in the list
  uint64_t given = 0;               // a bit for each field
  std::set<std::string> keys = {};  // of the map
  std::string key = {};             // of it, whose value comes next
};

// When an event returns false, status() says why.
class Reader : public JsonEvents {
 public:
  explicit Reader(Message& message) : root_(message) {}

  const absl::Status& status() const { return status_; }

  bool Null() override {
    if (frames_.empty()) return Refuse("null is not an object");
    return frames_.back().in_list || frames_.back().is_map ? Refuse("null is not a value") : true;
  }

  bool Scalar(JsonScalar value) override {
    if (frames_.empty()) return Refuse(absl::StrCat(Shown(value), " is not an object"));
    Frame& frame = frames_.back();
    Message* message = frame.message;
    const FieldDescriptor* field = frame.field;
    if (frame.is_map) {
      message = message->GetReflection()->AddMessage(message, field);
      const Descriptor& entry = *field->message_type();
      field = entry.map_value();
      (void)FieldSetter(*message, *entry.map_key()).Set(frame.key);
    } else if (field->is_repeated() && !frame.in_list) {
      return Refuse(
          absl::StrCat(Shown(value), " is not ", field->is_map() ? "an object" : "a list"));
    }
    const absl::Status status = FieldSetter(*message, *field).Set(value);
    if (!status.ok()) return Refuse(status);
    Next();
    return true;
  }

  bool BeginObject() override {
    if (frames_.empty()) {
      frames_.push_back({.message = &root_});
      return true;
    }
    const Frame& frame = frames_.back();
    const FieldDescriptor& field = *frame.field;
    if (field.is_map() && !frame.is_map) {
      frames_.push_back({.message = frame.message, .field = &field, .is_map = true});
      return true;
    }
    const bool of_message = field.message_type() != nullptr && !frame.is_map && !IsDuration(field);
    if (!of_message) return Refuse("an object is not its value");
    if (field.is_repeated() && !frame.in_list) return Refuse("an object is not a list");
    const Reflection& reflection = *frame.message->GetReflection();
    Message* const part = field.is_repeated() ? reflection.AddMessage(frame.message, &field)
                                              : reflection.MutableMessage(frame.message, &field);
    frames_.push_back({.message = part});
    return true;
  }

  bool Key(std::string& name) override {
    Frame& frame = frames_.back();
    if (frame.is_map) {
      frame.key = name;
      return frame.keys.insert(name).second || Refuse("given twice");
    }
    frame.field = nullptr;
    const Descriptor& type = *frame.message->GetDescriptor();
    const FieldDescriptor* field = type.FindFieldByName(name);
    if (field == nullptr) field = type.FindFieldByCamelcaseName(name);
    if (field == nullptr) {
      const std::string place = Place();
      status_ = absl::UnimplementedError(absl::StrCat(place, place.empty() ? "" : ": ", "field ",
                                                      Shown(name), " is unknown to this version"));
      return false;
    }
    frame.field = field;
    assert(type.field_count() <= 64);
    const uint64_t bit = uint64_t{1} << field->index();
    if ((frame.given & bit) != 0) return Refuse("given twice");
    frame.given |= bit;
    const auto* choice = field->real_containing_oneof();
    if (choice != nullptr && frame.message->GetReflection()->HasOneof(*frame.message, choice)) {
      const auto* other =
          frame.message->GetReflection()->GetOneofFieldDescriptor(*frame.message, choice);
      return Refuse(absl::StrCat("given beside ", other->name()));
    }
    return true;
  }

  bool EndObject() override {
    frames_.pop_back();
    Next();
    return true;
  }

  bool BeginArray() override {
    if (frames_.empty()) return Refuse("a list is not an object");
    Frame& frame = frames_.back();
    const bool of_list = frame.field->is_repeated() && !frame.field->is_map() && !frame.in_list;
    if (!of_list) return Refuse("a list is not its value");
    frame.in_list = true;
    frame.index = 0;
    return true;
  }

  bool EndArray() override {
    frames_.back().in_list = false;
    return true;
  }

  void Fault(std::string_view fault) override {
    Refuse(absl::CHexEscape(std::string(fault.substr(0, 3 * kMostShown))));
  }

 private:
  void Next() {
    if (!frames_.empty() && frames_.back().in_list) ++frames_.back().index;
  }

  bool Refuse(const absl::Status& status) {
    const std::string place = Place();
    status_ = absl::Status(status.code(),
                           absl::StrCat(place, place.empty() ? "" : ": ", status.message()));
    return false;
  }
  bool Refuse(const std::string& text) { return Refuse(absl::InvalidArgumentError(text)); }

  // Of the value that comes next.
  std::string Place() const {
    std::string place;
    for (const Frame& frame : frames_) {
      if (frame.is_map) {
        absl::StrAppend(&place, "[", Shown(frame.key), "]");
        continue;
      }
      if (frame.field == nullptr) continue;
      absl::StrAppend(&place, place.empty() ? "" : ".", frame.field->name());
      if (frame.in_list) absl::StrAppend(&place, "[", frame.index, "]");
    }
    return place;
  }

  Message& root_;
  std::vector<Frame> frames_;
  absl::Status status_;
};

}  // namespace

absl::Status ReadMessageJson(std::string_view json, google::protobuf::Message& message) {
  Reader reader(message);
  if (!ReadJson(json, reader)) return reader.status();
  return absl::OkStatus();
}

}  // namespace traverse

#include "tests/fuzz/support/proto_mutator.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace traverse::fuzz {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::Reflection;

size_t Below(size_t n, std::mt19937& random) {
  return std::uniform_int_distribution<size_t>(0, n - 1)(random);
}

template <typename T, size_t kSize>
T OneOf(const T (&values)[kSize], std::mt19937& random) {
  return values[Below(kSize, random)];
}

double RandomDouble(std::mt19937& random) {
  constexpr double kValues[] = {0.0,
                                -0.0,
                                1.0,
                                -1.0,
                                0.5,
                                10.0,
                                1e-3,
                                1e-300,
                                5e-324,
                                1e6,
                                -1e6,
                                1e6 + 1,
                                1e9,
                                1e18,
                                1e300,
                                -1e300,
                                std::numeric_limits<double>::infinity(),
                                -std::numeric_limits<double>::infinity(),
                                std::numeric_limits<double>::quiet_NaN()};
  if (random() % 2 == 0) return OneOf(kValues, random);
  return std::uniform_real_distribution<double>(-200.0, 200.0)(random);
}

uint64_t RandomInteger(std::mt19937& random) {
  constexpr uint64_t kValues[] = {0,
                                  1,
                                  2,
                                  3,
                                  4,
                                  7,
                                  100,
                                  256,
                                  65535,
                                  0x7fffffff,
                                  0x80000000,
                                  0xffffffff,
                                  uint64_t{1} << 62,
                                  uint64_t{1} << 63,
                                  ~uint64_t{0}};
  if (random() % 4 != 0) return OneOf(kValues, random);
  return random() % 64;
}

std::string RandomString(std::mt19937& random) {
  const char* const kValues[] = {"",     "none", "greedy", "ni2opt", "tabu", "exact",
                                 "auto", "true", "false",  "-1",     "0",    "1e400",
                                 "nan",  "SP",   "time",   "gap",    "10",   "\xc3\x28"};
  if (random() % 8 != 0) return OneOf(kValues, random);
  std::string text(Below(300, random), '\0');
  for (char& c : text) c = static_cast<char>(random() % 128);
  return text;
}

// Sets `field` of `message`, or appends to it, or replaces its element `index`.
enum class How { kSet, kAdd, kReplace };

void PutScalar(Message& message, const FieldDescriptor* field, How how, int index,
               std::mt19937& random) {
  const Reflection& access = *message.GetReflection();
  const auto put = [&](auto value, auto set, auto add, auto replace) {
    if (how == How::kSet) (access.*set)(&message, field, value);
    if (how == How::kAdd) (access.*add)(&message, field, value);
    if (how == How::kReplace) (access.*replace)(&message, field, index, value);
  };
  using R = Reflection;
  switch (field->cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
      return put(RandomDouble(random), &R::SetDouble, &R::AddDouble, &R::SetRepeatedDouble);
    case FieldDescriptor::CPPTYPE_FLOAT:
      return put(static_cast<float>(RandomDouble(random)), &R::SetFloat, &R::AddFloat,
                 &R::SetRepeatedFloat);
    case FieldDescriptor::CPPTYPE_INT32:
      return put(static_cast<int32_t>(RandomInteger(random)), &R::SetInt32, &R::AddInt32,
                 &R::SetRepeatedInt32);
    case FieldDescriptor::CPPTYPE_INT64:
      return put(static_cast<int64_t>(RandomInteger(random)), &R::SetInt64, &R::AddInt64,
                 &R::SetRepeatedInt64);
    case FieldDescriptor::CPPTYPE_UINT32:
      return put(static_cast<uint32_t>(RandomInteger(random)), &R::SetUInt32, &R::AddUInt32,
                 &R::SetRepeatedUInt32);
    case FieldDescriptor::CPPTYPE_UINT64:
      return put(RandomInteger(random), &R::SetUInt64, &R::AddUInt64, &R::SetRepeatedUInt64);
    case FieldDescriptor::CPPTYPE_BOOL:
      return put(random() % 2 == 0, &R::SetBool, &R::AddBool, &R::SetRepeatedBool);
    case FieldDescriptor::CPPTYPE_ENUM:
      return put(static_cast<int>(random() % 6), &R::SetEnumValue, &R::AddEnumValue,
                 &R::SetRepeatedEnumValue);
    case FieldDescriptor::CPPTYPE_STRING: {
      const std::string text = RandomString(random);
      if (how == How::kSet) access.SetString(&message, field, text);
      if (how == How::kAdd) access.AddString(&message, field, text);
      if (how == How::kReplace) access.SetRepeatedString(&message, field, index, text);
      return;
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      return;  // changed from inside
  }
}

// A message of `message`'s tree, each of the fields of the travel equally likely to be entered.
Message& PickMessage(Message& message, std::mt19937& random) {
  const Reflection& access = *message.GetReflection();
  std::vector<const FieldDescriptor*> set;
  access.ListFields(message, &set);
  std::vector<Message*> inner;
  for (const FieldDescriptor* field : set) {
    if (field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) continue;
    if (!field->is_repeated()) {
      inner.push_back(access.MutableMessage(&message, field));
    } else {
      const auto size = static_cast<size_t>(access.FieldSize(message, field));
      inner.push_back(
          access.MutableRepeatedMessage(&message, field, static_cast<int>(Below(size, random))));
    }
  }
  if (inner.empty() || random() % 5 == 0) return message;
  return PickMessage(*inner[Below(inner.size(), random)], random);
}

void ChangeList(Message& message, const FieldDescriptor* field, std::mt19937& random) {
  const Reflection& access = *message.GetReflection();
  const int size = access.FieldSize(message, field);
  const bool messages = field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE;
  const auto any = [&] { return static_cast<int>(Below(static_cast<size_t>(size), random)); };
  switch (size == 0 ? 0 : random() % 5) {
    case 0:  // one more, new
      if (messages) {
        access.AddMessage(&message, field);
      } else {
        PutScalar(message, field, How::kAdd, 0, random);
      }
      return;
    case 1:  // one more, a copy
      if (messages && !field->is_map()) {
        const int from = any();
        access.AddMessage(&message, field)
            ->CopyFrom(access.GetRepeatedMessage(message, field, from));
      }
      return;
    case 2:
      return access.SwapElements(&message, field, any(), any());
    case 3:
      return access.RemoveLast(&message, field);
    default:
      if (!messages) PutScalar(message, field, How::kReplace, any(), random);
  }
}

}  // namespace

void MutateMessage(Message& message, const Message& donor, std::mt19937& random) {
  if (random() % 20 == 0) {
    message.MergeFrom(donor);
    return;
  }
  Message& place = PickMessage(message, random);
  const Descriptor& type = *place.GetDescriptor();
  if (type.field_count() == 0) return;
  const FieldDescriptor* field =
      type.field(static_cast<int>(Below(static_cast<size_t>(type.field_count()), random)));
  const Reflection& access = *place.GetReflection();
  if (field->is_repeated()) {
    ChangeList(place, field, random);
  } else if (random() % 6 == 0) {
    access.ClearField(&place, field);
  } else if (field->cpp_type() == FieldDescriptor::CPPTYPE_MESSAGE) {
    access.MutableMessage(&place, field);
  } else {
    PutScalar(place, field, How::kSet, 0, random);
  }
}

}  // namespace traverse::fuzz

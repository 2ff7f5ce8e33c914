#include "client/gateway/api/message_schemas.h"

#include <string>
#include <utility>

namespace traverse::gateway {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

// As protobuf's mapping writes a value; what it also reads is in message_json.h.
Json ValueSchema(const FieldDescriptor& field, Json& schemas) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_FLOAT:
      return JsonObject{{"type", "number"}};
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_UINT32:
      return JsonObject{{"type", "integer"}};
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_UINT64:
      return JsonObject{{"type", JsonArray{"string", "integer"}}, {"format", "int64"}};
    case FieldDescriptor::CPPTYPE_BOOL:
      return JsonObject{{"type", "boolean"}};
    case FieldDescriptor::CPPTYPE_STRING:
      return JsonObject{{"type", "string"}};
    case FieldDescriptor::CPPTYPE_ENUM: {
      JsonArray names;
      for (int i = 0; i < field.enum_type()->value_count(); ++i) {
        names.push_back(field.enum_type()->value(i)->name());
      }
      return JsonObject{{"type", "string"}, {"enum", names}};
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      break;
  }
  const std::string& type = field.message_type()->full_name();
  if (type == "google.protobuf.Timestamp") {
    return JsonObject{{"type", "string"}, {"format", "date-time"}};
  }
  if (type == "google.protobuf.Duration") {
    return JsonObject{{"type", "string"}, {"pattern", "^-?[0-9.]+s$"}};
  }
  AddSchema(*field.message_type(), schemas);
  return JsonObject{{"$ref", "#/components/schemas/" + field.message_type()->name()}};
}

Json FieldSchema(const FieldDescriptor& field, Json& schemas) {
  if (field.is_map()) {
    return JsonObject{
        {"type", "object"},
        {"additionalProperties", ValueSchema(*field.message_type()->map_value(), schemas)}};
  }
  Json value = ValueSchema(field, schemas);
  if (!field.is_repeated()) return value;
  return JsonObject{{"type", "array"}, {"items", std::move(value)}};
}

}  // namespace

void AddSchema(const Descriptor& type, Json& schemas) {
  if (schemas.Find(type.name()) != nullptr) return;
  schemas[type.name()] = JsonObject();  // so that a message may hold itself
  Json properties = JsonObject();
  for (int i = 0; i < type.field_count(); ++i) {
    properties[type.field(i)->name()] = FieldSchema(*type.field(i), schemas);
  }
  schemas[type.name()] = JsonObject{{"type", "object"}, {"properties", std::move(properties)}};
}

}  // namespace traverse::gateway

#include "client/gateway/api/message_schemas.h"

#include <string>
#include <utility>

namespace traverse::gateway {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using SchemaJson = nlohmann::ordered_json;

// As protobuf's mapping writes a value; what it also reads is in message_json.h.
SchemaJson ValueSchema(const FieldDescriptor& field, SchemaJson& schemas) {
  switch (field.cpp_type()) {
    case FieldDescriptor::CPPTYPE_DOUBLE:
    case FieldDescriptor::CPPTYPE_FLOAT:
      return {{"type", "number"}};
    case FieldDescriptor::CPPTYPE_INT32:
    case FieldDescriptor::CPPTYPE_UINT32:
      return {{"type", "integer"}};
    case FieldDescriptor::CPPTYPE_INT64:
    case FieldDescriptor::CPPTYPE_UINT64:
      return {{"type", {"string", "integer"}}, {"format", "int64"}};
    case FieldDescriptor::CPPTYPE_BOOL:
      return {{"type", "boolean"}};
    case FieldDescriptor::CPPTYPE_STRING:
      return {{"type", "string"}};
    case FieldDescriptor::CPPTYPE_ENUM: {
      SchemaJson names = SchemaJson::array();
      for (int i = 0; i < field.enum_type()->value_count(); ++i) {
        names.push_back(field.enum_type()->value(i)->name());
      }
      return {{"type", "string"}, {"enum", names}};
    }
    case FieldDescriptor::CPPTYPE_MESSAGE:
      break;
  }
  const std::string& type = field.message_type()->full_name();
  if (type == "google.protobuf.Timestamp") return {{"type", "string"}, {"format", "date-time"}};
  if (type == "google.protobuf.Duration") return {{"type", "string"}, {"pattern", "^-?[0-9.]+s$"}};
  AddSchema(*field.message_type(), schemas);
  return {{"$ref", "#/components/schemas/" + field.message_type()->name()}};
}

SchemaJson FieldSchema(const FieldDescriptor& field, SchemaJson& schemas) {
  if (field.is_map()) {
    return {{"type", "object"},
            {"additionalProperties", ValueSchema(*field.message_type()->map_value(), schemas)}};
  }
  SchemaJson value = ValueSchema(field, schemas);
  if (!field.is_repeated()) return value;
  return {{"type", "array"}, {"items", std::move(value)}};
}

}  // namespace

void AddSchema(const Descriptor& type, SchemaJson& schemas) {
  if (schemas.contains(type.name())) return;
  schemas[type.name()] = SchemaJson::object();  // so that a message may hold itself
  SchemaJson properties = SchemaJson::object();
  for (int i = 0; i < type.field_count(); ++i) {
    properties[type.field(i)->name()] = FieldSchema(*type.field(i), schemas);
  }
  schemas[type.name()] = {{"type", "object"}, {"properties", std::move(properties)}};
}

}  // namespace traverse::gateway

// Messages of the API as schemas of JSON, as far as their descriptors say.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_MESSAGE_SCHEMAS_H_
#define TRAVERSE_CLIENT_GATEWAY_API_MESSAGE_SCHEMAS_H_

#include <google/protobuf/descriptor.h>

#include "client/files/json.h"

namespace traverse::gateway {

// Adds the schema of `type`, and of all messages in it, to `schemas` under their names, which are
// those of the .proto without the package.
void AddSchema(const google::protobuf::Descriptor& type, Json& schemas);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_MESSAGE_SCHEMAS_H_

// The part of the gateway's OpenAPI document that is written by hand, openapi.json.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_OUTLINE_H_
#define TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_OUTLINE_H_

#include <string_view>

namespace traverse::gateway {

// Where `problems` stand for responses, and the names of tables for parameters.
std::string_view OpenApiOutline();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_OUTLINE_H_

// GET /openapi.json: the gateway's API as OpenAPI 3.1.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_
#define TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_

#include <string>

namespace traverse::gateway {

// The document. Its parameters are the rows of ParameterTable.
std::string OpenApiJson();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_

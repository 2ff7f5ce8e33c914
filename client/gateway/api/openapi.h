// GET /openapi.json: the gateway's API as OpenAPI 3.1.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_
#define TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_

#include <string>

namespace traverse::gateway {

// The document, made once: strangers may ask for it as often as they like. Its parameters are the
// rows of ParameterTable.
const std::string& OpenApiJson();

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_OPENAPI_H_

#include "client/gateway/api/openapi.h"

#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/cli/flags/flags.h"
#include "client/cli/flags/verify_flags.h"
#include "client/files/json_text.h"
#include "client/gateway/api/message_schemas.h"
#include "client/gateway/api/openapi_outline.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/http/problem.h"
#include "server/version.h"
#include "traverse/v1/gcode_service.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gateway {
namespace {

using Json = nlohmann::ordered_json;

Json ParameterJson(const cli::Flag& flag) {
  Json schema = {{"type", flag.value.empty() ? "boolean" : "string"}};
  if (!flag.choices.empty()) schema["enum"] = flag.choices;
  Json out = {{"name", flag.name}, {"in", "query"}, {"description", flag.help}};
  if (flag.repeatable) {
    schema = {{"type", "array"}, {"items", {{"type", "string"}}}};
    out["explode"] = true;
  }
  out["schema"] = std::move(schema);
  return out;
}

// A word among the parameters stands for the rows of a table.
Json WithTables(const Json& parameters) {
  Json out = Json::array();
  for (const Json& parameter : parameters) {
    if (!parameter.is_string()) {
      out.push_back(parameter);
      continue;
    }
    const bool verify = parameter == "verify";
    for (const cli::Flag& flag : verify ? cli::VerifyFlagTable() : ParameterTable()) {
      out.push_back(ParameterJson(flag));
    }
  }
  return out;
}

// The numbers in `problems` become responses.
void Complete(Json& operation) {
  for (const int status : operation["problems"]) {
    Json& response = operation["responses"][std::to_string(status)];
    response["description"] = ReasonOf(status);
    response["content"]["application/problem+json"]["schema"]["$ref"] =
        "#/components/schemas/Problem";
  }
  operation.erase("problems");
  if (operation.contains("parameters")) {
    operation["parameters"] = WithTables(operation["parameters"]);
  }
}

std::string DocumentText() {
  Json document = ParseOrderedJson(OpenApiOutline());
  document["info"]["version"] = kVersion;
  for (Json& path : document["paths"]) {
    for (const char* method : {"get", "post", "delete"}) {
      if (path.contains(method)) Complete(path[method]);
    }
  }
  for (const auto* type :
       {v1::RewriteSummary::descriptor(), v1::InspectResponse::descriptor(), v1::Job::descriptor(),
        v1::VerifyResponse::descriptor(), v1::OptimizeBatchRequest::descriptor(),
        v1::OptimizeBatchResponse::descriptor(), v1::ListStrategiesResponse::descriptor()}) {
    AddSchema(*type, document["components"]["schemas"]);
  }
  return JsonText(document, 1) + "\n";
}

}  // namespace

const std::string& OpenApiJson() {
  static const auto& text = *new std::string(DocumentText());
  return text;
}

}  // namespace traverse::gateway

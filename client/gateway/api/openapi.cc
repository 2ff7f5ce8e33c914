#include "client/gateway/api/openapi.h"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "client/cli/flags/flags.h"
#include "client/cli/flags/verify_flags.h"
#include "client/files/json.h"
#include "client/gateway/api/message_schemas.h"
#include "client/gateway/api/openapi_outline.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/http/problem.h"
#include "server/version.h"
#include "traverse/v1/gcode_service.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gateway {
namespace {

Json ParameterJson(const cli::Flag& flag) {
  Json schema = JsonObject{{"type", flag.value.empty() ? "boolean" : "string"}};
  if (!flag.choices.empty()) schema["enum"] = JsonArray(flag.choices.begin(), flag.choices.end());
  Json out = JsonObject{{"name", flag.name}, {"in", "query"}, {"description", flag.help}};
  if (flag.repeatable) {
    schema = JsonObject{{"type", "array"}, {"items", JsonObject{{"type", "string"}}}};
    out["explode"] = true;
  }
  out["schema"] = std::move(schema);
  return out;
}

// A word among the parameters stands for the rows of a table.
Json WithTables(const JsonArray& parameters) {
  JsonArray out;
  for (const Json& parameter : parameters) {
    if (parameter.Text() == nullptr) {
      out.push_back(parameter);
      continue;
    }
    const bool verify = *parameter.Text() == "verify";
    for (const cli::Flag& flag : verify ? cli::VerifyFlagTable() : ParameterTable()) {
      out.push_back(ParameterJson(flag));
    }
  }
  return out;
}

// The numbers in `problems` become responses.
void Complete(Json& operation) {
  for (const Json& problem : operation["problems"].items()) {
    const int status = static_cast<int>(*problem.Unsigned());
    Json& response = operation["responses"][std::to_string(status)];
    response["description"] = ReasonOf(status);
    response["content"]["application/problem+json"]["schema"]["$ref"] =
        "#/components/schemas/Problem";
  }
  std::erase_if(operation.members(),
                [](const JsonMember& member) { return member.name == "problems"; });
  if (Json* const parameters = operation.Find("parameters")) {
    *parameters = WithTables(parameters->items());
  }
}

std::string DocumentText() {
  Json document = ParseJson(OpenApiOutline()).value();
  document["info"]["version"] = kVersion;
  for (JsonMember& path : document["paths"].members()) {
    for (const char* method : {"get", "post", "delete"}) {
      if (Json* const operation = path.value.Find(method)) Complete(*operation);
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

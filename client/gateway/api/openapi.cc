#include "client/gateway/api/openapi.h"

#include <nlohmann/json.hpp>

#include "client/cli/flags/flags.h"
#include "client/cli/flags/verify_flags.h"
#include "client/files/json_text.h"
#include "client/gateway/api/message_schemas.h"
#include "client/gateway/api/parameters.h"
#include "client/gateway/http/problem.h"
#include "server/version.h"
#include "traverse/v1/gcode_service.pb.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gateway {
namespace {

using Json = nlohmann::ordered_json;

Json Reference(const char* name) { return {{"$ref", std::string("#/components/schemas/") + name}}; }

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

Json ParametersJson(const std::vector<cli::Flag>& table) {
  Json out = Json::array();
  for (const cli::Flag& flag : table) out.push_back(ParameterJson(flag));
  return out;
}

Json FileContent() {
  const Json binary = {{"type", "string"}, {"contentMediaType", "application/octet-stream"}};
  return {{"application/octet-stream", {{"schema", binary}}},
          {"text/x.gcode", {{"schema", binary}}},
          {"multipart/form-data",
           {{"schema",
             {{"type", "object"},
              {"required", {"file"}},
              {"properties", {{"file", binary}, {"machine", binary}}}}}}}};
}

Json ProblemResponse(int status) {
  return {{"description", ReasonOf(status)},
          {"content", {{"application/problem+json", {{"schema", Reference("Problem")}}}}}};
}

void AddProblems(Json& responses, std::initializer_list<int> statuses) {
  for (const int status : statuses) responses[std::to_string(status)] = ProblemResponse(status);
}

Json JsonAnswer(const char* description, const char* schema) {
  return {{"description", description},
          {"content", {{"application/json", {{"schema", Reference(schema)}}}}}};
}

Json RewritePath() {
  Json ok = {{"description",
              "The rewritten file. Depending on Accept only its summary, or events: progress, file "
              "and report (base64, in pieces), then summary or problem. With report=true and "
              "without events: the page."}};
  ok["headers"] = {
      {"Traverse-Summary", {{"description", "One line"}, {"schema", {{"type", "string"}}}}},
      {"Traverse-Travel-Mm",
       {{"description", "Travel of the new file, mm"}, {"schema", {{"type", "number"}}}}}};
  ok["content"] = {{"text/x.gcode", {{"schema", {{"type", "string"}}}}},
                   {"application/octet-stream", {{"schema", {{"type", "string"}}}}},
                   {"application/json", {{"schema", Reference("RewriteSummary")}}},
                   {"text/event-stream", {{"schema", {{"type", "string"}}}}},
                   {"text/html", {{"schema", {{"type", "string"}}}}}};
  Json responses = {{"200", ok}};
  AddProblems(responses, {400, 401, 403, 408, 413, 415, 421, 422, 429, 503, 504, 507});
  return {{"post",
           {{"operationId", "rewrite"},
            {"summary", "The same print with less travel."},
            {"parameters", ParametersJson(ParameterTable())},
            {"requestBody", {{"required", true}, {"content", FileContent()}}},
            {"responses", responses}}}};
}

Json InspectPath() {
  Json responses = {{"200", JsonAnswer("The contents of the file.", "InspectResponse")}};
  AddProblems(responses, {400, 401, 403, 408, 413, 415, 421, 429, 503, 507});
  return {{"post",
           {{"operationId", "inspect"},
            {"summary", "Describes a file."},
            {"requestBody", {{"required", true}, {"content", FileContent()}}},
            {"responses", responses}}}};
}

Json VerifyPath() {
  const Json binary = {{"type", "string"}, {"contentMediaType", "application/octet-stream"}};
  Json responses = {{"200", JsonAnswer("Whether the files print the same.", "VerifyResponse")}};
  AddProblems(responses, {400, 401, 403, 408, 413, 421, 429, 503, 507});
  return {{"post",
           {{"operationId", "verify"},
            {"summary", "Checks that two files print exactly the same."},
            {"parameters", ParametersJson(cli::VerifyFlagTable())},
            {"requestBody",
             {{"required", true},
              {"content",
               {{"multipart/form-data",
                 {{"schema",
                   {{"type", "object"},
                    {"required", {"original", "optimised"}},
                    {"properties", {{"original", binary}, {"optimised", binary}}}}}}}}}}},
            {"responses", responses}}}};
}

Json IdParameter() {
  return {{"name", "id"},
          {"in", "path"},
          {"required", true},
          {"description", "As POST /v1/jobs answered it; it begins with the gateway's name."},
          {"schema", {{"type", "string"}}}};
}

Json HeaderParameter(const char* name, const char* description) {
  return {{"name", name},
          {"in", "header"},
          {"description", description},
          {"schema", {{"type", "string"}}}};
}

// A method of one job: besides its own problems those of ids.
Json OnJob(const char* id, const char* summary, Json responses) {
  AddProblems(responses, {401, 403, 404, 410, 421});
  return {{"operationId", id}, {"summary", summary}, {"responses", std::move(responses)}};
}

Json JobsPath() {
  Json parameters = ParametersJson(ParameterTable());
  parameters.push_back(
      HeaderParameter("Idempotency-Key",
                      "The caller's own, at most 255 printable ASCII characters: the same key, "
                      "file and parameters make one job."));
  Json accepted = JsonAnswer("The job; Location has its path.", "Job");
  accepted["headers"] = {{"Location", {{"schema", {{"type", "string"}}}}}};
  Json responses = {{"202", accepted}};
  AddProblems(responses, {400, 401, 403, 408, 409, 413, 415, 421, 429, 503, 507});
  return {{"post",
           {{"operationId", "createJob"},
            {"summary", "Takes a file, whose work goes on without the request."},
            {"parameters", parameters},
            {"requestBody", {{"required", true}, {"content", FileContent()}}},
            {"responses", responses}}}};
}

Json JobPath() {
  Json state = JsonAnswer(
      "The job now. With Accept: text/event-stream the job whenever it changes: progress, then "
      "done "
      "or failed; problem if it goes away.",
      "Job");
  state["content"]["text/event-stream"] = {{"schema", {{"type", "string"}}}};
  Json get = OnJob("getJob", "The state of a job.",
                   {{"200", state},
                    {"204", {{"description", "The client knows the job's last event."}}},
                    {"400", ProblemResponse(400)}});
  get["parameters"] =
      Json::array({HeaderParameter("Last-Event-ID", "Only what is newer is sent.")});
  return {{"parameters", Json::array({IdParameter()})},
          {"get", get},
          {"delete", OnJob("cancelJob", "Ends a job and deletes all of it.",
                           {{"204", {{"description", "There is no such job any more."}}}})}};
}

Json JobPartPath(const char* id, const char* summary, Json content) {
  Json responses = {{"200", {{"description", "OK"}, {"content", std::move(content)}}}};
  // While it is under way 409, and if it failed as POST /v1/gcode.
  AddProblems(responses, {400, 409, 413, 415, 422, 503, 504});
  return {{"parameters", Json::array({IdParameter()})},
          {"get", OnJob(id, summary, std::move(responses))}};
}

Json TextPath(const char* id, const char* summary, const char* type, bool open) {
  Json get = {
      {"operationId", id},
      {"summary", summary},
      {"responses", {{"200", {{"description", "OK"}, {"content", {{type, Json::object()}}}}}}}};
  if (open) get["security"] = Json::array();
  AddProblems(get["responses"], {open ? 405 : 401});
  return {{"get", get}};
}

Json OptimizePath() {
  Json ok = {{"description",
              "A line for each layer as it comes, and one for the summary. A last line {\"error\": "
              "Problem} says why the answer is not whole. With Accept: application/json all "
              "messages in one document."}};
  ok["content"] = {
      {"application/x-ndjson", {{"schema", Reference("OptimizeBatchResponse")}}},
      {"application/json",
       {{"schema",
         {{"type", "object"},
          {"properties",
           {{"results", {{"type", "array"}, {"items", Reference("OptimizeBatchResponse")}}}}}}}}}};
  Json responses = {{"200", ok}};
  AddProblems(responses, {400, 401, 403, 408, 413, 415, 421, 429, 500, 501, 503, 504, 507});
  const Json deadline = {{"name", "deadline"},
                         {"in", "query"},
                         {"description", "time for the whole answer, such as 500ms, 30s or 5m"},
                         {"schema", {{"type", "string"}}}};
  return {
      {"post",
       {{"operationId", "optimize"},
        {"summary", "Short routes through the paths of layers."},
        {"parameters", Json::array({deadline})},
        {"requestBody",
         {{"required", true},
          {"content", {{"application/json", {{"schema", Reference("OptimizeBatchRequest")}}}}}}},
        {"responses", responses}}}};
}

Json StrategiesPath() {
  Json responses = {
      {"200", JsonAnswer("The strategies and their options.", "ListStrategiesResponse")}};
  AddProblems(responses, {400, 401, 403, 405, 421, 429, 503, 504});
  return {{"get",
           {{"operationId", "listStrategies"},
            {"summary", "What the service can do."},
            {"responses", responses}}}};
}

Json Schemas() {
  const Json fault = {
      {"type", "object"},
      {"properties", {{"field", {{"type", "string"}}}, {"description", {{"type", "string"}}}}}};
  Json schemas = {{"Problem",
                   {{"type", "object"},
                    {"description", "RFC 9457; code, details and retry_after of /v1/optimize"},
                    {"properties",
                     {{"type", {{"type", "string"}}},
                      {"title", {{"type", "string"}}},
                      {"status", {{"type", "integer"}}},
                      {"detail", {{"type", "string"}}},
                      {"code", {{"type", "string"}}},
                      {"details", {{"type", "array"}, {"items", fault}}},
                      {"retry_after", {{"type", "integer"}}}}}}}};
  for (const auto* type :
       {v1::RewriteSummary::descriptor(), v1::InspectResponse::descriptor(), v1::Job::descriptor(),
        v1::VerifyResponse::descriptor(), v1::OptimizeBatchRequest::descriptor(),
        v1::OptimizeBatchResponse::descriptor(), v1::ListStrategiesResponse::descriptor()}) {
    AddSchema(*type, schemas);
  }
  return schemas;
}

std::string DocumentText() {
  const Json text = {{"schema", {{"type", "string"}}}};
  Json paths = {{"/v1/gcode", RewritePath()},
                {"/v1/jobs", JobsPath()},
                {"/v1/jobs/{id}", JobPath()},
                {"/v1/jobs/{id}/file",
                 JobPartPath("getJobFile", "The new file.",
                             {{"text/x.gcode", text}, {"application/octet-stream", text}})},
                {"/v1/jobs/{id}/report",
                 JobPartPath("getJobReport", "The page that shows each layer, if asked for.",
                             {{"text/html", text}})},
                {"/v1/inspect", InspectPath()},
                {"/v1/optimize", OptimizePath()},
                {"/v1/strategies", StrategiesPath()},
                {"/v1/verify", VerifyPath()},
                {"/healthz", TextPath("healthz", "The process lives.", "text/plain", true)},
                {"/readyz", TextPath("readyz", "The gateway accepts files.", "text/plain", true)},
                {"/openapi.json", TextPath("openapi", "This document.", "application/json", true)},
                {"/metrics", TextPath("metrics", "Metrics for Prometheus.", "text/plain", false)}};
  const Json document = {
      {"openapi", "3.1.0"},
      {"info",
       {{"title", "traverse-gateway"},
        {"version", kVersion},
        {"summary", "Rewrites sliced files so that they print the same with less travel."},
        {"license", {{"name", "Apache-2.0"}, {"identifier", "Apache-2.0"}}}}},
      {"servers", {{{"url", "/"}}}},
      {"security", {{{"bearer", Json::array()}}, {{"key", Json::array()}}, Json::object()}},
      {"paths", paths},
      {"components",
       {{"schemas", Schemas()},
        {"securitySchemes",
         {{"bearer", {{"type", "http"}, {"scheme", "bearer"}}},
          {"key", {{"type", "apiKey"}, {"in", "header"}, {"name", "X-Api-Key"}}}}}}}};
  return JsonText(document, 1) + "\n";
}

}  // namespace

const std::string& OpenApiJson() {
  static const auto& text = *new std::string(DocumentText());
  return text;
}

}  // namespace traverse::gateway

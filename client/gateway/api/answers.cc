#include "client/gateway/api/answers.h"

#include <string_view>
#include <utility>
#include <variant>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/containers/container.h"
#include "client/gateway/http/problem.h"

namespace traverse::gateway {

HttpResponse JsonResponse(std::string json) {
  HttpResponse response;
  response.content_type = "application/json";
  response.body = std::move(json);
  return response;
}

HttpResponse NotAllowed(const std::string& allowed) {
  HttpResponse response = Problem(405, absl::StrCat("only ", allowed, " is allowed for this path"));
  response.headers.emplace_back("Allow", allowed);
  return response;
}

bool IsGet(const HttpRequest& request) {
  return request.method == "GET" || request.method == "HEAD";
}

std::string Event(const std::string& name, const std::string& data, const std::string& id) {
  return absl::StrCat(id.empty() ? "" : "id: ", id, id.empty() ? "" : "\n", "event: ", name,
                      "\ndata: ", data, "\n\n");
}

std::string ProblemEvent(const HttpResponse& refusal) {
  std::string json = std::get<std::string>(refusal.body);
  json.pop_back();  // the line break
  return Event("problem", json);
}

bool WantsEvents(const HttpRequest& request) {
  return absl::StrContains(request.Header("accept"), "text/event-stream");
}

std::stop_source StopWhenGone(HttpReply& reply) {
  std::stop_source stop;
  reply.OnGone([stop]() mutable { stop.request_stop(); });
  return stop;
}

HttpResponse EventsHead() {
  HttpResponse head;
  head.content_type = "text/event-stream";
  head.headers.emplace_back("Cache-Control", "no-store");
  head.headers.emplace_back("X-Accel-Buffering", "no");
  return head;
}

std::string ContentTypeOf(const SpoolFile& file) {
  char first[4] = {};
  const absl::StatusOr<size_t> got = file.ReadAt(0, first, sizeof(first));
  const std::string_view bytes(first, got.value_or(0));
  return DetectContainer(bytes) == ContainerKind::kText ? "text/x.gcode"
                                                        : "application/octet-stream";
}

}  // namespace traverse::gateway

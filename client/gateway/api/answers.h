// The forms in which answers go out over HTTP.

#ifndef TRAVERSE_CLIENT_GATEWAY_API_ANSWERS_H_
#define TRAVERSE_CLIENT_GATEWAY_API_ANSWERS_H_

#include <stop_token>
#include <string>

#include "client/gateway/http/message.h"
#include "client/gateway/spool/spool.h"

namespace traverse::gateway {

HttpResponse JsonResponse(std::string json);

// Refuses the method of a request, whose path allows only `allowed`, as "GET, DELETE".
HttpResponse NotAllowed(const std::string& allowed);

// GET, or HEAD, whose answer has no body.
bool IsGet(const HttpRequest& request);

// One server-sent event. With an `id` a client that lost its connection can say what it knows.
std::string Event(const std::string& name, const std::string& data, const std::string& id = "");

// The event `problem` for a refusal of Problem.
std::string ProblemEvent(const HttpResponse& refusal);

// Whether the answer may be events.
bool WantsEvents(const HttpRequest& request);

// Is stopped when the client leaves.
std::stop_source StopWhenGone(HttpReply& reply);

// The head of an answer of events.
HttpResponse EventsHead();

// By its first bytes: G-code is text, containers are not.
std::string ContentTypeOf(const SpoolFile& file);

}  // namespace traverse::gateway

#endif  // TRAVERSE_CLIENT_GATEWAY_API_ANSWERS_H_

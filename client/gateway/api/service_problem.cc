#include "client/gateway/api/service_problem.h"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/strings/cord.h"
#include "client/gateway/http/problem.h"
#include "google/rpc/error_details.pb.h"

namespace traverse::gateway {
namespace {

template <typename Detail>
std::optional<Detail> DetailOf(const absl::Status& status) {
  Detail detail;
  const auto payload = status.GetPayload("type.googleapis.com/" + detail.GetTypeName());
  if (!payload || !detail.ParseFromString(std::string(*payload))) return std::nullopt;
  return detail;
}

}  // namespace

HttpResponse ServiceProblem(const absl::Status& status) {
  ProblemDetails details = {.code = absl::StatusCodeToString(status.code())};
  if (const auto retry = DetailOf<google::rpc::RetryInfo>(status)) {
    const auto& delay = retry->retry_delay();
    details.retry_after = std::max<int64_t>(1, delay.seconds() + (delay.nanos() > 0 ? 1 : 0));
  }
  if (const auto bad = DetailOf<google::rpc::BadRequest>(status)) {
    for (const auto& fault : bad->field_violations()) {
      details.faults.push_back({fault.field(), fault.description()});
    }
  }
  int code = HttpStatusOf(status.code());
  if (absl::IsUnimplemented(status)) code = 501;
  if (absl::IsResourceExhausted(status) && !details.retry_after) code = 413;
  return Problem(code, std::string(status.message()), details);
}

}  // namespace traverse::gateway

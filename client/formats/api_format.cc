#include "client/formats/api_format.h"

#include <google/protobuf/util/json_util.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/read_file.h"
#include "client/formats/message_json.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse {
namespace {

constexpr size_t kMaxMessageBytes = std::numeric_limits<int>::max();

InputJob FromRequest(v1::OptimizeBatchRequest request, InputFormat format,
                     const std::string& name) {
  InputJob job;
  job.name = name;
  job.format = format;
  job.options = std::move(*request.mutable_options());
  job.layers.assign(std::make_move_iterator(request.mutable_layers()->begin()),
                    std::make_move_iterator(request.mutable_layers()->end()));
  return job;
}

absl::StatusOr<v1::OptimizeBatchRequest> ToRequest(const InputJob& job) {
  v1::OptimizeBatchRequest request;
  *request.mutable_options() = job.options;
  size_t bytes = request.ByteSizeLong();
  for (const v1::Layer& layer : job.layers) {
    constexpr size_t kTagAndLength = 6;
    bytes += layer.ByteSizeLong() + kTagAndLength;
    if (bytes > kMaxMessageBytes) {
      return absl::InvalidArgumentError("more than 2 GiB: too much for one message");
    }
    *request.add_layers() = layer;
  }
  return request;
}

}  // namespace

absl::StatusOr<InputJob> ReadApiJson(std::string_view bytes, const std::string& name) {
  if (bytes.size() > kMaxMessageBytes) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s: more than 2 GiB of JSON", DisplayName(name)));
  }
  v1::OptimizeBatchRequest request;
  if (absl::Status status = ReadMessageJson(bytes, request); !status.ok()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: not an OptimizeBatchRequest: %s", DisplayName(name), std::string(status.message())));
  }
  return FromRequest(std::move(request), InputFormat::kJson, name);
}

absl::StatusOr<InputJob> ReadApiProto(std::string_view bytes, const std::string& name) {
  v1::OptimizeBatchRequest request;
  if (bytes.size() > kMaxMessageBytes ||
      !request.ParseFromArray(bytes.data(), static_cast<int>(bytes.size()))) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "%s: not a whole OptimizeBatchRequest: damaged or cut short", DisplayName(name)));
  }
  return FromRequest(std::move(request), InputFormat::kProto, name);
}

absl::StatusOr<std::string> WriteApiJson(const InputJob& job) {
  const absl::StatusOr<v1::OptimizeBatchRequest> request = ToRequest(job);
  return request.ok() ? ApiMessageJson(*request) : request.status();
}

absl::StatusOr<std::string> ApiMessageJson(const google::protobuf::Message& message) {
  google::protobuf::util::JsonPrintOptions options;
  options.add_whitespace = true;
  options.preserve_proto_field_names = true;
  std::string out;
  const google::protobuf::util::Status status =
      google::protobuf::util::MessageToJsonString(message, &out, options);
  if (!status.ok()) return absl::InternalError(std::string(status.message()));
  return out;
}

absl::StatusOr<std::string> WriteApiProto(const InputJob& job) {
  const absl::StatusOr<v1::OptimizeBatchRequest> request = ToRequest(job);
  if (!request.ok()) return request.status();
  std::string out;
  if (!request->SerializeToString(&out)) return absl::InternalError("the job does not serialize");
  return out;
}

}  // namespace traverse

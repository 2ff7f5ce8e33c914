#include "client/gateway/api/rewrite_options.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "absl/strings/str_cat.h"
#include "client/gateway/api/machine_text.h"
#include "client/gateway/http/target.h"
#include "client/gateway/work/permissions.h"

namespace traverse::gateway {
namespace {

absl::Status FieldFault(std::string message) {
  return absl::InvalidArgumentError(std::move(message));
}

absl::Status NoneKnown(const std::string& field, int value) {
  return FieldFault(absl::StrCat("options.", field, ": ", value, " is unknown"));
}

// This and SetAllowances are for both messages that have the field.
template <typename Options, typename Policy>
absl::Status SetPolicy(const Options& options, Policy& policy) {
  if (options.policy() == v1::POLICY_UNSPECIFIED) return absl::OkStatus();
  const std::optional<Policy> known = PolicyFrom<Policy>(options.policy());
  if (!known) return NoneKnown("policy", options.policy());
  policy = *known;
  return absl::OkStatus();
}

absl::Status SetCrossings(const v1::RewriteOptions& options, GcodeOptions& gcode) {
  switch (options.crossings()) {
    case v1::CROSSINGS_UNSPECIFIED:
    case v1::CROSSINGS_KEEP:
      return absl::OkStatus();
    case v1::CROSSINGS_FEWER:
      gcode.crossings = gcode::Crossings::kFewer;
      return absl::OkStatus();
    case v1::CROSSINGS_ANY:
      gcode.crossings = gcode::Crossings::kAny;
      return absl::OkStatus();
    default:
      return NoneKnown("crossings", options.crossings());
  }
}

template <typename Options, typename Allowed>
absl::Status SetAllowances(const Options& options, Allowed& allow) {
  constexpr int kMost = 16;
  if (options.allow_size() > kMost) {
    return FieldFault(
        absl::StrCat("options.allow: ", options.allow_size(), " values, more than 16"));
  }
  for (int i = 0; i < options.allow_size(); ++i) {
    const auto allowance = static_cast<v1::Allowance>(options.allow(i));
    if (!Allow(allowance, allow)) return NoneKnown(absl::StrCat("allow[", i, "]"), allowance);
  }
  return absl::OkStatus();
}

absl::Status SetWhatMayMove(const v1::RewriteOptions& options, GcodeOptions& gcode) {
  if (absl::Status status = SetPolicy(options, gcode.policy); !status.ok()) return status;
  if (absl::Status status = SetCrossings(options, gcode); !status.ok()) return status;
  if (absl::Status status = SetAllowances(options, gcode.allow); !status.ok()) return status;
  // Written so that NaN is refused.
  if (!(options.min_revisit_s() >= 0 &&
        options.min_revisit_s() <= GcodeOptions::kMostRevisitSeconds)) {
    return FieldFault("options.min_revisit_s: not within 0 to 3600");
  }
  gcode.min_revisit_seconds = options.min_revisit_s();
  if (!options.has_max_hidden_travel_mm()) return absl::OkStatus();
  const double longest = options.max_hidden_travel_mm();
  if (!(longest >= 0 && longest <= gcode::kMostHiddenTravelMm)) {
    return FieldFault("options.max_hidden_travel_mm: not within 0 to 1000");
  }
  gcode.allow.max_hidden_travel_mm = longest;
  return absl::OkStatus();
}

absl::Status SetContainer(const v1::RewriteOptions& options, FileRequest& request) {
  if (options.plate() != 0) request.plates.plate = options.plate();
  request.plates.container.ignore_md5 = options.ignore_md5();
  switch (options.container()) {
    case v1::CONTAINER_UNSPECIFIED:
      return absl::OkStatus();
    case v1::CONTAINER_TEXT:
      request.container = ContainerKind::kText;
      return absl::OkStatus();
    case v1::CONTAINER_BGCODE:
      request.container = ContainerKind::kBgcode;
      return absl::OkStatus();
    default:
      return NoneKnown("container", options.container());
  }
}

absl::Status SetLayers(const v1::RewriteOptions& options, JobSettings& settings) {
  const uint32_t first = std::max(1u, options.first_layer());
  if (options.last_layer() == 0 && first == 1) return absl::OkStatus();
  if (options.last_layer() == 0) {
    return FieldFault("options.last_layer: required where first_layer is set");
  }
  if (options.last_layer() < first) return FieldFault("options.last_layer: below first_layer");
  settings.layers = {first, options.last_layer()};
  return absl::OkStatus();
}

}  // namespace

absl::StatusOr<FileRequest> RequestOf(const v1::RewriteOptions& options) {
  FileRequest request;
  if (!options.name().empty()) {
    if (absl::Status status = CheckFileName(options.name()); !status.ok()) {
      return FieldFault(absl::StrCat("options.name: ", status.message()));
    }
    request.name = options.name();
  }
  if (absl::Status status = SetWhatMayMove(options, request.gcode); !status.ok()) return status;
  if (options.has_strategy()) request.strategy = options.strategy();
  if (options.has_seed()) request.settings.seed = options.seed();
  if (absl::Status status = SetLayers(options, request.settings); !status.ok()) return status;
  if (options.has_layer_time_limit()) {
    const absl::Duration limit = absl::Seconds(options.layer_time_limit().seconds()) +
                                 absl::Nanoseconds(options.layer_time_limit().nanos());
    if (limit <= absl::ZeroDuration()) return FieldFault("options.layer_time_limit: not above 0");
    request.settings.layer_time_limit = limit;
  }
  request.report = options.report();
  request.restate_times = options.restate_times();
  if (absl::Status status = SetContainer(options, request); !status.ok()) return status;
  if (!options.machine().empty()) {
    absl::StatusOr<gcode::MachineLimits> machine =
        ParseMachine(options.machine(), "options.machine");
    if (!machine.ok()) return machine.status();
    request.gcode.machine = *std::move(machine);
  }
  return request;
}

absl::StatusOr<std::optional<GivenPermissions>> PermissionsOf(const v1::VerifyOptions& options) {
  if (options.policy() == v1::POLICY_UNSPECIFIED && options.allow().empty() &&
      !options.has_max_hidden_travel_mm()) {
    return std::nullopt;
  }
  GivenPermissions given;
  given.policy_as_stated = options.policy() == v1::POLICY_UNSPECIFIED;
  if (absl::Status status = SetPolicy(options, given.permissions.policy); !status.ok()) {
    return status;
  }
  if (absl::Status status = SetAllowances(options, given.permissions); !status.ok()) return status;
  if (options.has_max_hidden_travel_mm()) {
    const double longest = options.max_hidden_travel_mm();
    if (!(longest >= 0 && longest <= VerifyPermissions::kMostHiddenTravelMm)) {
      return FieldFault("options.max_hidden_travel_mm: not within 0 to 1000");
    }
    given.permissions.max_hidden_travel_mm = longest;
  }
  return given;
}

}  // namespace traverse::gateway

// Bytes as an OptimizeBatchRequest, through the translation to the engine.
//
// Rules: each message is either refused with a place, or becomes a job that the engine accepts.

#include <google/protobuf/stubs/logging.h>

#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "engine/model/plan.h"
#include "engine/validator.h"
#include "server/translate/translate.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/seed_jobs.h"

namespace traverse::fuzz {
namespace {

void CheckRefusal(const absl::Status& status, const std::string& place) {
  const bool callers_fault = absl::IsInvalidArgument(status) || absl::IsUnimplemented(status);
  Check(callers_fault, absl::StrCat("a refusal is the caller's fault: ", status.ToString()));
  Check(absl::StrContains(status.message(), place),
        absl::StrCat("a refusal names its place: ", status.ToString()));
}

void CheckLayer(const v1::Layer& layer, uint64_t index, bool interleaved) {
  const auto translated = LayerFromProto(layer, index, interleaved);
  if (!translated.ok())
    return CheckRefusal(translated.status(), absl::StrCat("layers[", index, "]"));
  const JobLayer& made = translated->layer;
  const absl::Status valid = CheckPlan(made.plan);
  Check(valid.ok(), absl::StrCat("a translated plan is valid: ", valid.ToString()));
  if (made.initial_route.empty()) return;
  const absl::Status legal = ValidateRoute(made.plan, made.initial_route);
  Check(legal.ok(), absl::StrCat("a translated route is legal: ", legal.ToString()));
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse;
  static const bool quiet = [] {
    google::protobuf::SetLogHandler(nullptr);
    return true;
  }();
  v1::OptimizeBatchRequest request;
  if (!quiet || !request.ParseFromArray(data, static_cast<int>(size))) return 0;
  const auto setup = JobFromProto(request.options());
  if (!setup.ok()) fuzz::CheckRefusal(setup.status(), "options");
  for (int i = 0; i < request.layers_size(); ++i) {
    for (const bool interleaved : {false, true}) {
      fuzz::CheckLayer(request.layers(i), static_cast<uint64_t>(i), interleaved);
    }
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  return traverse::fuzz::MutateJob(data, size, max_size, seed);
}

#include "server/jobs/admission.h"

namespace traverse {

const char* RefusalName(Refusal refusal) {
  switch (refusal) {
    case Refusal::kDraining:
      return "draining";
    case Refusal::kJobs:
      return "jobs";
    case Refusal::kCallerJobs:
      return "caller_jobs";
    case Refusal::kQueue:
      return "queue";
    case Refusal::kCallerQueue:
      return "caller_queue";
    case Refusal::kWait:
      return "wait";
    case Refusal::kDeadline:
      return "deadline";
    case Refusal::kMemory:
      return "memory";
    case Refusal::kCallerMemory:
      return "caller_memory";
    case Refusal::kMessage:
      return "message";
    case Refusal::kJobLayers:
      return "job_layers";
    case Refusal::kJobPoints:
      return "job_points";
    case Refusal::kLayerPoints:
      return "layer_points";
    case Refusal::kUnauthenticated:
      return "unauthenticated";
    case Refusal::kPermission:
      return "permission";
  }
  return "other";
}

}  // namespace traverse

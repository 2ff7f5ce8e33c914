// What the two calls that bring jobs share: from translated options to the end of the call. The
// reactors add how messages are read and written.

#ifndef TRAVERSE_SERVER_RPC_JOB_STREAM_H_
#define TRAVERSE_SERVER_RPC_JOB_STREAM_H_

#include <grpcpp/server_context.h>
#include <grpcpp/support/byte_buffer.h>
#include <grpcpp/support/status.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/status.h"
#include "engine/schedule/chain_bound.h"
#include "server/jobs/job_run.h"
#include "server/rpc/call_info.h"
#include "server/rpc/request_reader.h"
#include "server/service_core.h"
#include "server/translate/fault_list.h"
#include "server/translate/translate.h"
#include "server/translate/translate_result.h"

namespace traverse {

// A reactor admits its call, then brings messages, one at a time. It learns when the options of a
// message are known and when its layers were added.
class JobStream : public JobPort {
 public:
  ~JobStream() override;

 protected:
  // `context` belongs to the call, and lives as long.
  JobStream(ServiceCore& core, grpc::CallbackServerContext& context, CallInfo call);

  // Admits the job, with an estimate of its points, or returns why not: `authorized` (the result of
  // Authorize), or a limit. On success run() exists.
  absl::Status Admit(const absl::Status& authorized, int64_t points);

  // The most points that a message of this size has: a point is two doubles, and little else has
  // any size.
  static int64_t EstimatePoints(size_t bytes) { return static_cast<int64_t>(bytes / 16 + 1); }

  // Admit for a job whose whole message has arrived. REQUIRES: it was admitted.
  absl::Status Resize(int64_t points);

  // Reads `message`, which must live until OnMessageRead and is emptied at once: checks and
  // translates its layers, which follow those added so far. The workers read a large one, in pieces
  // between which other jobs have their turns. Ends the job if there is a fault.
  void ReadMessage(grpc::ByteBuffer& message);

  // Reads the job's options.
  absl::Status Begin(const v1::JobOptions& options);

  // Starts the engine; once, after Begin. The expected layers and points widen the margin between
  // the last results and the deadline.
  void StartEngine(int64_t expected_layers, int64_t expected_points);

  // `message` in the form in which it is written. It lives until AnswerWritten, which reports the
  // end of the write to the run, and may end the call.
  const grpc::ByteBuffer* Outgoing(const std::string& message);
  void AnswerWritten(bool ok);

  // Counts the job under no strategy, because its caller never named one.
  void ForgetStrategy() { layer_metrics_ = nullptr; }

  // Stops the job because the call was cancelled or its deadline has passed.
  void OnCallCancelled();

  // Ends a call whose run has ended, or that was refused: counts, logs, frees its place.
  void End(const absl::Status& status);

  const std::shared_ptr<JobRun>& run() const { return run_; }
  ServiceCore& core() { return core_; }
  const JobSetup& setup() const { return setup_; }

  // Number of layers added so far.
  int64_t layers_received() const { return static_cast<int64_t>(layers_received_); }
  int64_t points_received() const { return points_received_; }

 private:
  // What the reactors add: how to handle a message and the end of the call, and messages of their
  // types.
  virtual const char* RequestType() const = 0;
  virtual absl::Status OnOptions(const RequestReader& message) = 0;
  virtual void OnMessageRead() = 0;
  virtual bool MoreFollowsMessage() const = 0;  // JobLayer::more_follows of its last layer
  virtual void FinishCall(const grpc::Status& status) = 0;
  virtual std::string Encode(const LayerOutcome& outcome, uint64_t id) const = 0;
  virtual std::string Encode(const v1::LayerResult& result) const = 0;
  virtual std::string Encode(const v1::JobSummary& summary) const = 0;

  // JobPort.
  std::string EncodeLayer(const LayerOutcome& outcome, const LayerLabel& label) final;
  std::string EncodeSummary() final;
  std::string EncodeFault(const LayerLabel& label) final;
  void NoteChainBound(double lower_bound) final { totals_.SetChainBound(lower_bound); }
  bool MayBringMore() const final { return ticket_->MayBringMore(); }
  bool IsWorkedOn() const final { return !queue_->idle(); }
  void Discard(std::deque<LabelledLayer> layers) final;
  void CancelCall() final { context_.TryCancel(); }
  void Finish(const absl::Status& status) final { End(status); }

  // Returns what `read` returns, or NoMemory if it runs out of memory.
  template <typename Read>
  static absl::Status Guarded(const Read& read) {
    try {
      return read();
    } catch (const std::bad_alloc&) {
      return NoMemory();
    }
  }

  // The steps of ReadMessage.
  void ReadPiecesInTurns(grpc::ByteBuffer& message);
  bool ReadPiece(grpc::ByteBuffer& message);  // whether another one is to be read
  absl::Status OpenMessage(grpc::ByteBuffer& message);
  absl::Status ReadLayers();
  absl::StatusOr<LabelledLayer> Translate(const v1::Layer& layer, uint64_t index) const;

  // A layer in the place of one that cannot be answered for this reason; unset if that ends the
  // job.
  std::optional<LabelledLayer> InPlaceOf(const v1::Layer& layer, const absl::Status& fault) const;
  void AddLayers(std::vector<LabelledLayer> layers);

  // Puts the job's id into the initial metadata.
  void AnnounceJob();

  absl::Status CheckLayerCount(int64_t more) const;
  absl::Status CheckMessage(int64_t bytes);
  absl::Status CheckSize(const v1::Layer& layer, uint64_t index, int64_t points) const;
  int64_t BytesFreedBy(const LayerOutcome& outcome, const LayerLabel& label);
  JobRecord Record(const absl::Status& status) const;
  double WallSeconds() const;

  ServiceCore& core_;
  grpc::CallbackServerContext& context_;
  const CallInfo call_;
  std::shared_ptr<JobRun> run_;
  std::unique_ptr<Admission::Ticket> ticket_;
  std::shared_ptr<WorkerPool::Queue> queue_;

  // For the message being read.
  RequestReader reader_;
  bool opened_ = false;
  FaultList faults_;                    // faults found in it so far
  std::vector<LabelledLayer> carried_;  // read, with the last one without a fault, but not added
  int64_t message_bytes_ = 0;           // held for it
  int64_t admitted_points_ = 0;         // counted by Admit, but not yet brought

  // Set while messages are read; then read by the engine's calls and by End.
  JobSetup setup_;
  const LayerMetrics* layer_metrics_ = nullptr;
  uint64_t layers_received_ = 0;
  uint64_t layers_queued_ = 0;  // of them, counted as queued: not those that are only checked
  int64_t points_received_ = 0;

  // When the search must end because of the call's deadline; unset without one.
  std::optional<Budget::Clock::time_point> search_end_;

  // Used by the engine's calls, which do not overlap; then by End.
  JobTotals totals_;
  std::optional<KeptPlans> kept_plans_;  // for a bound of the chain, if the job asks for one
  int64_t kept_bytes_ = 0;               // held for these plans
  std::atomic<uint64_t> faulty_layers_{0};
  double counted_seconds_ = 0;  // busy seconds of queue_ that were reported to ticket_

  grpc::ByteBuffer outgoing_;  // the message being written
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_RPC_JOB_STREAM_H_

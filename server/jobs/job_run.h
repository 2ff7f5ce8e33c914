// One job between the stream that brought it and the engine: feeds in layers, passes on messages,
// and ends once.
//
// At most `window` layers are between "given to the engine" and "written to the caller". So a slow
// reader delays only its own job, in bounded memory and without blocking a thread. One message is
// written at a time. Finish is called exactly once, after everything else.
//
//   stream --Add--> backlog --window--> engine --OnLayer--> [build order] --> queue --> StartWrite
//
// Knows neither gRPC nor protobuf, so that it can be tested under ThreadSanitizer.

#ifndef TRAVERSE_SERVER_JOBS_JOB_RUN_H_
#define TRAVERSE_SERVER_JOBS_JOB_RUN_H_

#include <chrono>
#include <cstdint>
#include <deque>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>

#include "absl/status/status.h"
#include "engine/base/mutex.h"
#include "engine/engine.h"

namespace traverse {

// The status of a job that needs more memory than there is.
absl::Status NoMemory();

// What the result of a layer must repeat from its request.
struct LayerLabel {
  uint64_t id = 0;     // Layer.id
  int64_t points = 0;  // all coordinate pairs sent, including those that the route does not need
  int64_t bytes = 0;   // of memory held for it

  // Why it is answered without a route, by this text; empty if it is not.
  std::string fault = {};

  uint64_t index = 0;  // position in the job, faulty layers included; set by JobRun
};

struct LabelledLayer {
  JobLayer layer;
  LayerLabel label;
};

// The stream's side of a job. No method is called after Finish.
class JobPort {
 public:
  virtual ~JobPort() = default;

  // The message for one layer, and the last one. Worker threads call these, never at once.
  virtual std::string EncodeLayer(const LayerOutcome& outcome, const LayerLabel& label) = 0;
  virtual std::string EncodeSummary() = 0;

  // The message for a layer with a fault. Any thread calls it, with a lock held: must not call the
  // run.
  virtual std::string EncodeFault(const LayerLabel& /*label*/) { return {}; }

  // What JobSink::OnChainBound says, before EncodeSummary.
  virtual void NoteChainBound(double /*lower_bound*/) {}

  // Writes a message, then calls JobRun::OnWriteDone. It is called again only after that.
  // `more_follows`: another message or the end comes right after this one.
  virtual void StartWrite(std::string message, bool more_follows) = 0;

  // Whether the server as a whole accepts more of this job now; asked while some of its layers are
  // in progress. Called with a lock held: must not call the run.
  virtual bool MayBringMore() const { return true; }

  // Whether workers have work for the job. Called with a lock held: must not call the
  // run.
  virtual bool IsWorkedOn() const { return false; }

  // Frees layers that are no longer needed. They may be many, so do it in the background. May be
  // called from any thread, and at the end.
  virtual void Discard(std::deque<LabelledLayer> layers) { layers.clear(); }

  // Ends the call without waiting for its reader. OnWriteDone(false) follows if a write is in
  // progress.
  virtual void CancelCall() {}

  // Says that it is worth calling JobRun::AskForRoom again.
  virtual void OnRoom() = 0;

  // Ends the job. Another thread may delete the port before this returns.
  virtual void Finish(const absl::Status& status) = 0;
};

// How much of a job may be in progress: given to the engine and not yet written.
struct JobWindow {
  int64_t layers = 256;
  int64_t points = 500'000;  // six layers may exceed it
};

// Thread-safe, except as stated below.
class JobRun : public JobSink, public std::enable_shared_from_this<JobRun> {
 public:
  struct Options {
    JobWindow window;
    bool build_order = false;  // messages in build order; otherwise as layers are ready
  };

  // `port` must outlive its Finish. Owned by a shared_ptr.
  static std::shared_ptr<JobRun> Make(JobPort& port) {
    return std::shared_ptr<JobRun>(new JobRun(port));
  }

  // Begins the job. `executor` must outlive the run's Finish. At most once, before any Add.
  void Start(const Options& options, const JobSpec& spec, std::unique_ptr<Strategy> strategy,
             Executor& executor);

  // The producer's calls, one at a time. Layers may be added without asking for room; they wait
  // here. Push begins work on the added layers.
  void Add(LabelledLayer layer);
  void Push();

  // Says that no more layers follow. Without Start: ends with an OK status and no summary.
  void Close();

  // True if more layers are welcome: there is room and the port may bring more. Otherwise remembers
  // that the producer waits; JobPort::OnRoom is called when it is worth asking again.
  bool AskForRoom();

  // The message of the last StartWrite has been written, or (`ok` false) will never be.
  void OnWriteDone(bool ok);

  // Ends the job with `status`: stops the work within 50 ms and drops what is not yet written. Does
  // nothing after the first call, or after the end.
  void Abort(const absl::Status& status);

  // Whether the caller has neither sent nor read anything for `time` although the job waits for it.
  bool IsStalled(std::chrono::steady_clock::duration time) const;

  // Aborts with `status` if the caller has neither sent nor read anything for `time` although the
  // job waits for it: no worker has work for the job. Gives up a write that nobody reads.
  void AbortIfStalled(std::chrono::steady_clock::duration time, const absl::Status& status);

  // Whether Finish was called `time` ago or earlier.
  bool HasEnded(std::chrono::steady_clock::duration time) const;

  // While a hold is taken, Finish is not called: for work that uses the port. Returns false, and
  // takes none, once the job has ended: the port may then be deleted at any time. A read of the
  // transport may arrive as late as that.
  [[nodiscard]] bool Hold();
  void Release();

  // Whether the job may still bring layers, and when it last made progress, its end included.
  bool waits_for_message() const;
  std::chrono::steady_clock::time_point progress() const;

  // Whether Close was called, so that all layers have arrived.
  bool closed() const;

  // Whether Abort was called.
  bool aborted() const;

  // JobSink, called by the engine.
  void OnLayer(LayerOutcome outcome) override;
  void OnChainBound(double lower_bound) override { port_.NoteChainBound(lower_bound); }
  void OnDone() override;

 private:
  struct Outgoing {
    std::string message;
    int64_t layers;  // of the window, which it frees when it is written
    int64_t points;

    // Of a layer with a fault, which takes its place in the window only when its turn has come.
    // Until then the layers behind it must fit: one of them may be what the engine waits for.
    bool fault = false;
  };

  explicit JobRun(JobPort& port) : port_(port) {}

  // Does whatever can be done next. Every public method ends with it.
  void Pump(bool feed);

  // Gives layers to the engine while the window has room, and answers those with a fault.
  void Feed();

  void TakeLayer(LayerOutcome outcome);

  bool Stalled(std::chrono::steady_clock::duration time) const TRAVERSE_REQUIRES(mutex_);

  // Notes that the job has made progress.
  void NoteProgress() TRAVERSE_REQUIRES(mutex_) { progress_ = std::chrono::steady_clock::now(); }

  bool FitsWindow(int64_t points) const TRAVERSE_REQUIRES(mutex_);
  bool HasRoom() const TRAVERSE_REQUIRES(mutex_);
  void Queue(uint64_t index, Outgoing outgoing) TRAVERSE_REQUIRES(mutex_);

  JobPort& port_;
  mutable Mutex mutex_;
  Options options_ TRAVERSE_GUARDED_BY(mutex_);
  std::shared_ptr<Job> job_ TRAVERSE_GUARDED_BY(mutex_);  // null before Start

  std::deque<LabelledLayer> backlog_ TRAVERSE_GUARDED_BY(mutex_);
  bool closed_ TRAVERSE_GUARDED_BY(mutex_) = false;         // by the producer
  bool engine_closed_ TRAVERSE_GUARDED_BY(mutex_) = false;  // Close was passed on
  bool engine_done_ TRAVERSE_GUARDED_BY(mutex_) = true;     // false from Start to OnDone
  bool feeding_ TRAVERSE_GUARDED_BY(mutex_) = false;        // a thread is in Feed

  uint64_t next_index_ TRAVERSE_GUARDED_BY(mutex_) = 0;     // of the next layer fed
  uint64_t next_position_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // in the job, faulty ones included
  std::unordered_map<uint64_t, LayerLabel> labels_
      TRAVERSE_GUARDED_BY(mutex_);  // of layers in the engine
  int64_t window_layers_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  int64_t window_points_ TRAVERSE_GUARDED_BY(mutex_) = 0;

  std::map<uint64_t, Outgoing> early_
      TRAVERSE_GUARDED_BY(mutex_);                     // build order: ready before their turn
  uint64_t next_out_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // whose turn it is
  std::deque<Outgoing> out_ TRAVERSE_GUARDED_BY(mutex_);
  std::optional<Outgoing> writing_ TRAVERSE_GUARDED_BY(mutex_);  // its message was moved out
  bool begun_writing_ TRAVERSE_GUARDED_BY(mutex_) = false;
  bool room_wanted_ TRAVERSE_GUARDED_BY(mutex_) = false;

  std::chrono::steady_clock::time_point progress_ TRAVERSE_GUARDED_BY(mutex_) =
      std::chrono::steady_clock::now();
  int holds_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::optional<absl::Status> abort_ TRAVERSE_GUARDED_BY(mutex_);
  bool finished_ TRAVERSE_GUARDED_BY(mutex_) = false;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_JOB_RUN_H_

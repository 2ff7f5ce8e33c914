// The TCP connections of the service: accepted here, handed to gRPC, and watched from outside.
//
// gRPC 1.51 buffers unfinished messages of any length, endless headers and the control frames of a
// flood, for anyone who connects, and does not report it. What it cannot hide is how many bytes
// arrived on a connection. Those that have not become a message yet are what the connection makes
// the server hold:
//
//   pending = received - (messages delivered and what frames them), ever less as time goes by
//
// A connection may have so much pending for each of its jobs, and a little more. Beyond that one of
// its jobs is ended, or it is cut. A descriptor of our own for each connection makes that possible.
//
// Nor does gRPC bound the calls of a peer that resets them as soon as they are opened. HTTP/2
// counts only open streams, but each reset one takes about 20 kB until it is processed. A peer with
// far more calls here than streams may be open is cut, and new connections from its address are
// turned away for a while, longer each time it happens. The same goes for an address from which
// strangers twice sent too much, and for one that makes so many calls, over any number of
// connections, that others wait.
//
// Each connection takes two files of the process, of which all together have only a part, so that
// others can open theirs. Beyond that the one idle longest makes room, or the newest is closed.
// Knows nothing of gRPC. Thread-safe.

#ifndef TRAVERSE_SERVER_NET_CONNECTIONS_H_
#define TRAVERSE_SERVER_NET_CONNECTIONS_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/statusor.h"
#include "engine/base/mutex.h"
#include "server/net/hand_over.h"
#include "server/net/offenders.h"
#include "server/net/socket_info.h"

namespace traverse {

struct ConnectionRules {
  int max_connections = 1024;
  double files_part = 1;  // of the files that may be open, see FilesFor; fewer leave fewer of them
  int64_t stranger_bytes = int64_t{4} << 20;  // pending in addition to that of jobs
  int64_t job_bytes = int64_t{64} << 20;      // pending for each job
  int64_t quiet_bytes = int64_t{256} << 10;   // the same for longer than a moment

  // Pending on all connections together; beyond it the address that has most loses jobs, as long as
  // it has more than job_bytes. So one caller's unfinished messages leave memory to the others.
  int64_t all_bytes = INT64_MAX;

  int max_calls = 1000;  // begun, and gRPC is not done with them

  // Data unacknowledged for this long ends a connection.
  std::chrono::milliseconds peer_timeout{10'000};
};

// What has too many bytes that are no message yet.
enum class Excess { kConnection, kAddress };

class Connections {
 public:
  static constexpr int kHands = 8;

  // gRPC's descriptor, and one to watch it by.
  static constexpr int kFilesOfConnection = 2;

  struct Hooks {
    // Passes a new connection on, see HandOver; kHands threads call it.
    HandOver::Take hand_over;

    // Ends a job of `peer`, which has more pending than its jobs may, or whose address has too much
    // of all that is pending. False if there is none.
    std::function<bool(const std::string& peer, Excess excess)> end_job;
  };

  // Listens on `address` (see TcpListen) until it is destroyed. Errors: see TcpListen.
  static absl::StatusOr<std::unique_ptr<Connections>> Listen(const std::string& address,
                                                             const ConnectionRules& rules,
                                                             Hooks hooks);
  ~Connections();

  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  // Begins to accept connections.
  void Start();

  // Accepts no more. After it returns, none is being handed over.
  void StopListening();

  int port() const { return port_; }

  // `peer`, as gRPC writes it (ipv4:10.0.0.7:41234), has called; gRPC is done with the call.
  void OnCall(const std::string& peer);
  void OnCallDone(const std::string& peer);

  // The call of `peer` may bring a job: what it sent before it learned of a refusal does not count
  // against it. Then: a message of `bytes` has arrived from it.
  void OnAuthorized(const std::string& peer);
  void OnMessage(const std::string& peer, int64_t bytes);

  // A job of `peer` has begun. Returns what was pending then, which the caller must give back at
  // the job's end. `all_came`: its messages are complete. If not, its share of the pending bytes
  // will not come any more, and gRPC has freed it.
  double OnJob(const std::string& peer);
  void OnJobDone(const std::string& peer, double pending_before, bool all_came);

  // Call it when calls wait long before they are processed. If one address made much of the recent
  // work with connections and calls that brought no job, and more than half of all, cuts its
  // connections and turns it away for a while, as after a flood. Returns whether there was one.
  bool TurnAwayBusiest();

  // Ends the connection with most pending, with jobs or not, if that helps. Returns whether.
  bool CutLargest();

  int open() const;
  int64_t pending_bytes() const;
  uint64_t cut() const;  // so far

 private:
  using Clock = std::chrono::steady_clock;

  struct Connection {
    int socket = -1;        // our descriptor
    uint64_t received = 0;  // bytes, as seen last
    double pending = 0;
    int jobs = 0;
    int calls = 0;
    Clock::time_point moved;       // when bytes last arrived
    Clock::time_point complained;  // when end_job was called

    // Since when more than quiet_bytes are pending without a job, if so. May lie ahead.
    Clock::time_point loud_since;
  };
  using Table = std::map<std::string, Connection>;

  Connections(const ConnectionRules& rules, Hooks hooks)
      : rules_(rules), hooks_(std::move(hooks)) {}

  void Serve();
  void AcceptAll(int listener);
  void WaitForRoom() TRAVERSE_EXCLUDES(mutex_);
  bool IsFull() const TRAVERSE_REQUIRES(mutex_);
  bool MakeRoom(const std::string& peer) TRAVERSE_REQUIRES(mutex_);
  Table::iterator Cut(Table::iterator connection) TRAVERSE_REQUIRES(mutex_);
  void CutPeer(const std::string& peer) TRAVERSE_EXCLUDES(mutex_);

  // Updates the table. Returns those with too much pending, and whether much arrived.
  std::vector<std::pair<std::string, Excess>> Look(bool& busy);
  // Bytes of messages that have not come whole, of all connections.
  double AllPending() const TRAVERSE_REQUIRES(mutex_);
  // Of the address that has too much of all that is pending; empty if none has.
  std::string LargestHoarder() const TRAVERSE_REQUIRES(mutex_);
  void Restrain(const std::string& peer, Excess excess);
  int64_t Allowed(const Connection& connection) const;
  bool IsLoud(Connection& connection, Clock::time_point now) const;
  uint64_t Update(Connection& connection, const SocketInfo& info) const;

  const ConnectionRules rules_;
  const Hooks hooks_;
  int port_ = 0;
  std::vector<int> listeners_;
  int stop_ = -1;  // an eventfd
  mutable Mutex mutex_;
  Table table_ TRAVERSE_GUARDED_BY(mutex_);  // by address and port
  Offenders offenders_ TRAVERSE_GUARDED_BY(mutex_);
  Clock::time_point looked_ TRAVERSE_GUARDED_BY(mutex_) = Clock::now();
  uint64_t cut_ TRAVERSE_GUARDED_BY(mutex_) = 0;
  std::optional<HandOver> hand_over_;
  std::thread thread_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_CONNECTIONS_H_

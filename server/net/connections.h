// The TCP connections of the service: taken here, handed to gRPC, and watched from outside.
//
// gRPC 1.51 buffers an unfinished message up to any length, headers without end and the control
// frames of a flood, for whoever connects, and tells nobody of it. What it cannot hide is how many
// bytes came in on a connection. Those that became no message yet are what the connection makes the
// server hold:
//
//   pending = received - (messages delivered and what frames them), ever less as time goes by
//
// A connection may have so much pending for each of its jobs, and little beside. Beyond that it is
// told on, or cut. A descriptor of our own for each connection makes that possible.
//
// Nor does gRPC bound the calls of a peer that resets them as soon as they are opened: HTTP/2
// counts only streams that are open, and each that was reset takes some 20 kB until its turn comes
// to be looked at. Whoever has far more calls here than streams may be open is cut, and new
// connections from his address are turned away for a while, the longer the more often it happens.
// So are those of an address from which strangers sent too much twice, and of one that makes so
// many calls, by however many connections, that those of others wait.
//
// It takes connections for itself, so that a process that has all of its files open loses none of
// them: who came last or has been idle for longest has to go. Knows nothing of gRPC. Thread-safe.

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
#include <vector>

#include "absl/status/statusor.h"
#include "engine/base/mutex.h"
#include "server/net/hand_over.h"
#include "server/net/offenders.h"
#include "server/net/socket_info.h"

namespace traverse {

struct ConnectionRules {
  int max_connections = 1024;
  int64_t stranger_bytes = int64_t{4} << 20;  // pending beside those of jobs
  int64_t job_bytes = int64_t{64} << 20;      // pending for each job
  int64_t quiet_bytes = int64_t{256} << 10;   // the same for longer than a moment
  int max_calls = 1000;                       // that were begun and gRPC is not done with

  // Unacknowledged data for so long ends a connection.
  std::chrono::milliseconds peer_timeout{10'000};
};

class Connections {
 public:
  static constexpr int kHands = 8;

  struct Hooks {
    // Takes a new connection, as of HandOver: called by kHands threads.
    HandOver::Take hand_over;

    // `peer` has more pending than its jobs may: ends one of them. False if there is none to end.
    std::function<bool(const std::string& peer)> end_job;
  };

  // Listens on `address`, as of TcpListen, until it is destroyed. Errors: as of TcpListen.
  static absl::StatusOr<std::unique_ptr<Connections>> Listen(const std::string& address,
                                                             const ConnectionRules& rules,
                                                             Hooks hooks);
  ~Connections();

  Connections(const Connections&) = delete;
  Connections& operator=(const Connections&) = delete;

  // Begins to take connections.
  void Start();

  // Takes no more. Afterwards none is being handed over.
  void StopListening();

  int port() const { return port_; }

  // `peer`, as gRPC writes it (ipv4:10.0.0.7:41234), has called; gRPC is done with the call.
  void OnCall(const std::string& peer);
  void OnCallDone(const std::string& peer);

  // The call of `peer` may bring a job: what it sent before it heard of a refusal is not held
  // against it. Then: a message of `bytes` has come from it.
  void OnAuthorized(const std::string& peer);
  void OnMessage(const std::string& peer, int64_t bytes);

  // A job of `peer` has begun. Returns what is to be given back at its end: what was pending then.
  // `all_came`: its messages have come to their ends. If not, its share of what is pending is not
  // coming any more, and gRPC has let go of it.
  double OnJob(const std::string& peer);
  void OnJobDone(const std::string& peer, double pending_before, bool all_came);

  // Calls wait for long before anybody looks at them: ends all connections of the address that made
  // most of the work of late by connections and calls that brought no job, if it was much and more
  // than half of all, and turns it away for a while as after a flood. Returns whether there is one.
  bool TurnAwayBusiest();

  // Ends the connection that has most pending, jobs or not, if that is worth it. Returns whether.
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
    Clock::time_point moved;       // bytes came last
    Clock::time_point complained;  // end_job was called

    // Since when more than quiet_bytes were pending without a job; none: not so. May be to come.
    Clock::time_point loud_since;
  };
  using Table = std::map<std::string, Connection>;

  Connections(const ConnectionRules& rules, Hooks hooks)
      : rules_(rules), hooks_(std::move(hooks)) {}

  void Serve();
  void AcceptAll(int listener);
  void WaitForRoom() TRAVERSE_EXCLUDES(mutex_);
  bool MakeRoom(const std::string& peer) TRAVERSE_REQUIRES(mutex_);
  Table::iterator Cut(Table::iterator connection) TRAVERSE_REQUIRES(mutex_);
  void CutPeer(const std::string& peer) TRAVERSE_EXCLUDES(mutex_);

  // Brings the table up to date. Returns those with too much pending, and whether much came in.
  std::vector<std::string> Look(bool& busy);
  void Restrain(const std::string& peer);
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

// Connections without HTTP/2: a port that reads and does nothing, and callers who send bytes to it.

#ifndef TRAVERSE_TESTS_SERVER_NET_RAW_PORT_H_
#define TRAVERSE_TESTS_SERVER_NET_RAW_PORT_H_

#include <cstddef>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "server/net/connections.h"

namespace traverse::testing {

// Who reads what a connection sends: a thread of its own, or whoever takes it in, who is kept by it
// as gRPC may keep him.
enum class Reader { kOwn, kTaker };

// A port whose connections are read from, and nothing is done with what they send.
class Port {
 public:
  explicit Port(const ConnectionRules& rules, Reader reader = Reader::kOwn);
  ~Port();

  Connections& connections() { return *connections_; }
  // The peers whose jobs it was told to end.
  std::vector<std::string> told();
  void MayEndJobs() { may_end_ = true; }

 private:
  std::mutex mutex_;
  std::vector<std::thread> readers_;
  std::vector<std::string> told_;
  bool may_end_ = false;
  std::unique_ptr<Connections> connections_;
};

// The caller's side.
class Caller {
 public:
  explicit Caller(int port, const char* source = "127.0.0.1");
  ~Caller();

  // Gives up without a word where the server has ended the connection.
  void Send(size_t bytes) const;
  bool IsCut() const;
  // As gRPC writes its address.
  const std::string& peer() const { return peer_; }

 private:
  const int socket_;
  std::string peer_;
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SERVER_NET_RAW_PORT_H_

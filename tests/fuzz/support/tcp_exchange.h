// Bytes to a port of this machine, and what comes back.

#ifndef TRAVERSE_TESTS_FUZZ_SUPPORT_TCP_EXCHANGE_H_
#define TRAVERSE_TESTS_FUZZ_SUPPORT_TCP_EXCHANGE_H_

#include <string>

namespace traverse::fuzz {

struct Exchange {
  std::string reply;
  bool ended = false;  // the server closed the connection before the patience was out
};

// Connects, sends `bytes`, closes that half, and reads until the server closes too or nothing has
// come for `patience_ms`.
Exchange TcpExchange(int port, const std::string& bytes, int patience_ms);

}  // namespace traverse::fuzz

#endif  // TRAVERSE_TESTS_FUZZ_SUPPORT_TCP_EXCHANGE_H_

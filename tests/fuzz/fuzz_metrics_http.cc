// Bytes to the operators' port.
//
// Rules: the answer is an HTTP answer or nothing, the connection ends, and /healthz goes on
// answering.

#include <algorithm>
#include <iterator>
#include <memory>
#include <random>
#include <string>

#include "server/ops/metrics/metrics_http.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/tcp_exchange.h"

namespace {

constexpr int kPatienceMs = 8000;  // the port gives a connection 5 s

// A head that never ends is waited for in one run of so many; in the others its caller hangs up.
constexpr uint64_t kWaitForUnfinished = 250;
constexpr int kHangUpMs = 2;

traverse::MetricsHttp& Port() {
  static auto* port = new std::unique_ptr<traverse::MetricsHttp>(*traverse::MetricsHttp::Start(
      "127.0.0.1:0",
      {.metrics = [] { return std::string("a 1\n"); }, .ready = [] { return true; }}));
  return **port;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using traverse::fuzz::Check;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  static uint64_t runs = 0;
  const bool hangs_up = bytes.find("\r\n\r\n") == bytes.npos && runs % kWaitForUnfinished != 0;
  const auto exchange =
      traverse::fuzz::TcpExchange(Port().port(), bytes, hangs_up ? kHangUpMs : kPatienceMs);
  Check(hangs_up || exchange.ended, "a connection ends");
  Check(exchange.reply.empty() || exchange.reply.rfind("HTTP/1.1 ", 0) == 0, "answers are HTTP");
  if (++runs % 64 == 0) {
    const auto health =
        traverse::fuzz::TcpExchange(Port().port(), "GET /healthz HTTP/1.0\r\n\r\n", kPatienceMs);
    Check(health.reply.rfind("HTTP/1.1 200 OK", 0) == 0, "the port is well");
  }
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  static const std::string words[] = {
      "GET ",    "HEAD ",     "POST ",     "/metrics", "/healthz",
      "/readyz", " HTTP/1.1", " HTTP/1.0", "\r\n",     "\r\n\r\n",
      "\n",      "Host: a",   "?",         " ",        std::string(9000, 'a')};
  std::mt19937 random(seed);
  std::string text(reinterpret_cast<const char*>(data), size);
  if (text.empty() || random() % 8 == 0) text = "GET /metrics HTTP/1.1\r\nHost: a\r\n\r\n";
  const size_t at = random() % (text.size() + 1);
  switch (random() % 3) {
    case 0:
      text.insert(at, words[random() % std::size(words)]);
      break;
    case 1:
      text.erase(at, random() % 8);
      break;
    default:
      text.insert(at, 1, static_cast<char>(random()));
  }
  text.resize(std::min({text.size(), max_size, size_t{20'000}}));
  std::copy(text.begin(), text.end(), data);
  return text.size();
}

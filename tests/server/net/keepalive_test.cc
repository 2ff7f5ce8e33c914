// Pings: HTTP/2 by hand, for every library sends and answers them by itself.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>

#include "absl/time/clock.h"
#include "absl/time/time.h"
#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

constexpr uint8_t kHeaders = 1;
constexpr uint8_t kSettings = 4;
constexpr uint8_t kPing = 6;
constexpr uint8_t kGoAway = 7;
constexpr uint8_t kEndOfHeaders = 4;  // a flag
constexpr size_t kFrameHeader = 9;

std::string Frame(uint8_t type, uint8_t flags, uint8_t stream, const std::string& body) {
  std::string frame(kFrameHeader, '\0');
  frame[2] = static_cast<char>(body.size());
  frame[3] = static_cast<char>(type);
  frame[4] = static_cast<char>(flags);
  frame[8] = static_cast<char>(stream);
  return frame + body;
}

// A header that goes into no table: `name` as a number of the static one, or written out.
std::string Literal(const std::string& name, const std::string& value) {
  return name + static_cast<char>(value.size()) + value;
}

std::string OpenCall() {
  const std::string headers =
      "\x83\x86" + Literal("\x04", "/traverse.v1.RouteOptimizerService/Optimize") +
      Literal("\x01", "localhost") + Literal("\x0f\x10", "application/grpc") +
      Literal(std::string("\x00\x02te", 4), "trailers");
  return "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n" + Frame(kSettings, 0, 0, "") +
         Frame(kHeaders, kEndOfHeaders, 1, headers);
}

// A connection with an open call, on which nothing is sent or read but by the test.
class SilentCaller {
 public:
  static constexpr int kNone = -1;

  explicit SilentCaller(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    const timeval patience{15, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
    EXPECT_EQ(connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
    Send(OpenCall());
  }
  ~SilentCaller() { close(socket_); }

  void Send(const std::string& bytes) const {
    EXPECT_EQ(send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL),
              static_cast<ssize_t>(bytes.size()));
  }

  // The type of the next frame; kNone if the server has ended the connection, or after 15 s.
  int NextFrame() {
    const std::string header = Receive(kFrameHeader);
    if (header.size() < kFrameHeader) return kNone;
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(header[i]); };
    Receive(static_cast<size_t>(byte(0) << 16 | byte(1) << 8 | byte(2)));
    return byte(3);
  }

  bool is_cut() const { return cut_; }

 private:
  std::string Receive(size_t size) {
    std::string bytes(size, '\0');
    const ssize_t count = size == 0 ? 0 : recv(socket_, bytes.data(), size, MSG_WAITALL);
    cut_ = size > 0 && count == 0;
    bytes.resize(static_cast<size_t>(std::max<ssize_t>(count, 0)));
    return bytes;
  }

  const int socket_;
  bool cut_ = false;
};

TEST(Keepalive, WhoeverAnswersNoPingIsCut) {
  TestService service([](ServerOptions& options) {
    options.listen = "127.0.0.1:0";
    options.connections.keepalive_time = absl::Seconds(1);
    options.connections.keepalive_timeout = absl::Seconds(1);
  });
  const absl::Time begun = absl::Now();
  SilentCaller caller(service.server().port());

  int pings = 0;
  for (int type = 0; type != SilentCaller::kNone; type = caller.NextFrame()) {
    pings += type == kPing ? 1 : 0;
  }

  EXPECT_TRUE(caller.is_cut());
  EXPECT_EQ(pings, 1);
  EXPECT_GE(absl::Now() - begun, absl::Seconds(1));
}

// gRPC's own rule would end the connection at the fourth within five minutes.
TEST(Keepalive, AClientThatWaitsMayPing) {
  TestService service([](ServerOptions& options) {
    options.listen = "127.0.0.1:0";
    options.connections.client_ping_interval = absl::Milliseconds(10);
  });
  SilentCaller caller(service.server().port());

  for (int i = 0; i < 8; ++i) {
    absl::SleepFor(absl::Milliseconds(20));
    caller.Send(Frame(kPing, 0, 0, "12345678"));
    int type = kSettings;
    while (type != kPing && type != kGoAway && type != SilentCaller::kNone) {
      type = caller.NextFrame();
    }
    ASSERT_EQ(type, kPing);
  }
}

}  // namespace
}  // namespace traverse::testing

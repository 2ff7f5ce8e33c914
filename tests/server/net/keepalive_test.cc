// A caller who has fallen silent: HTTP/2 by hand, for every library answers pings by itself.

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "tests/server/support/service_fixture.h"

namespace traverse::testing {
namespace {

constexpr uint8_t kHeaders = 1;
constexpr uint8_t kSettings = 4;
constexpr uint8_t kPing = 6;
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

// The types of the frames that come until the server ends the connection, or for 15 s.
std::vector<uint8_t> FramesUntilCut(int port, const std::string& bytes, bool& cut) {
  const int caller = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const timeval patience{15, 0};
  setsockopt(caller, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof(patience));
  EXPECT_EQ(connect(caller, reinterpret_cast<sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_EQ(send(caller, bytes.data(), bytes.size(), 0), static_cast<ssize_t>(bytes.size()));
  std::string received;
  char part[4096];
  ssize_t count = 0;
  while ((count = recv(caller, part, sizeof(part), 0)) > 0) {
    received.append(part, static_cast<size_t>(count));
  }
  cut = count == 0;
  close(caller);
  std::vector<uint8_t> types;
  for (size_t at = 0; at + kFrameHeader <= received.size();) {
    const auto byte = [&](size_t i) { return static_cast<uint8_t>(received[at + i]); };
    types.push_back(byte(3));
    at += kFrameHeader + static_cast<size_t>(byte(0) << 16 | byte(1) << 8 | byte(2));
  }
  return types;
}

TEST(Keepalive, WhoeverAnswersNoPingIsCut) {
  TestService service([](ServerOptions& options) {
    options.listen = "127.0.0.1:0";
    options.connections.keepalive_time = absl::Seconds(1);
    options.connections.keepalive_timeout = absl::Seconds(1);
  });
  const absl::Time begun = absl::Now();
  bool cut = false;

  const std::vector<uint8_t> types = FramesUntilCut(service.server().port(), OpenCall(), cut);

  EXPECT_TRUE(cut);
  EXPECT_EQ(std::count(types.begin(), types.end(), kPing), 1);
  EXPECT_GE(absl::Now() - begun, absl::Seconds(1));
}

}  // namespace
}  // namespace traverse::testing

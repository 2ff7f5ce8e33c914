// Bytes on the wire: what a connection to the server's port begins with after HTTP/2's preface.
//
// Inputs are frames of HTTP/2, with a job inside, changed at random. Rules: the server lives, and
// goes on answering good calls.

#include <google/protobuf/stubs/logging.h>
#include <grpcpp/grpcpp.h>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "server/server.h"
#include "tests/fuzz/support/check.h"
#include "tests/fuzz/support/seed_jobs.h"
#include "tests/fuzz/support/tcp_exchange.h"
#include "traverse/v1/route_optimizer_service.grpc.pb.h"

namespace traverse::fuzz {
namespace {

constexpr char kPreface[] = "PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n";

// A connection that stays open is no fault: the server may wait for more.
constexpr int kPatienceMs = 20;

constexpr size_t kHeaderBytes = 9;

struct Frame {
  uint8_t type = 0;
  uint8_t flags = 0;
  uint32_t stream = 0;
  std::string payload;
};

std::string BigEndian(uint64_t value, int bytes) {
  std::string out;
  for (int i = bytes - 1; i >= 0; --i) out.push_back(static_cast<char>(value >> (8 * i)));
  return out;
}

std::string Write(const std::vector<Frame>& frames) {
  std::string out;
  for (const Frame& frame : frames) {
    out += BigEndian(frame.payload.size(), 3);
    out.push_back(static_cast<char>(frame.type));
    out.push_back(static_cast<char>(frame.flags));
    out += BigEndian(frame.stream, 4) + frame.payload;
  }
  return out;
}

// The frames in `bytes`, up to the first one that is cut short.
std::vector<Frame> Read(const std::string& bytes) {
  const auto byte = [&](size_t i) { return static_cast<uint32_t>(static_cast<uint8_t>(bytes[i])); };
  std::vector<Frame> frames;
  for (size_t at = 0; at + kHeaderBytes <= bytes.size();) {
    const size_t length = byte(at) << 16 | byte(at + 1) << 8 | byte(at + 2);
    if (at + kHeaderBytes + length > bytes.size()) break;
    Frame& frame = frames.emplace_back();
    frame.type = static_cast<uint8_t>(byte(at + 3));
    frame.flags = static_cast<uint8_t>(byte(at + 4));
    frame.stream = byte(at + 5) << 24 | byte(at + 6) << 16 | byte(at + 7) << 8 | byte(at + 8);
    frame.payload = bytes.substr(at + kHeaderBytes, length);
    at += kHeaderBytes + length;
  }
  return frames;
}

// A header as HPACK's literal without indexing. REQUIRES: both are shorter than 127 bytes.
std::string Header(const std::string& name, const std::string& value) {
  std::string out(1, '\0');
  for (const std::string& text : {name, value}) {
    out.push_back(static_cast<char>(text.size()));
    out += text;
  }
  return out;
}

// A good call: SETTINGS, HEADERS, and DATA that ends the stream.
std::vector<Frame> GoodCall(std::mt19937& random) {
  const char* const methods[] = {"OptimizeBatch", "Optimize", "ListStrategies"};
  const std::string path =
      std::string("/traverse.v1.RouteOptimizerService/") + methods[random() % 3];
  const std::string headers =
      Header(":method", "POST") + Header(":scheme", "http") + Header(":path", path) +
      Header(":authority", "a") + Header("te", "trailers") +
      Header("content-type", "application/grpc") + Header("grpc-timeout", "200m");
  const std::string job = SeedJob(random).SerializeAsString();
  return {{4, 0, 0, ""},
          {1, 4, 1, headers},
          {0, 1, 1, std::string(1, '\0') + BigEndian(job.size(), 4) + job}};
}

void ChangeFrame(Frame& frame, std::mt19937& random) {
  switch (random() % 6) {
    case 0:
      frame.type = static_cast<uint8_t>(random() % 12);
      return;
    case 1:
      frame.flags = static_cast<uint8_t>(random());
      return;
    case 2:
      frame.stream = static_cast<uint32_t>(random() % 4 == 0 ? random() : random() % 8);
      return;
    case 3:
      if (!frame.payload.empty()) {
        frame.payload[random() % frame.payload.size()] = static_cast<char>(random());
      }
      return;
    case 4:
      frame.payload.resize(random() % (frame.payload.size() + 8));
      return;
    default:
      frame.payload.insert(random() % (frame.payload.size() + 1), 1, static_cast<char>(random()));
  }
}

void ChangeFrames(std::vector<Frame>& frames, std::mt19937& random) {
  const auto any = [&] { return random() % frames.size(); };
  switch (random() % 6) {
    case 0:
      frames.push_back(frames[any()]);
      return;
    case 1:
      frames.erase(frames.begin() + static_cast<std::ptrdiff_t>(any()));
      return;
    case 2:
      std::swap(frames[any()], frames[any()]);
      return;
    default:
      ChangeFrame(frames[any()], random);
  }
}

class Target {
 public:
  Target() {
    google::protobuf::SetLogHandler(nullptr);
    gpr_set_log_function([](gpr_log_func_args*) {});
    ServerOptions options;
    options.listen = "127.0.0.1:0";
    options.service.log = false;
    options.service.threads = 2;
    auto server = Server::Start(options);
    Check(server.ok(), "the server starts");
    server_ = *std::move(server);
    stub_ = v1::RouteOptimizerService::NewStub(grpc::CreateChannel(
        "127.0.0.1:" + std::to_string(server_->port()), grpc::InsecureChannelCredentials()));
  }

  int port() const { return server_->port(); }

  bool AnswersAGoodCall() {
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(15));
    context.set_wait_for_ready(true);
    v1::ListStrategiesResponse response;
    return stub_->ListStrategies(&context, {}, &response).ok();
  }

 private:
  std::unique_ptr<Server> server_;
  std::unique_ptr<v1::RouteOptimizerService::Stub> stub_;
};

Target& TheTarget() {
  static Target* target = new Target();  // lives until the process ends
  return *target;
}

}  // namespace
}  // namespace traverse::fuzz

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace traverse::fuzz;
  const std::string bytes(reinterpret_cast<const char*>(data), size);
  TcpExchange(TheTarget().port(), kPreface + bytes, kPatienceMs);
  static uint64_t runs = 0;
  if (++runs % 64 == 0) Check(TheTarget().AnswersAGoodCall(), "the server goes on answering");
  return 0;
}

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size,
                                          unsigned int seed) {
  using namespace traverse::fuzz;
  std::mt19937 random(seed);
  std::vector<Frame> frames = Read(std::string(reinterpret_cast<const char*>(data), size));
  if (frames.empty() || size > 8192 || random() % 8 == 0) frames = GoodCall(random);
  const uint64_t changes = 1 + random() % 3;
  for (uint64_t i = 0; i < changes && !frames.empty(); ++i) ChangeFrames(frames, random);
  std::string bytes = Write(frames);
  if (!bytes.empty() && random() % 8 == 0)
    bytes[random() % bytes.size()] = static_cast<char>(random());
  bytes.resize(std::min(bytes.size(), max_size));
  std::copy(bytes.begin(), bytes.end(), data);
  return bytes.size();
}

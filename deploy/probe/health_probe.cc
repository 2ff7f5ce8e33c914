// traverse-health-probe: asks a server's gRPC health service, for container health checks and
// probes that cannot speak gRPC or TLS themselves.
//
//   traverse-health-probe --address=127.0.0.1:50051
//   traverse-health-probe --address=127.0.0.1:50051 --tls_ca=ca.crt --tls_server_name=traverse
//   traverse-health-probe --sleep=5s        waits, for images without a shell to run `sleep` in
//
// Exit codes: 0 serving; 1 not serving, or no answer in time; 2 usage.

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "absl/flags/flag.h"
#include "absl/flags/parse.h"
#include "absl/flags/usage.h"
#include "absl/time/clock.h"
#include "absl/time/time.h"

ABSL_FLAG(std::string, address, "127.0.0.1:50051", "HOST:PORT of the server");
ABSL_FLAG(std::string, service, "traverse.v1.RouteOptimizerService",
          "Service whose health is asked; empty: the server as a whole");
ABSL_FLAG(absl::Duration, timeout, absl::Seconds(2), "How long to wait for the answer");
ABSL_FLAG(std::string, tls_ca, "", "PEM file with the authority of the server's certificate");
ABSL_FLAG(std::string, tls_cert, "", "PEM file with a client certificate, for mutual TLS");
ABSL_FLAG(std::string, tls_key, "", "PEM file with the key of --tls_cert");
ABSL_FLAG(std::string, tls_server_name, "", "Name in the certificate, if it is not the address");
ABSL_FLAG(absl::Duration, sleep, absl::ZeroDuration(), "Only wait so long and exit with 0");

namespace {

constexpr int kServing = 0, kNotServing = 1, kUsage = 2;

// The text of a file; empty for an empty name. Ends the program if it cannot be read.
std::string ReadFile(const std::string& name) {
  if (name.empty()) return "";
  std::ifstream file(name, std::ios::binary);
  if (!file) {
    std::fprintf(stderr, "traverse-health-probe: cannot read %s\n", name.c_str());
    std::exit(kUsage);
  }
  return {std::istreambuf_iterator<char>(file), {}};
}

std::shared_ptr<grpc::Channel> Connect() {
  const std::string address = absl::GetFlag(FLAGS_address);
  const std::string authority = ReadFile(absl::GetFlag(FLAGS_tls_ca));
  if (authority.empty()) {
    return grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  }
  const grpc::SslCredentialsOptions options = {authority, ReadFile(absl::GetFlag(FLAGS_tls_key)),
                                               ReadFile(absl::GetFlag(FLAGS_tls_cert))};
  grpc::ChannelArguments arguments;
  const std::string name = absl::GetFlag(FLAGS_tls_server_name);
  if (!name.empty()) arguments.SetSslTargetNameOverride(name);
  return grpc::CreateCustomChannel(address, grpc::SslCredentials(options), arguments);
}

// HealthCheckRequest{service}: field 1, a string shorter than 128 bytes.
grpc::ByteBuffer Request(const std::string& service) {
  std::string bytes = {'\x0a', static_cast<char>(service.size())};
  bytes += service;
  const grpc::Slice slice(bytes);
  return grpc::ByteBuffer(&slice, 1);
}

// HealthCheckResponse{status: SERVING}: field 1, the number 1.
bool IsServing(const grpc::ByteBuffer& answer) {
  std::vector<grpc::Slice> slices;
  if (!answer.Dump(&slices).ok()) return false;
  std::string bytes;
  for (const grpc::Slice& slice : slices) {
    bytes.append(reinterpret_cast<const char*>(slice.begin()), slice.size());
  }
  return bytes == std::string{'\x08', '\x01'};
}

int Probe() {
  grpc::GenericStub stub(Connect());
  grpc::ClientContext context;
  context.set_deadline(absl::ToChronoTime(absl::Now() + absl::GetFlag(FLAGS_timeout)));
  grpc::CompletionQueue queue;
  const grpc::ByteBuffer request = Request(absl::GetFlag(FLAGS_service));
  const auto call =
      stub.PrepareUnaryCall(&context, "/grpc.health.v1.Health/Check", request, &queue);
  call->StartCall();
  grpc::ByteBuffer answer;
  grpc::Status status;
  call->Finish(&answer, &status, nullptr);
  void* tag = nullptr;
  bool finished = false;
  queue.Next(&tag, &finished);
  if (!status.ok()) {
    std::fprintf(stderr, "traverse-health-probe: %s\n", status.error_message().c_str());
    return kNotServing;
  }
  if (!IsServing(answer)) {
    std::fputs("traverse-health-probe: not serving\n", stderr);
    return kNotServing;
  }
  return kServing;
}

}  // namespace

int main(int argc, char** argv) {
  absl::SetProgramUsageMessage("Asks a gRPC server whether it serves; exit code 0 if it does.");
  const std::vector<char*> arguments = absl::ParseCommandLine(argc, argv);
  if (arguments.size() > 1 || absl::GetFlag(FLAGS_service).size() > 127) {
    std::fputs("traverse-health-probe: unexpected argument; see --help\n", stderr);
    return kUsage;
  }
  if (absl::GetFlag(FLAGS_sleep) > absl::ZeroDuration()) {
    absl::SleepFor(absl::GetFlag(FLAGS_sleep));
    return kServing;
  }
  return Probe();
}

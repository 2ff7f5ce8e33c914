// TLS, mutual TLS with rotation, tokens, plaintext and configuration of the binary.

#include <gmock/gmock.h>
#include <grpcpp/grpcpp.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>

#include "absl/strings/str_cat.h"
#include "absl/time/clock.h"
#include "server/access/credentials.h"
#include "tests/server/support/server_process.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/scratch_folder.h"

namespace traverse::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string ReadAll(const std::string& path) {
  std::ifstream file(path);
  return {std::istreambuf_iterator<char>(file), {}};
}

// Authorities and certificates in a folder of the test's own, made by the openssl program.
class Certificates {
 public:
  Certificates() {
    MakeAuthority("ca");
    MakeLeaf("server", "ca");
    MakeLeaf("client", "ca");
  }

  void MakeAuthority(const std::string& name) const {
    Run(absl::StrCat("openssl req -x509 -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -days 2",
                     " -subj /CN=", name, " -keyout ", Path(name + ".key"), " -out ",
                     Path(name + ".pem")));
  }
  void MakeLeaf(const std::string& name, const std::string& authority, int days = 2) const {
    Run(absl::StrCat("openssl req -newkey ec -pkeyopt ec_paramgen_curve:P-256 -nodes -subj /CN=",
                     name, " -keyout ", Path(name + ".key"), " -out ", Path(name + ".csr")));
    std::ofstream(Path("ext")) << "subjectAltName=DNS:localhost\n";
    Run(absl::StrCat("openssl x509 -req -days ", days, " -CAcreateserial -extfile ", Path("ext"),
                     " -in ", Path(name + ".csr"), " -CA ", Path(authority + ".pem"), " -CAkey ",
                     Path(authority + ".key"), " -out ", Path(name + ".pem")));
  }
  std::string Path(const std::string& name) const { return folder_.Path(name); }

 private:
  static void Run(const std::string& command) {
    if (std::system((command + " >/dev/null 2>&1").c_str()) != 0) std::abort();
  }

  ScratchFolder folder_;
};

// The code of ListStrategies over a new connection to `address`. Empty `ca`: plaintext.
grpc::StatusCode CallAt(const std::string& address, const std::string& ca = "",
                        const std::string& client = "", const std::string& token = "") {
  std::shared_ptr<grpc::ChannelCredentials> credentials = grpc::InsecureChannelCredentials();
  if (!ca.empty()) {
    grpc::SslCredentialsOptions options;
    options.pem_root_certs = ReadAll(ca);
    if (!client.empty()) {
      options.pem_cert_chain = ReadAll(client + ".pem");
      options.pem_private_key = ReadAll(client + ".key");
    }
    credentials = grpc::SslCredentials(options);
  }
  grpc::ChannelArguments arguments;
  arguments.SetSslTargetNameOverride("localhost");
  arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateCustomChannel(address, credentials, arguments));
  grpc::ClientContext context;
  context.set_deadline(absl::ToChronoTime(absl::Now() + absl::Seconds(5)));
  if (!token.empty()) context.AddMetadata("authorization", "Bearer " + token);
  v1::ListStrategiesResponse response;
  return stub->ListStrategies(&context, {}, &response).error_code();
}

grpc::StatusCode Call(const ServerProcess& server, const std::string& ca = "",
                      const std::string& client = "", const std::string& token = "") {
  return CallAt(server.address(), ca, client, token);
}

TEST(Security, LoopbackIsToldFromOtherAddresses) {
  for (const char* local : {"127.0.0.1:1", "127.8.9.1:1", "localhost:1", "[::1]:1", "unix:/x"}) {
    EXPECT_TRUE(IsLoopback(local)) << local;
  }
  for (const char* other : {"0.0.0.0:1", "[::]:1", "10.0.0.1:1", "127.example.org:1", "farm:1"}) {
    EXPECT_FALSE(IsLoopback(other)) << other;
  }
}

TEST(Security, PlaintextOffLoopbackHasToBeAskedFor) {
  ChildProcess refused({TRAVERSE_SERVER_BINARY, "--listen=0.0.0.0:0", "--metrics_listen="});
  EXPECT_EQ(refused.Wait(), 2);
  EXPECT_THAT(refused.Errors(), HasSubstr("--insecure"));

  ServerProcess asked({"--listen=0.0.0.0:0", "--insecure"});
  EXPECT_EQ(Call(asked), grpc::StatusCode::OK);
}

TEST(Security, TlsAnswersOnlyTls) {
  const Certificates files;
  ServerProcess server(
      {"--tls_certificate=" + files.Path("server.pem"), "--tls_key=" + files.Path("server.key")});

  EXPECT_EQ(Call(server, files.Path("ca.pem")), grpc::StatusCode::OK);
  EXPECT_EQ(Call(server), grpc::StatusCode::UNAVAILABLE);
}

TEST(Security, MutualTlsWantsACertificateThatMayCall) {
  const Certificates files;
  files.MakeAuthority("stranger_ca");
  files.MakeLeaf("stranger", "stranger_ca");
  const std::string certificate = "--tls_certificate=" + files.Path("server.pem");
  const std::string key = "--tls_key=" + files.Path("server.key");
  const std::string authority = "--tls_client_ca=" + files.Path("ca.pem");
  ServerProcess any({certificate, key, authority});
  ServerProcess none({certificate, key, authority, "--allowed_clients=somebody.else"});

  EXPECT_EQ(Call(any, files.Path("ca.pem"), files.Path("client")), grpc::StatusCode::OK);
  EXPECT_EQ(Call(any, files.Path("ca.pem")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(Call(any, files.Path("ca.pem"), files.Path("stranger")), grpc::StatusCode::UNAVAILABLE);
  EXPECT_EQ(Call(none, files.Path("ca.pem"), files.Path("client")),
            grpc::StatusCode::PERMISSION_DENIED);
}

TEST(Security, CertificatesAreRotatedWithoutARestart) {
  const Certificates files;
  ServerProcess server(
      {"--tls_certificate=" + files.Path("server.pem"), "--tls_key=" + files.Path("server.key")});
  ASSERT_EQ(Call(server, files.Path("ca.pem")), grpc::StatusCode::OK);

  files.MakeAuthority("new_ca");
  files.MakeLeaf("server", "new_ca");

  EXPECT_TRUE(TestService::Eventually(
      [&] { return Call(server, files.Path("new_ca.pem")) == grpc::StatusCode::OK; }));
  EXPECT_EQ(Call(server, files.Path("ca.pem")), grpc::StatusCode::UNAVAILABLE);
}

// gRPC asks for the certificates at each handshake. What was freed by then is overwritten here.
TEST(Security, AUnixSocketKeepsItsCertificates) {
  const Certificates files;
  const std::string address = "unix:" + files.Path("socket");
  setenv("GLIBC_TUNABLES", "glibc.malloc.perturb=165:glibc.malloc.tcache_count=0", 1);
  ServerProcess server({"--listen=" + address, "--tls_certificate=" + files.Path("server.pem"),
                        "--tls_key=" + files.Path("server.key")});
  unsetenv("GLIBC_TUNABLES");

  EXPECT_EQ(CallAt(address, files.Path("ca.pem")), grpc::StatusCode::OK);
  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);
}

TEST(Security, AuthoritiesOfClientsAreRotatedWithoutARestart) {
  const Certificates files;
  const std::string trusted = files.Path("trusted.pem");
  std::filesystem::copy_file(files.Path("ca.pem"), trusted);
  ServerProcess server({"--tls_certificate=" + files.Path("server.pem"),
                        "--tls_key=" + files.Path("server.key"), "--tls_client_ca=" + trusted});
  files.MakeAuthority("next_ca");
  files.MakeLeaf("next", "next_ca");
  ASSERT_EQ(Call(server, files.Path("ca.pem"), files.Path("client")), grpc::StatusCode::OK);
  ASSERT_NE(Call(server, files.Path("ca.pem"), files.Path("next")), grpc::StatusCode::OK);

  std::filesystem::copy_file(files.Path("next_ca.pem"), trusted + ".new");
  std::filesystem::rename(trusted + ".new", trusted);

  EXPECT_TRUE(TestService::Eventually([&] {
    return Call(server, files.Path("ca.pem"), files.Path("next")) == grpc::StatusCode::OK;
  }));
  EXPECT_NE(Call(server, files.Path("ca.pem"), files.Path("client")), grpc::StatusCode::OK);
}

TEST(Security, BadCertificatesAreFoundAtTheStart) {
  const Certificates files;
  ChildProcess wrong_key({TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0",
                          "--metrics_listen=", "--tls_certificate=" + files.Path("server.pem"),
                          "--tls_key=" + files.Path("client.key")});
  EXPECT_EQ(wrong_key.Wait(), 2);
  EXPECT_EQ(wrong_key.Errors(),
            "traverse-server: cannot use the private key " + files.Path("client.key") +
                ": it does not belong to the certificate " + files.Path("server.pem") + "\n");

  ChildProcess missing({TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0", "--metrics_listen=",
                        "--tls_certificate=/proc/none", "--tls_key=" + files.Path("server.key")});
  EXPECT_EQ(missing.Wait(), 2);
  EXPECT_THAT(missing.Errors(), HasSubstr("/proc/none"));

  files.MakeLeaf("old", "ca", /*days=*/-1);
  ChildProcess expired({TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0",
                        "--metrics_listen=", "--tls_certificate=" + files.Path("old.pem"),
                        "--tls_key=" + files.Path("old.key")});
  EXPECT_EQ(expired.Wait(), 2);
  EXPECT_THAT(expired.Errors(), HasSubstr(files.Path("old.pem") + ": it expired on 2"));
}

TEST(Security, ABadNewCertificateLeavesTheOldOneInUse) {
  const Certificates files;
  ServerProcess server(
      {"--tls_certificate=" + files.Path("server.pem"), "--tls_key=" + files.Path("server.key")});
  const std::string failures = "traverse_reload_failures_total{what=\"certificate\"}";
  ASSERT_EQ(server.Metric(failures), 0);
  const std::string expiry = "traverse_certificate_expiry_seconds{file=\"certificate\"}";
  EXPECT_NEAR(server.Metric(expiry), 2 * 24 * 3600, 600);

  std::filesystem::copy_file(files.Path("client.key"), files.Path("server.key.new"));
  std::filesystem::rename(files.Path("server.key.new"), files.Path("server.key"));

  EXPECT_TRUE(TestService::Eventually([&] { return server.Metric(failures) == 1; }));
  EXPECT_EQ(Call(server, files.Path("ca.pem")), grpc::StatusCode::OK);

  files.MakeLeaf("old", "ca", /*days=*/-1);
  std::filesystem::rename(files.Path("old.key"), files.Path("server.key"));
  std::filesystem::rename(files.Path("old.pem"), files.Path("server.pem"));
  EXPECT_TRUE(TestService::Eventually([&] { return server.Metric(failures) >= 2; }));
  EXPECT_EQ(Call(server, files.Path("ca.pem")), grpc::StatusCode::OK);
  EXPECT_GT(server.Metric(expiry), 0);
  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);
  EXPECT_THAT(server.process().Errors(), HasSubstr("\"event\":\"certificate_reloaded\""));
}

TEST(Security, ADirectoryIsNoTokenFile) {
  const ScratchFolder folder;
  ChildProcess refused({TRAVERSE_SERVER_BINARY, "--listen=127.0.0.1:0",
                        "--metrics_listen=", "--token_file=" + folder.Path("")});
  EXPECT_EQ(refused.Wait(), 2);
  EXPECT_EQ(refused.Errors(),
            "traverse-server: token file " + folder.Path("") + ": it is a directory\n");

  // One that becomes a directory leaves the tokens that were known.
  const std::string path = folder.Path("tokens");
  std::ofstream(path) << "farm 41ef4bb0b23661e66301aac36066912dac037827b4ae63a7b1165a5aa93ed4eb\n";
  ServerProcess server({"--token_file=" + path});
  std::filesystem::remove(path);
  std::filesystem::create_directory(path);

  EXPECT_TRUE(TestService::Eventually(
      [&] { return server.Metric("traverse_reload_failures_total{what=\"tokens\"}") == 1; }));
  EXPECT_EQ(Call(server), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(Call(server, "", "", "open sesame"), grpc::StatusCode::OK);
}

TEST(Security, TokensAreAskedForAndNeverLogged) {
  const ScratchFolder folder;
  const std::string path = folder.Path("tokens");
  // The SHA-256 of "open sesame".
  std::ofstream(path) << "farm 41ef4bb0b23661e66301aac36066912dac037827b4ae63a7b1165a5aa93ed4eb\n";
  ServerProcess server({"--token_file=" + path});

  EXPECT_EQ(Call(server), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(Call(server, "", "", "wrong-token"), grpc::StatusCode::UNAUTHENTICATED);
  EXPECT_EQ(Call(server, "", "", "open sesame"), grpc::StatusCode::OK);
  const auto stub = v1::RouteOptimizerService::NewStub(
      grpc::CreateChannel(server.address(), grpc::InsecureChannelCredentials()));
  for (const char* token : {"open sesame", "wrong-token"}) {
    grpc::ClientContext context;
    context.AddMetadata("authorization", absl::StrCat("Bearer ", token));
    const auto reader = stub->OptimizeBatch(&context, MakeBatch(1));
    v1::OptimizeBatchResponse response;
    while (reader->Read(&response)) {
    }
    reader->Finish();
  }
  server.process().Signal(SIGTERM);
  EXPECT_EQ(server.process().Wait(), 0);

  EXPECT_THAT(server.process().Errors(), HasSubstr("\"caller\":\"token:farm\""));
  EXPECT_THAT(server.process().Errors(), Not(HasSubstr("sesame")));
  EXPECT_THAT(server.process().Errors(), Not(HasSubstr("wrong-token")));
}

TEST(Configuration, FileSetsFlagsAndTheCommandLineWins) {
  const ScratchFolder folder;
  const std::string path = folder.Path("config");
  std::ofstream(path) << "# of the farm\nthreads = 3\nmax_jobs=7\n\n";
  {
    ServerProcess server({"--config=" + path, "--threads=1"});
    EXPECT_EQ(server.Metric("traverse_workers"), 1);
  }
  {
    ServerProcess server({"--config=" + path});
    EXPECT_EQ(server.Metric("traverse_workers"), 3);
  }
  std::ofstream(path) << "threads=2\nthread=3\n";
  ChildProcess bad({TRAVERSE_SERVER_BINARY, "--config", path});
  EXPECT_EQ(bad.Wait(), 2);
  EXPECT_EQ(bad.Errors(),
            "traverse-server: " + path + ":2: unknown flag --thread; --help lists all flags\n");
}

TEST(Configuration, ValuesOutOfRangeAreNamed) {
  ChildProcess bad({TRAVERSE_SERVER_BINARY, "--threads=-1"});

  EXPECT_EQ(bad.Wait(), 2);
  EXPECT_EQ(bad.Errors(), "traverse-server: --threads: -1 is below 0\n");
}

}  // namespace
}  // namespace traverse::testing

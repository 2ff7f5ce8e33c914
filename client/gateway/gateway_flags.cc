#include "client/gateway/gateway_flags.h"

#include <absl/flags/flag.h>
#include <limits.h>
#include <unistd.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include "absl/strings/ascii.h"
#include "absl/strings/str_cat.h"
#include "client/files/read_file.h"
#include "client/gateway/jobs/job_ids.h"
#include "server/net/open_files.h"
#include "server/ops/flag_reader.h"
#include "server/ops/memory.h"
#include "server/server.h"

ABSL_FLAG(std::string, listen_http, "127.0.0.1:8080",
          "HOST:PORT of HTTP; port 0 takes a free port");
ABSL_FLAG(std::string, listen, "127.0.0.1:50061",
          "HOST:PORT of gRPC; port 0 takes a free port; empty: no gRPC");
ABSL_FLAG(std::string, metrics_listen, "127.0.0.1:9465",
          "HOST:PORT of /metrics, /healthz and /readyz for operators; port 0 takes a free port; "
          "empty: no such port");
ABSL_FLAG(std::string, server, "",
          "HOST:PORT,... of the servers that search; empty: search in this process");
ABSL_FLAG(std::string, server_token_file, "", "File whose first line is the token for --server");
ABSL_FLAG(bool, server_tls, false, "Encrypt calls to --server");
ABSL_FLAG(std::string, server_tls_ca, "",
          "Authorities of the certificates of --server, in PEM; implies --server_tls");
ABSL_FLAG(std::string, server_tls_name, "",
          "Name in the certificates of --server; implies --server_tls");
ABSL_FLAG(std::string, server_tls_certificate, "", "Certificate shown to --server, in PEM");
ABSL_FLAG(std::string, server_tls_key, "", "Its private key, in PEM");
ABSL_FLAG(int32_t, threads, 0, "Threads of the search in this process; 0: one per core");
ABSL_FLAG(int32_t, workers, 0, "Files worked on at a time; 0: one per core, but at least two");
ABSL_FLAG(int32_t, max_requests, 256, "Files under way at a time, including those that wait");
ABSL_FLAG(int32_t, max_requests_per_caller, 64, "The same for one caller");
ABSL_FLAG(
    std::vector<std::string>, caller_weights, {},
    "CALLER=WEIGHT,...: shares of the workers' time, by the names of --token_file or of client "
    "certificates, or by address; others have 1");
ABSL_FLAG(int64_t, max_file_bytes, int64_t{256} << 20, "Longest file, unpacked, in bytes");
ABSL_FLAG(
    int64_t, max_memory, 0,
    "Memory of the process, in bytes: files being worked on and unfinished messages; 0: three "
    "quarters of the container's limit, or else of the machine's memory");
ABSL_FLAG(std::string, spool_dir, "",
          "Folder for uploads and answers; empty: the folder for temporary files. No file there "
          "outlives the process");
ABSL_FLAG(int64_t, max_spool_bytes, int64_t{4} << 30, "Most bytes of all files there together");
ABSL_FLAG(absl::Duration, job_ttl, absl::Hours(1), "How long results of /v1/jobs are kept");
ABSL_FLAG(int64_t, max_jobs, 1024,
          "Most jobs under way and kept; a caller has half, and of the last quarter a sixteenth");
ABSL_FLAG(std::string, gateway_name, "",
          "Name with which ids of jobs begin, unique among the gateways behind one address; empty: "
          "the machine's name and the port of --listen_http");
ABSL_FLAG(absl::Duration, max_time, absl::Minutes(10), "Longest time for one file");
ABSL_FLAG(std::string, printers, "",
          "JSON file that names the printers for uploads; empty: no printers");
ABSL_FLAG(absl::Duration, upload_deadline, absl::Seconds(60),
          "Longest time for a printer's file; after it the printer gets the original");
ABSL_FLAG(absl::Duration, upstream_idle_timeout, absl::Seconds(60),
          "Give up a printer's server that accepts nothing, or has not answered, for this long");
ABSL_FLAG(int32_t, max_connections, 512, "Connections at a time, of HTTP and of gRPC each");
ABSL_FLAG(int32_t, max_connections_per_address, 384,
          "HTTP connections from one address; behind a proxy all share one address");
ABSL_FLAG(int32_t, max_header_bytes, 16384, "Longest head of a request, in bytes");
ABSL_FLAG(absl::Duration, header_timeout, absl::Seconds(20),
          "Time for the head of a request, including the wait for it");
ABSL_FLAG(absl::Duration, idle_timeout, absl::Seconds(30),
          "End a request whose client neither sends nor reads anything for this long");
ABSL_FLAG(int64_t, min_upload_rate, 4096,
          "Least mean rate in bytes per second, after --idle_timeout, at which a client must send "
          "an upload and read an answer");
ABSL_FLAG(absl::Duration, max_transfer_time, absl::Minutes(30),
          "Longest time for an upload, and for reading an answer");
ABSL_FLAG(absl::Duration, drain_timeout, absl::Seconds(30),
          "How long running requests may continue after SIGTERM");
ABSL_FLAG(std::string, log_file, "", "File to which the log is appended; empty: stderr");
ABSL_FLAG(std::string, token_file, "",
          "File of \"NAME SHA256\" lines; callers then need the token, as bearer or X-Api-Key; "
          "empty: no token needed");
ABSL_FLAG(std::vector<std::string>, allowed_clients, {},
          "Names in client certificates that may call; empty: all valid ones");
ABSL_FLAG(std::vector<std::string>, allowed_hosts, {},
          "Names, without port, to which HTTP requests may be sent besides this machine's own; *: "
          "any. If unset, the gateway refuses other names only without TLS and tokens");
ABSL_FLAG(std::string, tls_certificate, "", "Certificate chain in PEM; empty: no TLS");
ABSL_FLAG(std::string, tls_key, "", "Its private key in PEM");
ABSL_FLAG(std::string, tls_client_ca, "",
          "Authorities in PEM; clients must show a certificate from one of them; empty: no "
          "certificate needed");
ABSL_FLAG(bool, insecure, false, "Allow plaintext on addresses other than loopback");
ABSL_FLAG(std::string, config, "",
          "File of flags, lines name=value; flags on the command line override it");
ABSL_FLAG(std::string, flagfile, "",
          "The same as --config, but read where it stands on the command line");

namespace traverse::gateway {
namespace {

absl::Status CheckRanges() {
  const absl::Status numbers = CheckLeastValues({
      {"threads", absl::GetFlag(FLAGS_threads), 0},
      {"workers", absl::GetFlag(FLAGS_workers), 0},
      {"max_requests", absl::GetFlag(FLAGS_max_requests), 1},
      {"max_requests_per_caller", absl::GetFlag(FLAGS_max_requests_per_caller), 1},
      {"max_file_bytes", absl::GetFlag(FLAGS_max_file_bytes), 1},
      {"max_memory", absl::GetFlag(FLAGS_max_memory), 0},
      {"max_spool_bytes", absl::GetFlag(FLAGS_max_spool_bytes), 1},
      {"max_jobs", absl::GetFlag(FLAGS_max_jobs), 0},
      {"max_connections", absl::GetFlag(FLAGS_max_connections), 1},
      {"max_connections_per_address", absl::GetFlag(FLAGS_max_connections_per_address), 1},
      {"max_header_bytes", absl::GetFlag(FLAGS_max_header_bytes), 1024},
      {"min_upload_rate", absl::GetFlag(FLAGS_min_upload_rate), 1},
  });
  if (!numbers.ok()) return numbers;
  if (const auto weights = ParseWeights(absl::GetFlag(FLAGS_caller_weights)); !weights.ok()) {
    return weights.status();
  }
  const struct {
    const char* name;
    absl::Duration value;
  } times[] = {
      {"max_time", absl::GetFlag(FLAGS_max_time)},
      {"job_ttl", absl::GetFlag(FLAGS_job_ttl)},
      {"upload_deadline", absl::GetFlag(FLAGS_upload_deadline)},
      {"upstream_idle_timeout", absl::GetFlag(FLAGS_upstream_idle_timeout)},
      {"header_timeout", absl::GetFlag(FLAGS_header_timeout)},
      {"idle_timeout", absl::GetFlag(FLAGS_idle_timeout)},
      {"max_transfer_time", absl::GetFlag(FLAGS_max_transfer_time)},
  };
  for (const auto& time : times) {
    if (time.value <= absl::ZeroDuration()) return BadFlag(time.name, "not above 0");
  }
  const std::string name = absl::GetFlag(FLAGS_gateway_name);
  if (!name.empty() && !IsGatewayName(name)) {
    return BadFlag("gateway_name", "not 1 to 64 letters, digits, '.', '_' and '-'");
  }
  return CheckDaemonFlags(absl::GetFlag(FLAGS_drain_timeout), absl::GetFlag(FLAGS_allowed_clients),
                          absl::GetFlag(FLAGS_tls_client_ca));
}

FlagProgram Program() {
  return {"traverse-gateway", "client/gateway/gateway_flags.cc",
          "Rewrites sliced files over HTTP and gRPC so that they print with less travel; see "
          "client/gateway/README.md.\n\n"
          "usage: traverse-gateway [--listen_http=HOST:PORT] [--server=HOST:PORT,...] "
          "[--name=value ...]\n"
          "       traverse-gateway --config=FILE\n"
          "       traverse-gateway --version | --help\n\n",
          CheckRanges};
}

absl::Status SetServers(GatewayOptions& options) {
  const ChannelTls tls = {
      absl::GetFlag(FLAGS_server_tls_ca), absl::GetFlag(FLAGS_server_tls_certificate),
      absl::GetFlag(FLAGS_server_tls_key), absl::GetFlag(FLAGS_server_tls_name)};
  const bool any = !tls.ca.empty() || !tls.certificate.empty() || !tls.key.empty() ||
                   !tls.name.empty() || absl::GetFlag(FLAGS_server_tls);
  const std::string token_file = absl::GetFlag(FLAGS_server_token_file);
  if (absl::GetFlag(FLAGS_server).empty()) {
    if (any || !token_file.empty()) return BadFlag("server", "missing, but other flags need it");
    return absl::OkStatus();
  }
  absl::StatusOr<std::vector<std::string>> servers = ParseAddresses(absl::GetFlag(FLAGS_server));
  if (!servers.ok()) return BadFlag("server", std::string(servers.status().message()));
  options.servers = *std::move(servers);
  if (any) options.connect.tls = tls;
  if (token_file.empty()) return absl::OkStatus();
  absl::StatusOr<std::string> text = ReadWholeFile(token_file, size_t{1} << 16);
  if (!text.ok()) return BadFlag("server_token_file", std::string(text.status().message()));
  options.token = std::string(absl::StripAsciiWhitespace(text->substr(0, text->find('\n'))));
  if (options.token.empty()) return BadFlag("server_token_file", "contains no token");
  const bool local = std::all_of(options.servers.begin(), options.servers.end(), IsLocal);
  if (!any && !local && !absl::GetFlag(FLAGS_insecure)) {
    return BadFlag("server_token_file",
                   "the token would go to another machine unencrypted: use --server_tls, or "
                   "--insecure");
  }
  return absl::OkStatus();
}

std::string SpoolFolder() {
  const std::string given = absl::GetFlag(FLAGS_spool_dir);
  if (!given.empty()) return given;
  std::error_code error;
  const std::filesystem::path folder = std::filesystem::temp_directory_path(error);
  return error ? "/tmp" : folder.string();
}

std::string GatewayName() {
  const std::string given = absl::GetFlag(FLAGS_gateway_name);
  if (!given.empty()) return given;
  char host[HOST_NAME_MAX + 1] = {};
  gethostname(host, sizeof(host) - 1);
  constexpr size_t kMostHost = 57;  // leaves room for the port
  const std::string listen = absl::GetFlag(FLAGS_listen_http);
  std::string name = absl::StrCat(std::string(host).substr(0, kMostHost), "-",
                                  listen.substr(std::min(listen.rfind(':') + 1, listen.size())));
  std::replace_if(
      name.begin(), name.end(), [](char c) { return !IsGatewayName(std::string(1, c)); }, '-');
  return name.substr(0, 64);
}

// The files that may be open: half for connections, a quarter for the results of jobs, and one for
// requests, which have their uploads, events, an answer, and those of a call to a printer.
void ShareFiles(GatewayOptions& options) {
  constexpr double kGrpcPart = 1.0 / 3, kHttpPart = 1.0 / 6, kJobsPart = 0.25, kRequestsPart = 0.25;
  constexpr int kFilesOfRequest = 4, kFilesOfPrinter = 4;
  const bool printers = !options.printers_file.empty();
  JobLimits& jobs = options.core.jobs;
  WorkLimits& work = options.core.work;
  std::string few;
  const auto fit = [&few](double part, int files_each, int64_t wanted, const char* what) {
    const int most =
        PlacesFor(part, files_each, static_cast<int>(std::min<int64_t>(wanted, INT_MAX)));
    if (most < wanted) absl::StrAppend(&few, few.empty() ? "" : ", ", most, " ", what);
    return std::min<int64_t>(wanted, most);
  };
  // Connections look at the limit again whenever one comes.
  options.connections.files_part = kGrpcPart;
  options.http.files_part = kHttpPart;
  if (!options.listen.empty()) {
    fit(kGrpcPart, Connections::kFilesOfConnection, options.connections.max_connections,
        "connections of gRPC");
  }
  fit(kHttpPart, 1, options.http.max_connections, "connections of HTTP");
  jobs.max_jobs =
      static_cast<uint64_t>(fit(kJobsPart, 1, static_cast<int64_t>(jobs.max_jobs), "jobs"));
  work.max_requests =
      static_cast<int>(fit(kRequestsPart, kFilesOfRequest + (printers ? kFilesOfPrinter : 0),
                           work.max_requests, "requests"));
  if (few.empty()) return;
  options.few_files =
      absl::StrCat("the limit of ", MaxOpenFiles(), " open files leaves room for ", few);
}

int64_t MaxMemory() {
  const int64_t given = absl::GetFlag(FLAGS_max_memory);
  return given > 0 ? given : MemoryLimit() / 4 * 3;
}

}  // namespace

absl::StatusOr<std::string> ReadFlags(const std::vector<std::string>& arguments) {
  return ReadProgramFlags(Program(), arguments);
}

absl::Duration DrainTimeout() { return absl::GetFlag(FLAGS_drain_timeout); }

absl::StatusOr<GatewayOptions> OptionsFromFlags() {
  GatewayOptions options;
  options.listen_http = absl::GetFlag(FLAGS_listen_http);
  options.listen = absl::GetFlag(FLAGS_listen);
  options.metrics_listen = absl::GetFlag(FLAGS_metrics_listen);
  options.insecure = absl::GetFlag(FLAGS_insecure);
  options.tls = {absl::GetFlag(FLAGS_tls_certificate), absl::GetFlag(FLAGS_tls_key),
                 absl::GetFlag(FLAGS_tls_client_ca)};
  options.http = {.max_connections = absl::GetFlag(FLAGS_max_connections),
                  .max_connections_per_address = absl::GetFlag(FLAGS_max_connections_per_address),
                  .max_head_bytes = static_cast<uint32_t>(absl::GetFlag(FLAGS_max_header_bytes)),
                  .head_time = absl::GetFlag(FLAGS_header_timeout),
                  .idle_time = absl::GetFlag(FLAGS_idle_timeout),
                  .min_bytes_per_second = absl::GetFlag(FLAGS_min_upload_rate),
                  .body_time = absl::GetFlag(FLAGS_max_transfer_time)};
  options.connections.max_connections = absl::GetFlag(FLAGS_max_connections);
  options.connections.max_header_bytes = absl::GetFlag(FLAGS_max_header_bytes);
  options.max_memory = MaxMemory();
  CoreOptions& core = options.core;
  core.spool_folder = SpoolFolder();
  core.max_spool_bytes = static_cast<uint64_t>(absl::GetFlag(FLAGS_max_spool_bytes));
  core.max_file_bytes = static_cast<uint64_t>(absl::GetFlag(FLAGS_max_file_bytes));
  core.jobs = {.gateway_name = GatewayName(),
               .ttl = absl::GetFlag(FLAGS_job_ttl),
               .max_jobs = static_cast<uint64_t>(absl::GetFlag(FLAGS_max_jobs))};
  core.max_time = absl::GetFlag(FLAGS_max_time);
  const int workers = absl::GetFlag(FLAGS_workers);
  core.work = {.workers = workers > 0 ? workers : std::max(2, UsableCores()),
               .max_requests = absl::GetFlag(FLAGS_max_requests),
               .max_requests_per_caller = absl::GetFlag(FLAGS_max_requests_per_caller),
               .max_memory_bytes = options.max_memory,
               .caller_weights = *ParseWeights(absl::GetFlag(FLAGS_caller_weights))};
  core.auth.token_file = absl::GetFlag(FLAGS_token_file);
  core.allowed_hosts = absl::GetFlag(FLAGS_allowed_hosts);
  core.auth.allowed_names = absl::GetFlag(FLAGS_allowed_clients);
  core.log_path = absl::GetFlag(FLAGS_log_file);
  const int threads = absl::GetFlag(FLAGS_threads);
  options.threads = threads > 0 ? threads : UsableCores();
  options.printers_file = absl::GetFlag(FLAGS_printers);
  options.upload_deadline = absl::GetFlag(FLAGS_upload_deadline);
  options.upstream.idle_time = absl::GetFlag(FLAGS_upstream_idle_timeout);
  ShareFiles(options);
  if (absl::Status status = SetServers(options); !status.ok()) return status;
  return options;
}

}  // namespace traverse::gateway

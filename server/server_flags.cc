#include "server/server_flags.h"

#include <absl/flags/flag.h>

#include <algorithm>
#include <climits>
#include <cstdint>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "server/net/open_files.h"
#include "server/ops/flag_reader.h"
#include "server/ops/memory.h"

ABSL_FLAG(std::string, listen, "127.0.0.1:50051",
          "HOST:PORT of the service; port 0 takes a free port");
ABSL_FLAG(
    std::string, metrics_listen, "127.0.0.1:9464",
    "HOST:PORT of /metrics, /healthz and /readyz; port 0 takes a free port; empty: no such port");
ABSL_FLAG(int32_t, threads, 0, "Worker threads; 0: one per core");
ABSL_FLAG(
    int32_t, worker_nice, 5,
    "Added to the workers' nice value, so that threads that take calls and send answers go first");
ABSL_FLAG(bool, reflection, true,
          "Offer server reflection, which describes the service to clients");
ABSL_FLAG(absl::Duration, watchdog, absl::Seconds(60),
          "Log a worker that is silent for this long, and fail /healthz; inf: watch nothing");
ABSL_FLAG(absl::Duration, drain_timeout, absl::Seconds(30),
          "How long running jobs may continue after SIGTERM");
ABSL_FLAG(std::string, log_file, "", "File to which the log is appended; empty: stderr");
ABSL_FLAG(int64_t, max_message_bytes, int64_t{64} << 20, "Largest message accepted, in bytes");
ABSL_FLAG(int64_t, max_memory, 0,
          "Most memory of the process in bytes; 0: three quarters of the container's limit, or "
          "else of the machine's memory");
ABSL_FLAG(int64_t, max_memory_per_caller, 0,
          "Most memory for one caller's jobs in bytes; 0: half of that for all jobs");
ABSL_FLAG(int64_t, max_layers_per_message, 100'000, "Most layers in one message");
ABSL_FLAG(int64_t, max_layers_per_job, 0, "Most layers in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_job, 0, "Most points in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_layer, 1'000'000, "Most points in a layer");
ABSL_FLAG(int64_t, max_queued_points, 8'000'000,
          "Most points of all jobs together that wait for a worker");
ABSL_FLAG(int64_t, max_queued_points_per_caller, 4'000'000, "The same for one caller's jobs");
ABSL_FLAG(absl::Duration, max_wait, absl::Milliseconds(250),
          "Refuse jobs expected to exceed both this and --max_slowdown");
ABSL_FLAG(double, max_slowdown, 3,
          "Longest expected time of a job, as a multiple of its time alone; see --max_wait");
ABSL_FLAG(int32_t, max_jobs, 256, "Most jobs in flight");
ABSL_FLAG(int32_t, max_jobs_per_caller, 64, "Most jobs in flight for one caller");
ABSL_FLAG(int64_t, window_layers, 256, "Most layers of a job between solver and reader");
ABSL_FLAG(int64_t, window_points, 500'000, "Most points of a job between solver and reader");

ABSL_FLAG(std::string, config, "",
          "File of flags, lines name=value; flags on the command line override it");
ABSL_FLAG(std::string, flagfile, "", "The same, but read where it stands on the command line");
ABSL_FLAG(bool, insecure, false, "Allow plaintext on addresses that other machines can reach");
ABSL_FLAG(std::string, tls_certificate, "", "Certificate chain in PEM; reloaded when it changes");
ABSL_FLAG(std::string, tls_key, "", "Private key of --tls_certificate in PEM");
ABSL_FLAG(std::string, tls_client_ca, "",
          "Authorities in PEM; every client must show a certificate from one of them");
ABSL_FLAG(std::vector<std::string>, allowed_clients, {},
          "Identities in client certificates that may call; empty: all from --tls_client_ca");
ABSL_FLAG(std::string, token_file, "",
          "File of lines NAME SHA256-OF-TOKEN; callers then need a bearer token. Reloaded when it "
          "changes");
ABSL_FLAG(
    std::vector<std::string>, caller_weights, {},
    "CALLER=WEIGHT,...: shares of the workers' time, by the names of --token_file or of client "
    "certificates, or by address; others have 1");
ABSL_FLAG(int32_t, max_streams_per_connection, 100, "Most calls at a time on one connection");
ABSL_FLAG(int32_t, max_connections, 0,
          "Most connections; 0: as many as the limit of open files allows");
ABSL_FLAG(int32_t, max_header_bytes, 16384, "Largest metadata of a call, in bytes");
ABSL_FLAG(absl::Duration, keepalive_time, absl::Seconds(30),
          "Idle time after which the server pings a connection's peer");
ABSL_FLAG(absl::Duration, keepalive_timeout, absl::Seconds(10),
          "Time for the answer to that ping, then the connection and its jobs end");
ABSL_FLAG(absl::Duration, idle_timeout, absl::Minutes(5),
          "End a job whose caller neither sends nor reads anything for this long");
ABSL_FLAG(absl::Duration, max_connection_age, absl::InfiniteDuration(),
          "Age at which the server asks clients to reconnect, which spreads them over new servers");

namespace traverse {
namespace {

// Flags that are numbers with a least value.
absl::Status CheckRanges() {
  const absl::Status numbers = CheckLeastValues({
      {"threads", absl::GetFlag(FLAGS_threads), 0},
      {"worker_nice", absl::GetFlag(FLAGS_worker_nice), 0},
      {"max_message_bytes", absl::GetFlag(FLAGS_max_message_bytes), 1024},
      {"max_memory", absl::GetFlag(FLAGS_max_memory), 0},
      {"max_memory_per_caller", absl::GetFlag(FLAGS_max_memory_per_caller), 0},
      {"max_connections", absl::GetFlag(FLAGS_max_connections), 0},
      {"max_layers_per_message", absl::GetFlag(FLAGS_max_layers_per_message), 1},
      {"max_layers_per_job", absl::GetFlag(FLAGS_max_layers_per_job), 0},
      {"max_points_per_job", absl::GetFlag(FLAGS_max_points_per_job), 0},
      {"max_points_per_layer", absl::GetFlag(FLAGS_max_points_per_layer), 1},
      {"max_queued_points", absl::GetFlag(FLAGS_max_queued_points), 1},
      {"max_queued_points_per_caller", absl::GetFlag(FLAGS_max_queued_points_per_caller), 1},
      {"max_jobs", absl::GetFlag(FLAGS_max_jobs), 1},
      {"max_jobs_per_caller", absl::GetFlag(FLAGS_max_jobs_per_caller), 1},
      {"window_layers", absl::GetFlag(FLAGS_window_layers), 2},
      {"window_points", absl::GetFlag(FLAGS_window_points), 1},
      {"max_streams_per_connection", absl::GetFlag(FLAGS_max_streams_per_connection), 1},
      {"max_header_bytes", absl::GetFlag(FLAGS_max_header_bytes), 1024},
      {"keepalive_time", absl::ToInt64Milliseconds(absl::GetFlag(FLAGS_keepalive_time)), 1000},
      {"idle_timeout", absl::ToInt64Milliseconds(absl::GetFlag(FLAGS_idle_timeout)), 100},
      {"keepalive_timeout", absl::ToInt64Milliseconds(absl::GetFlag(FLAGS_keepalive_timeout)), 100},
  });
  if (!numbers.ok()) return numbers;
  if (absl::GetFlag(FLAGS_watchdog) <= absl::ZeroDuration())
    return BadFlag("watchdog", "not above 0");
  if (absl::GetFlag(FLAGS_max_wait) <= absl::ZeroDuration())
    return BadFlag("max_wait", "not above 0");
  if (!(absl::GetFlag(FLAGS_max_slowdown) >= 1)) return BadFlag("max_slowdown", "below 1");
  if (const auto weights = ParseWeights(absl::GetFlag(FLAGS_caller_weights)); !weights.ok()) {
    return weights.status();
  }
  return CheckDaemonFlags(absl::GetFlag(FLAGS_drain_timeout), absl::GetFlag(FLAGS_allowed_clients),
                          absl::GetFlag(FLAGS_tls_client_ca));
}

FlagProgram Program() {
  return {"traverse-server", "server/server_flags.cc",
          "Finds short routes through the paths of a 3D print's layers; see server/README.md.\n"
          "\nusage: traverse-server [--listen=HOST:PORT] [--metrics_listen=HOST:PORT] "
          "[--name=value ...]\n"
          "       traverse-server --config=FILE\n"
          "       traverse-server --version | --help\n\n",
          CheckRanges};
}

}  // namespace

absl::StatusOr<std::string> ReadFlags(const std::vector<std::string>& arguments) {
  return ReadProgramFlags(Program(), arguments);
}

absl::Duration DrainTimeout() { return absl::GetFlag(FLAGS_drain_timeout); }

namespace {

// What jobs may have of the memory: the rest is for connections, threads, and the memory that the
// allocator cannot give back.
constexpr double kJobsShare = 0.75;

void SetMemory(ServerOptions& options) {
  const int64_t given = absl::GetFlag(FLAGS_max_memory);
  options.max_memory = given > 0 ? given : MemoryLimit() / 4 * 3;
  AdmissionLimits& limits = options.service.admission;
  limits.max_bytes = static_cast<int64_t>(kJobsShare * static_cast<double>(options.max_memory));
  options.service.limits.max_bytes_per_message = limits.max_bytes;
  const int64_t per_caller = absl::GetFlag(FLAGS_max_memory_per_caller);
  limits.max_bytes_per_caller = per_caller > 0 ? per_caller : limits.max_bytes / 2;
}

// As many as it serves well; the limit of open files may allow fewer, see FilesFor.
int MaxConnections() {
  constexpr int kMost = 16'384;
  const int given = absl::GetFlag(FLAGS_max_connections);
  return given > 0 ? given : kMost;
}

}  // namespace

std::string FewFiles() {
  const int given = absl::GetFlag(FLAGS_max_connections);
  const int most = PlacesFor(/*part=*/1, Connections::kFilesOfConnection, MaxConnections());
  if (given <= most) return "";
  return absl::StrCat("the limit of ", MaxOpenFiles(), " open files leaves room for ", most,
                      " connections, not ", given);
}

ServerOptions OptionsFromFlags() {
  ServerOptions options;
  options.listen = absl::GetFlag(FLAGS_listen);
  options.metrics_listen = absl::GetFlag(FLAGS_metrics_listen);
  options.reflection = absl::GetFlag(FLAGS_reflection);
  options.insecure = absl::GetFlag(FLAGS_insecure);
  options.tls = {absl::GetFlag(FLAGS_tls_certificate), absl::GetFlag(FLAGS_tls_key),
                 absl::GetFlag(FLAGS_tls_client_ca)};
  options.connections = {.max_streams = absl::GetFlag(FLAGS_max_streams_per_connection),
                         .max_header_bytes = absl::GetFlag(FLAGS_max_header_bytes),
                         .keepalive_time = absl::GetFlag(FLAGS_keepalive_time),
                         .keepalive_timeout = absl::GetFlag(FLAGS_keepalive_timeout),
                         .max_age = absl::GetFlag(FLAGS_max_connection_age)};
  options.connections.max_connections = MaxConnections();
  SetMemory(options);
  ServiceOptions& service = options.service;
  const int threads = absl::GetFlag(FLAGS_threads);
  service.threads = threads > 0 ? threads : UsableCores();
  service.caller_weights = *ParseWeights(absl::GetFlag(FLAGS_caller_weights));
  service.worker_nice = absl::GetFlag(FLAGS_worker_nice);
  service.watchdog = absl::GetFlag(FLAGS_watchdog);
  service.log_path = absl::GetFlag(FLAGS_log_file);
  service.limits.max_message_bytes = absl::GetFlag(FLAGS_max_message_bytes);
  service.limits.max_layers_per_message = absl::GetFlag(FLAGS_max_layers_per_message);
  service.limits.max_layers_per_job = absl::GetFlag(FLAGS_max_layers_per_job);
  service.limits.max_points_per_job = absl::GetFlag(FLAGS_max_points_per_job);
  service.limits.max_points_per_layer = absl::GetFlag(FLAGS_max_points_per_layer);
  service.limits.idle_timeout = absl::GetFlag(FLAGS_idle_timeout);
  service.limits.window.layers = absl::GetFlag(FLAGS_window_layers);
  service.limits.window.points = absl::GetFlag(FLAGS_window_points);
  service.admission.max_queued_points = absl::GetFlag(FLAGS_max_queued_points);
  service.admission.max_queued_points_per_caller =
      absl::GetFlag(FLAGS_max_queued_points_per_caller);
  service.admission.max_wait = absl::GetFlag(FLAGS_max_wait);
  service.admission.max_slowdown = absl::GetFlag(FLAGS_max_slowdown);
  service.admission.max_jobs = absl::GetFlag(FLAGS_max_jobs);
  service.admission.max_jobs_per_caller = absl::GetFlag(FLAGS_max_jobs_per_caller);
  service.auth.token_file = absl::GetFlag(FLAGS_token_file);
  service.auth.allowed_names = absl::GetFlag(FLAGS_allowed_clients);
  return options;
}

}  // namespace traverse

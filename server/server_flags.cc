#include "server/server_flags.h"

#include <absl/flags/flag.h>
#include <absl/flags/parse.h>
#include <absl/flags/reflection.h>
#include <absl/flags/usage.h>
#include <absl/flags/usage_config.h>

#include <climits>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <string>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/version.h"

ABSL_FLAG(std::string, listen, "127.0.0.1:50051", "HOST:PORT of the service; port 0: a free one");
ABSL_FLAG(std::string, metrics_listen, "127.0.0.1:9464",
          "HOST:PORT of /metrics, /healthz and /readyz; port 0: a free one; empty: none");
ABSL_FLAG(int32_t, threads, 0, "Worker threads; 0: one for each core");
ABSL_FLAG(bool, reflection, true, "Whether clients may ask for the service's description");
ABSL_FLAG(absl::Duration, drain_timeout, absl::Seconds(30),
          "How long jobs under way may go on after SIGTERM");
ABSL_FLAG(std::string, log_file, "", "File to append the log to; empty: stderr");
ABSL_FLAG(int64_t, max_message_bytes, int64_t{64} << 20, "Largest message accepted");
ABSL_FLAG(int64_t, max_layers_per_message, 100'000, "Most layers in one message");
ABSL_FLAG(int64_t, max_layers_per_job, 0, "Most layers in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_job, 0, "Most points in a job; 0: no limit");
ABSL_FLAG(int64_t, max_points_per_layer, 1'000'000, "Most points in a layer");
ABSL_FLAG(int64_t, max_queued_points, 8'000'000,
          "Most points of all jobs together that wait to be solved");
ABSL_FLAG(int64_t, max_queued_points_per_caller, 4'000'000, "The same of one caller's jobs");
ABSL_FLAG(absl::Duration, max_wait, absl::Milliseconds(250),
          "A job is refused that would take longer than this and than --max_slowdown allows");
ABSL_FLAG(double, max_slowdown, 3, "How many times as long as alone a job may take");
ABSL_FLAG(int32_t, max_jobs, 256, "Most jobs in flight");
ABSL_FLAG(int32_t, max_jobs_per_caller, 64, "Most jobs in flight of one caller");
ABSL_FLAG(int64_t, window_layers, 256, "Most layers of a job between solver and reader");
ABSL_FLAG(int64_t, window_points, 500'000, "Most points of a job between solver and reader");

ABSL_FLAG(std::string, config, "",
          "File of lines name=value that set flags; the command line wins");
ABSL_FLAG(bool, insecure, false, "Allow plaintext on addresses that other machines can reach");
ABSL_FLAG(std::string, tls_certificate, "", "Certificate chain in PEM; reloaded when it changes");
ABSL_FLAG(std::string, tls_key, "", "Private key of --tls_certificate in PEM");
ABSL_FLAG(std::string, tls_client_ca, "",
          "Authorities in PEM one of which every client's certificate has to be from");
ABSL_FLAG(std::vector<std::string>, allowed_clients, {},
          "Identities of client certificates that may call; empty: all of --tls_client_ca");
ABSL_FLAG(std::string, token_file, "",
          "File of lines NAME SHA256-OF-TOKEN; callers then need a bearer token. Reloaded");
ABSL_FLAG(int32_t, max_streams_per_connection, 100, "Most calls at a time on one connection");
ABSL_FLAG(int32_t, max_header_bytes, 16384, "Largest metadata of a call");
ABSL_FLAG(absl::Duration, keepalive_time, absl::Seconds(30),
          "Idle time of a connection after which the peer is asked whether it lives");
ABSL_FLAG(absl::Duration, keepalive_timeout, absl::Seconds(10),
          "Time for that answer, then the connection and its jobs end");
ABSL_FLAG(absl::Duration, idle_timeout, absl::Minutes(5),
          "A job is given up whose caller neither sends nor reads anything for so long");
ABSL_FLAG(absl::Duration, max_connection_age, absl::InfiniteDuration(),
          "Age at which clients are asked to connect anew, to spread them over new servers");

namespace traverse {
namespace {

absl::Status BadFlag(const std::string& name, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat("--", name, ": ", what));
}

// Flags that are numbers with a least value.
absl::Status CheckRanges() {
  const struct {
    const char* name;
    int64_t value;
    int64_t least;
  } numbers[] = {
      {"threads", absl::GetFlag(FLAGS_threads), 0},
      {"max_message_bytes", absl::GetFlag(FLAGS_max_message_bytes), 1024},
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
  };
  for (const auto& number : numbers) {
    if (number.value < number.least) {
      return BadFlag(number.name, absl::StrCat(number.value, " is below ", number.least));
    }
  }
  if (absl::GetFlag(FLAGS_drain_timeout) < absl::ZeroDuration()) {
    return BadFlag("drain_timeout", "below 0");
  }
  if (absl::GetFlag(FLAGS_max_wait) <= absl::ZeroDuration())
    return BadFlag("max_wait", "not above 0");
  if (!(absl::GetFlag(FLAGS_max_slowdown) >= 1)) return BadFlag("max_slowdown", "below 1");
  if (!absl::GetFlag(FLAGS_allowed_clients).empty() && absl::GetFlag(FLAGS_tls_client_ca).empty()) {
    return BadFlag("allowed_clients", "needs --tls_client_ca");
  }
  return absl::OkStatus();
}

void DescribeFlags() {
  absl::SetProgramUsageMessage(
      "Finds short routes through the paths of a 3D print's layers; see server/README.md.\n"
      "Usage: traverse-server [--listen=HOST:PORT] [--metrics_listen=HOST:PORT] [--threads=N] ...");
  absl::FlagsUsageConfig config;
  config.version_string = [] { return absl::StrCat("traverse-server ", kVersion, "\n"); };
  config.contains_helpshort_flags = [](absl::string_view file) {
    return absl::StrContains(file, "server/server_flags.cc");
  };
  config.contains_help_flags = config.contains_helpshort_flags;
  absl::SetFlagsUsageConfig(config);
}

// The file of the last --config on the command line, or empty.
std::string ConfigPath(int argc, char** argv) {
  std::string path;
  for (int i = 1; i < argc; ++i) {
    std::string argument = argv[i];
    if (absl::StartsWith(argument, "--")) argument.erase(0, 1);
    if (absl::StartsWith(argument, "-config=")) path = argument.substr(std::strlen("-config="));
    if (argument == "-config" && i + 1 < argc) path = argv[i + 1];
  }
  return path;
}

}  // namespace

absl::Status ReadConfigFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) return absl::InvalidArgumentError(absl::StrCat(path, ": cannot be read"));
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string text(absl::StripAsciiWhitespace(line));
    if (text.empty() || text[0] == '#') continue;
    const std::string place = absl::StrCat(path, ":", number, ": ");
    const size_t equals = text.find('=');
    if (equals == std::string::npos) {
      return absl::InvalidArgumentError(place + "not of the form name=value");
    }
    std::string name(absl::StripAsciiWhitespace(text.substr(0, equals)));
    name.erase(0, name.find_first_not_of('-'));
    const std::string value(absl::StripAsciiWhitespace(text.substr(equals + 1)));
    absl::CommandLineFlag* flag = absl::FindCommandLineFlag(name);
    if (flag == nullptr || name == "config") {
      return absl::InvalidArgumentError(absl::StrCat(place, "no flag \"", name, "\""));
    }
    std::string error;
    if (!flag->ParseFrom(value, &error)) {
      return absl::InvalidArgumentError(absl::StrCat(place, name, ": ", value, " is no value of it",
                                                     error.empty() ? "" : ": ", error));
    }
  }
  return absl::OkStatus();
}

absl::Status ReadFlags(int argc, char** argv) {
  DescribeFlags();
  if (const std::string path = ConfigPath(argc, argv); !path.empty()) {
    if (absl::Status status = ReadConfigFile(path); !status.ok()) return status;
  }
  const std::vector<char*> arguments = absl::ParseCommandLine(argc, argv);
  if (arguments.size() > 1) {
    return absl::InvalidArgumentError(absl::StrCat("unexpected argument ", arguments[1]));
  }
  return CheckRanges();
}

absl::Duration DrainTimeout() { return absl::GetFlag(FLAGS_drain_timeout); }

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
  ServiceOptions& service = options.service;
  const int threads = absl::GetFlag(FLAGS_threads);
  service.threads = threads > 0 ? threads : UsableCores();
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

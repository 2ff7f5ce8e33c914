#include "server/server_flags.h"

#include <absl/flags/flag.h>
#include <absl/flags/reflection.h>

#include <climits>
#include <cstdint>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "server/version.h"

ABSL_FLAG(std::string, listen, "127.0.0.1:50051", "HOST:PORT of the service; port 0: a free one");
ABSL_FLAG(std::string, metrics_listen, "127.0.0.1:9464",
          "HOST:PORT of /metrics, /healthz and /readyz; port 0: a free one; empty: none");
ABSL_FLAG(int32_t, threads, 0, "Worker threads; 0: one for each core");
ABSL_FLAG(int32_t, worker_nice, 5,
          "How much nicer the workers are than the threads that take calls in and send answers");
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
ABSL_FLAG(std::string, flagfile, "", "The same, but read at its place on the command line");
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
      {"worker_nice", absl::GetFlag(FLAGS_worker_nice), 0},
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

// The flag of this name, or null. Only those above: libraries bring some too.
absl::CommandLineFlag* FindFlag(const std::string& name) {
  absl::CommandLineFlag* flag = absl::FindCommandLineFlag(name);
  return flag != nullptr && absl::EndsWith(flag->Filename(), "server/server_flags.cc") ? flag
                                                                                       : nullptr;
}

// A flag with its value as written, and the line if it stands in a file.
struct GivenFlag {
  absl::CommandLineFlag* flag;
  std::string value;
  std::string place = {};
};

bool IsFile(const GivenFlag& flag) {
  return flag.flag->Name() == "config" || flag.flag->Name() == "flagfile";
}

// The flag that `argument` states: `--name=value`, `--name value` with `next`, if that is not null;
// for a bool `--name` and `--noname` too. Takes `next` by setting it to null.
absl::StatusOr<GivenFlag> ReadFlag(const std::string& argument, const std::string*& next) {
  const size_t begin = argument.find_first_not_of('-');
  if (begin == 0 || begin > 2) {
    return absl::InvalidArgumentError(absl::StrCat("unexpected argument \"", argument, "\""));
  }
  const size_t equals = argument.find('=');
  const std::string name = argument.substr(begin, equals - begin);
  absl::CommandLineFlag* flag = FindFlag(name);
  if (flag != nullptr && equals != std::string::npos) {
    return GivenFlag{flag, argument.substr(equals + 1)};
  }
  if (flag != nullptr && flag->IsOfType<bool>()) return GivenFlag{flag, "true"};
  if (flag != nullptr) {
    if (next == nullptr) return BadFlag(name, "the value is missing");
    return GivenFlag{flag, *std::exchange(next, nullptr)};
  }
  if (absl::StartsWith(name, "no") && equals == std::string::npos) {
    flag = FindFlag(name.substr(2));
    if (flag != nullptr && flag->IsOfType<bool>()) return GivenFlag{flag, "false"};
  }
  return absl::InvalidArgumentError(
      absl::StrCat("unknown flag --", name, "; --help lists those there are"));
}

// The flags in the lines `name=value` or `--name=value` of a file; `#` begins a comment line.
absl::StatusOr<std::vector<GivenFlag>> FlagsOfFile(const std::string& path) {
  std::ifstream file(path);
  if (!file) return absl::InvalidArgumentError(absl::StrCat(path, ": cannot be read"));
  std::vector<GivenFlag> given;
  int number = 0;
  for (std::string line; std::getline(file, line);) {
    ++number;
    const std::string text(absl::StripAsciiWhitespace(line));
    if (text.empty() || text[0] == '#') continue;
    const std::string place = absl::StrCat(path, ":", number, ": ");
    const size_t equals = text.find('=');
    std::string argument = text;
    if (equals != std::string::npos) {
      const std::string name = text.substr(0, equals), value = text.substr(equals + 1);
      argument = absl::StrCat(text[0] == '-' ? "" : "--", absl::StripTrailingAsciiWhitespace(name),
                              "=", absl::StripLeadingAsciiWhitespace(value));
    } else if (text[0] != '-') {
      return absl::InvalidArgumentError(place + "not of the form name=value");
    }
    const std::string* none = nullptr;
    absl::StatusOr<GivenFlag> flag = ReadFlag(argument, none);
    if (!flag.ok()) {
      return absl::InvalidArgumentError(absl::StrCat(place, flag.status().message()));
    }
    if (IsFile(*flag)) {
      return absl::InvalidArgumentError(absl::StrCat(place, "a file within a file"));
    }
    flag->place = place;
    given.push_back(*std::move(flag));
  }
  return given;
}

// All that the command line and the files on it state, in the order in which it counts.
absl::StatusOr<std::vector<GivenFlag>> GivenFlags(const std::vector<std::string>& arguments) {
  std::vector<GivenFlag> config, given;
  for (size_t i = 0; i < arguments.size(); ++i) {
    const std::string* next = i + 1 < arguments.size() ? &arguments[i + 1] : nullptr;
    const bool has_next = next != nullptr;
    absl::StatusOr<GivenFlag> flag = ReadFlag(arguments[i], next);
    if (!flag.ok()) return flag.status();
    if (has_next && next == nullptr) ++i;
    if (IsFile(*flag) && !flag->value.empty()) {
      absl::StatusOr<std::vector<GivenFlag>> in_file = FlagsOfFile(flag->value);
      if (!in_file.ok()) return in_file.status();
      if (flag->flag->Name() == "config") {
        config = *std::move(in_file);
      } else {
        given.insert(given.end(), in_file->begin(), in_file->end());
      }
    }
    given.push_back(*std::move(flag));
  }
  config.insert(config.end(), given.begin(), given.end());
  return config;
}

std::string Help() {
  std::string text =
      "Finds short routes through the paths of a 3D print's layers; see server/README.md.\n"
      "\nusage: traverse-server [--listen=HOST:PORT] [--metrics_listen=HOST:PORT] [--name=value "
      "...]\n"
      "       traverse-server --config=FILE\n"
      "       traverse-server --version | --help\n\n";
  std::map<std::string, const absl::CommandLineFlag*> flags;
  for (const auto& [name, flag] : absl::GetAllFlags()) {
    const std::string key(name.data(), name.size());
    if (FindFlag(key) != nullptr) flags.emplace(key, flag);
  }
  for (const auto& [name, flag] : flags) {
    absl::StrAppend(&text, "  --", name, "=", flag->DefaultValue(), "\n      ", flag->Help(), "\n");
  }
  return text;
}

}  // namespace

absl::StatusOr<std::string> ReadFlags(const std::vector<std::string>& arguments) {
  for (const std::string& argument : arguments) {
    if (argument == "--help" || argument == "-h") return Help();
    if (argument == "--version") return absl::StrCat("traverse-server ", kVersion, "\n");
  }
  const absl::StatusOr<std::vector<GivenFlag>> given = GivenFlags(arguments);
  if (!given.ok()) return given.status();
  for (const GivenFlag& one : *given) {
    std::string error;  // says no more than that
    if (one.flag->ParseFrom(one.value, &error)) continue;
    return absl::InvalidArgumentError(
        absl::StrCat(one.place, "\"", one.value, "\" is no value of --", one.flag->Name()));
  }
  if (absl::Status status = CheckRanges(); !status.ok()) return status;
  return std::string();
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
  service.worker_nice = absl::GetFlag(FLAGS_worker_nice);
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

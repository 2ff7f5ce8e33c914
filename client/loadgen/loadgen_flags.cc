#include "client/loadgen/loadgen_flags.h"

#include <optional>
#include <utility>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/api/channel.h"
#include "client/cli/flags/connection_flags.h"
#include "client/cli/flags/strategy_spec.h"
#include "client/cli/help.h"
#include "client/input/input_job.h"

namespace traverse::loadgen {
namespace {

// A higher rate would fill the generator's memory before the server's queue.
constexpr double kMaxRate = 1e5;
constexpr uint64_t kMaxInFlight = 100'000;
constexpr uint64_t kMaxConnections = 1000;
constexpr uint64_t kMaxIslands = 10'000;

absl::Status Fault(std::string message) { return absl::InvalidArgumentError(std::move(message)); }

// Sets `value` from an integer flag, if it is given.
template <typename T>
absl::Status ReadInteger(const cli::Flags& flags, const char* name, uint64_t least, uint64_t most,
                         T& value) {
  const auto read = flags.Integer(name, least, most);
  if (read.ok() && *read) value = static_cast<T>(**read);
  return read.status();
}

absl::Status ReadDuration(const cli::Flags& flags, const char* name, absl::Duration& value) {
  const auto read = flags.Duration(name);
  if (read.ok() && *read) value = **read;
  return read.status();
}

absl::Status ReadLoad(const cli::Flags& flags, LoadOptions& load) {
  if (flags.Has("rate") == flags.Has("in_flight")) {
    return Fault("give --rate=JOBS_PER_SECOND, or --in_flight=N for a closed loop");
  }
  const auto rate = flags.Number("rate", 1e-3, kMaxRate);
  if (!rate.ok()) return rate.status();
  load.rate = rate->value_or(0);
  if (flags.Text("arrivals") == "poisson") load.arrivals = Arrivals::kPoisson;
  absl::Status status = ReadInteger(flags, "in_flight", 1, kMaxInFlight, load.in_flight);
  if (status.ok()) {
    status = ReadInteger(flags, "max_in_flight", 1, kMaxInFlight, load.max_in_flight);
  }
  if (status.ok()) status = ReadInteger(flags, "seed", 0, UINT64_MAX, load.seed);
  if (status.ok()) status = ReadDuration(flags, "duration", load.duration);
  if (status.ok()) status = ReadDuration(flags, "warm_up", load.warm_up);
  if (status.ok()) status = ReadDuration(flags, "deadline", load.deadline);
  return status;
}

absl::Status ReadJob(const cli::Flags& flags, LoadgenFlags& out) {
  out.strategy = flags.Text("strategy", "ni2opt");
  const auto specs = cli::ParseStrategySpecs(out.strategy);
  if (!specs.ok()) return specs.status();
  if (specs->size() > 1) return Fault("--strategy takes one strategy");
  *out.job.mutable_strategy() = specs->front().strategy;
  out.job.set_job_id("loadgen");
  const auto mix = ParseMix(flags.Text("mix", "1"));
  if (!mix.ok()) return Fault(absl::StrFormat("--mix: %s", std::string(mix.status().message())));
  out.mix = *mix;
  out.input = flags.Text("input");
  if (flags.Has("input") && flags.Has("islands")) {
    return Fault("--islands sets generated layers and cannot go with --input");
  }
  return ReadInteger(flags, "islands", 1, kMaxIslands, out.islands);
}

}  // namespace

const std::vector<cli::Flag>& LoadgenFlagTable() {
  static const std::vector<cli::Flag> table = [] {
    std::vector<cli::Flag> rows = {
        {"target", "HOST:PORT,...", "the servers to load"},
        {"rate", "N", "jobs a second, sent at times fixed in advance"},
        {"in_flight", "N", "instead: keep this many in flight (closed loop)"},
        {"duration", "TIME", "how long to send and count jobs (default 10s)"},
        {"warm_up", "TIME", "before that: send, but do not count (default 1s)"},
        {"mix", "LAYERS:WEIGHT,...", "sizes of jobs (default 1), as 1:70,10:25,400:5"},
        {"strategy", "NAME", "default ni2opt; or NAME:OPTION=VALUE:..."},
        {"input", "FILE", "take layers from this file (default: generated)"},
        {"islands", "N", "per generated layer, 6 paths each (default 10)"},
        {"arrivals", "HOW", "even (default) or poisson", {"even", "poisson"}},
        {"deadline", "TIME", "deadline of each job (default 30s)"},
        {"connections", "N", "connections that jobs share in turn (default 4)"},
        {"max_in_flight", "N", "most jobs in flight; more are not sent (10000)"},
        {"seed", "N", "seed of sizes and arrivals (default 1)"},
        {"json", "FILE", "write the figures; - is standard output"},
    };
    return cli::Joined(std::move(rows), cli::OfTopic("Connection", cli::ConnectionFlagTable()));
  }();
  return table;
}

std::string LoadgenHelp() {
  return "Sends jobs to servers and prints their latencies, counted from when each job\n"
         "was due: a slow server neither delays nor reduces the load.\n\n"
         "usage: traverse-loadgen --target=HOST:PORT --rate=N [flags]\n\n" +
         cli::FlagHelp(LoadgenFlagTable()) +
         "\nexample: traverse-loadgen --target=127.0.0.1:50051 --rate=200 "
         "--mix=1:8,10:2\n";
}

absl::StatusOr<LoadgenFlags> ParseLoadgenFlags(const std::vector<std::string>& arguments) {
  const absl::StatusOr<cli::Flags> flags = cli::Flags::Parse(LoadgenFlagTable(), arguments);
  if (!flags.ok()) return flags.status();
  if (!flags->operands().empty()) {
    return Fault(absl::StrFormat("unexpected argument \"%s\"", flags->operands().front()));
  }
  if (!flags->Has("target")) return Fault("--target=HOST:PORT is missing");
  const auto addresses = ParseAddresses(flags->Text("target"));
  if (!addresses.ok()) {
    return Fault(absl::StrFormat("--target: %s", std::string(addresses.status().message())));
  }
  LoadgenFlags out;
  out.target = *addresses;
  out.connections = 4;
  out.json = flags->Text("json");
  absl::Status status = ReadLoad(*flags, out.load);
  if (status.ok()) status = ReadJob(*flags, out);
  if (status.ok()) status = ReadInteger(*flags, "connections", 1, kMaxConnections, out.connections);
  if (!status.ok()) return status;
  absl::StatusOr<cli::Connection> connection = cli::ParseConnectionFlags(*flags, out.target);
  if (!connection.ok()) return connection.status();
  out.connect = connection->options;
  out.connect.own_connection = true;
  out.load.token = std::move(connection->token);
  return out;
}

}  // namespace traverse::loadgen

#include "client/gateway/octoprint/printers_config.h"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "client/files/json.h"
#include "client/files/read_file.h"
#include "client/gateway/api/machine_text.h"

namespace traverse::gateway {
namespace {

constexpr size_t kMaxConfigBytes = size_t{1} << 20;

absl::Status Fault(const std::string& place, const std::string& what) {
  return absl::InvalidArgumentError(absl::StrCat(place, ": ", what));
}

bool IsName(const std::string& name) {
  return !name.empty() && name.size() <= 64 && name[0] != '.' &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return absl::ascii_isalnum(static_cast<unsigned char>(c)) || c == '.' || c == '_' ||
                  c == '-';
         });
}

absl::Status SetKind(const std::string& text, Printer& printer) {
  if (text == "octoprint") {
    printer.kind = PrinterKind::kOctoPrint;
  } else if (text == "moonraker") {
    printer.kind = PrinterKind::kMoonraker;
  } else if (text == "prusalink") {
    printer.kind = PrinterKind::kPrusaLink;
  } else {
    return absl::InvalidArgumentError("not octoprint, moonraker or prusalink");
  }
  return absl::OkStatus();
}

absl::Status SetUrl(std::string url, Printer& printer) {
  while (absl::EndsWith(url, "/")) url.pop_back();
  const bool known = absl::StartsWith(url, "http://") || absl::StartsWith(url, "https://");
  const bool plain = std::all_of(url.begin(), url.end(), [](char c) {
    return absl::ascii_isgraph(static_cast<unsigned char>(c));
  });
  if (!known || !plain || url.find_first_of("?#@") != std::string::npos) {
    return absl::InvalidArgumentError("not a URL of http or https");
  }
  printer.url = std::move(url);
  return absl::OkStatus();
}

absl::Status SetKey(const std::string& path, Printer& printer) {
  absl::StatusOr<std::string> text = ReadWholeFile(path, kMaxConfigBytes);
  if (!text.ok()) return absl::UnavailableError(text.status().message());
  printer.api_key = std::string(absl::StripAsciiWhitespace(text->substr(0, text->find('\n'))));
  if (printer.api_key.empty()) return absl::InvalidArgumentError("the file contains no key");
  return absl::OkStatus();
}

absl::Status SetMachine(const std::string& path, Printer& printer) {
  const absl::StatusOr<std::string> text = ReadWholeFile(path, kMostMachineBytes);
  if (!text.ok()) return absl::UnavailableError(text.status().message());
  absl::StatusOr<gcode::MachineLimits> machine = ParseMachine(*text, path);
  if (!machine.ok()) return machine.status();
  printer.machine = *std::move(machine);
  return absl::OkStatus();
}

absl::Status SetField(const std::string& key, const std::string& text, Printer& printer) {
  if (key == "name") {
    printer.name = text;
    return IsName(text) ? absl::OkStatus()
                        : absl::InvalidArgumentError("not of letters, digits, '.', '_' and '-'");
  }
  if (key == "kind") return SetKind(text, printer);
  if (key == "url") return SetUrl(text, printer);
  if (key == "api_key_file") return SetKey(text, printer);
  if (key == "machine") return SetMachine(text, printer);
  if (key == "tls_ca") {
    printer.tls_ca = text;
  } else if (key == "storage") {
    printer.storage = text;
    if (!IsName(text)) return absl::InvalidArgumentError("not the name of a storage");
  } else if (key == "policy") {
    const auto policy = gcode::PolicyOfName(text);
    if (!policy) return absl::InvalidArgumentError("not safe, balanced, free or fast");
    printer.policy = *policy;
  } else if (key == "on_failure") {
    printer.refuse_on_failure = text == "refuse";
    if (text != "refuse" && text != "original") {
      return absl::InvalidArgumentError("not original or refuse");
    }
  } else {
    return absl::InvalidArgumentError("unknown field");
  }
  return absl::OkStatus();
}

absl::StatusOr<Printer> ParsePrinter(const Json& json, const std::string& place) {
  if (!json.is_object()) return Fault(place, "not an object");
  Printer printer;
  for (const auto& [key, value] : json.members()) {
    const std::string field = absl::StrCat(place, ".", key);
    if (value.Text() == nullptr) return Fault(field, "not a string");
    if (absl::Status status = SetField(key, *value.Text(), printer); !status.ok()) {
      return absl::Status(status.code(), absl::StrCat(field, ": ", status.message()));
    }
  }
  if (printer.name.empty()) return Fault(place, "has no name");
  if (printer.url.empty()) return Fault(place, "has no url");
  return printer;
}

}  // namespace

const Printer* PrintersConfig::Find(const std::string& name) const {
  for (const Printer& printer : printers) {
    if (printer.name == name) return &printer;
  }
  return nullptr;
}

absl::StatusOr<PrintersConfig> ParsePrinters(const std::string& json) {
  const std::optional<Json> document = ParseJson(json);
  if (!document || !document->is_object()) {
    return absl::InvalidArgumentError("not an object of JSON");
  }
  PrintersConfig config;
  for (const auto& [key, value] : document->members()) {
    if (key == "default" && value.Text() != nullptr) {
      config.default_name = *value.Text();
    } else if (key != "printers" || !value.is_array()) {
      return Fault(key, "unknown field, or of the wrong type");
    }
  }
  const Json* const printers = document->Find("printers");
  if (printers == nullptr) return absl::InvalidArgumentError("has no printers");
  for (size_t i = 0; i < printers->items().size(); ++i) {
    const std::string place = absl::StrCat("printers[", i, "]");
    absl::StatusOr<Printer> printer = ParsePrinter(printers->items()[i], place);
    if (!printer.ok()) return printer.status();
    if (config.Find(printer->name) != nullptr) {
      return Fault(place + ".name", absl::StrCat("there is another \"", printer->name, "\""));
    }
    config.printers.push_back(*std::move(printer));
  }
  if (config.printers.empty()) return Fault("printers", "is empty");
  if (config.default_name.empty() && config.printers.size() == 1) {
    config.default_name = config.printers[0].name;
  }
  if (!config.default_name.empty() && config.Find(config.default_name) == nullptr) {
    return Fault("default", absl::StrCat("no printer is named \"", config.default_name, "\""));
  }
  return config;
}

absl::StatusOr<PrintersConfig> ReadPrinters(const std::string& path) {
  absl::StatusOr<std::string> json = ReadWholeFile(path, kMaxConfigBytes);
  if (!json.ok()) return absl::UnavailableError(json.status().message());
  absl::StatusOr<PrintersConfig> config = ParsePrinters(*json);
  if (config.ok()) return config;
  return absl::Status(config.status().code(), absl::StrCat(path, ": ", config.status().message()));
}

}  // namespace traverse::gateway

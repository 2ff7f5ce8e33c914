#include "client/cli/gcode_output.h"

#include <fstream>
#include <limits>
#include <optional>
#include <utility>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/files/decompress.h"
#include "client/files/read_file.h"
#include "client/files/write_file.h"

namespace traverse::cli {
namespace {

bool IsCompressed(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  std::string first(6, '\0');
  file.read(first.data(), static_cast<std::streamsize>(first.size()));
  first.resize(static_cast<size_t>(file.gcount()));
  return DetectCompression(first) != Compression::kNone;
}

// The kind of file that the flags ask for; nothing if the input decides.
std::optional<ContainerKind> AskedKind(const Flags& flags) {
  if (flags.Has("container")) {
    return flags.Text("container") == "text" ? ContainerKind::kText : ContainerKind::kBgcode;
  }
  if (!flags.Has("o")) return std::nullopt;
  return ContainerByExtension(flags.Text("o"));
}

// Fails if `input` cannot be written as a file of `kind`.
absl::Status CheckKind(const InputFile& input, ContainerKind kind) {
  if (kind == input.kind()) return absl::OkStatus();
  if (kind == ContainerKind::kGcode3mf || kind == ContainerKind::kUfp) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "cannot make a %s from %s", ContainerName(kind), ContainerName(input.kind())));
  }
  return absl::OkStatus();
}

}  // namespace

std::vector<Flag> ContainerFlagTable() {
  return Joined({{.name = "container",
                  .value = "KIND",
                  .help = "text or bgcode (default: by OUTPUT, or as INPUT)",
                  .choices = {"text", "bgcode"},
                  .topic = kSlicedTopic}},
                PlateFlagTable());
}

std::vector<Flag> PlateFlagTable() {
  return OfTopic(kSlicedTopic, {
                                   {"plate", "N", "only this plate of a .gcode.3mf (default: all)"},
                                   {"ignore_md5", "", "accept plates whose MD5 is wrong"},
                               });
}

absl::StatusOr<PlateOptions> ParsePlateOptions(const Flags& flags) {
  PlateOptions options;
  const auto plate = flags.Integer("plate", 1, std::numeric_limits<uint32_t>::max());
  if (!plate.ok()) return plate.status();
  if (*plate) options.plate = static_cast<uint32_t>(**plate);
  options.container.ignore_md5 = flags.Switch("ignore_md5");
  return options;
}

absl::StatusOr<GcodeTarget> FindGcodeTarget(const Flags& flags, const InputFile& input) {
  const ContainerKind kind = AskedKind(flags).value_or(input.kind());
  if (absl::Status status = CheckKind(input, kind); !status.ok()) return status;
  if (flags.Has("o")) return GcodeTarget{flags.Text("o"), kind};
  if (flags.Has("json")) return GcodeTarget{"", kind};
  if (input.name == "-") return GcodeTarget{input.name, kind};
  if (IsCompressed(input.name)) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s is compressed and the output is not: use -o OUTPUT", input.name));
  }
  if (kind != input.kind()) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s is %s and the output is %s: use -o OUTPUT", input.name,
                        ContainerName(input.kind()), ContainerName(kind)));
  }
  return GcodeTarget{input.name, kind};
}

absl::Status WriteGcode(const InputFile& input, const std::map<size_t, NewPart>& parts,
                        bool changed, const GcodeTarget& target) {
  if (!changed && target.name == input.name && target.name != "-") return absl::OkStatus();
  if (target.kind != input.kind()) {
    // There is one part: see CheckOnePlate.
    const absl::StatusOr<std::string> packed = PackText(parts.begin()->second.text, target.kind);
    if (!packed.ok()) {
      return absl::Status(packed.status().code(),
                          absl::StrFormat("%s: %s", DisplayName(input.name),
                                          std::string(packed.status().message())));
    }
    return WriteWholeFile(target.name, *packed);
  }
  if (!input.container) return WriteWholeFile(target.name, parts.begin()->second.text);
  const absl::StatusOr<std::string> written = input.container->WithParts(parts);
  return written.ok() ? WriteWholeFile(target.name, *written) : written.status();
}

std::string GcodeSummary(const GcodeRewrite& rewrite) {
  std::string summary =
      rewrite.layers_changed == 0
          ? absl::StrFormat("nothing to gain, the G-code stays unchanged: %s\n",
                            DescribeRewrite(rewrite))
          : absl::StrFormat("%d of %d layers rewritten: %s\n", rewrite.layers_changed,
                            rewrite.layers, DescribeRewrite(rewrite));
  const std::string rest = DescribeRest(rewrite);
  if (!rest.empty()) absl::StrAppend(&summary, rest, "\n");
  const std::string fast = DescribeFast(rewrite);
  if (!fast.empty()) absl::StrAppend(&summary, fast, "\n");
  for (const std::string& line : DescribeLeft(rewrite)) absl::StrAppend(&summary, line, "\n");
  return summary;
}

}  // namespace traverse::cli

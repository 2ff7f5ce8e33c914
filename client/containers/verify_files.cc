#include "client/containers/verify_files.h"

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/containers/bgcode/for_printer.h"
#include "client/files/read_file.h"
#include "client/gcode/stated_times.h"
#include "client/gcode/verify/permissions.h"
#include "client/gcode/verify/verifier.h"

namespace traverse {
namespace {

using containers::ForPrinter;

struct Side {
  std::unique_ptr<Container> container;
  const std::string& name;
};

// The name of a part in messages.
std::string PartName(const Side& side, const GcodePart& part) {
  const std::string shown = DisplayName(side.name);
  return part.name.empty() ? shown : absl::StrFormat("%s: %s", shown, part.name);
}

// The plates that are compared.
absl::StatusOr<std::vector<uint32_t>> Plates(const Side& original, const Side& optimised,
                                             const std::optional<uint32_t>& plate) {
  std::vector<uint32_t> plates;
  if (plate) {
    plates.push_back(*plate);
    return plates;
  }
  for (const GcodePart& part : original.container->parts()) plates.push_back(part.plate);
  std::vector<uint32_t> others;
  for (const GcodePart& part : optimised.container->parts()) others.push_back(part.plate);
  // The only plate of one archive may be the fifth of the other.
  if (plates.size() == 1 && others.size() == 1) return plates;
  if (plates != others) {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s and %s have different plates: choose one with --plate",
                        DisplayName(original.name), DisplayName(optimised.name)));
  }
  return plates;
}

absl::StatusOr<size_t> PartOf(const Side& side, uint32_t plate, bool any) {
  if (any && side.container->parts().size() == 1) return size_t{0};
  return FindPlate(*side.container, plate, side.name);
}

VerifyReport CheckTexts(std::string original, const std::string& original_name,
                        std::string optimised, const std::string& optimised_name,
                        std::optional<CommentsKept> kept, const VerifyFilesOptions& options) {
  // Before comments are removed, and the line at the head with them.
  VerifyOptions rules;
  rules.limit = options.limit;
  rules.permissions = PermissionsFor(options.permissions, optimised);
  const std::optional<gcode::TimeScale> scale = gcode::StatedScale(optimised);
  if (scale && scale != gcode::StatedScale(original)) {
    original = gcode::RestateTimes(original, *scale);
  }
  if (kept) {
    original = ForPrinter(original, *kept);
    optimised = ForPrinter(optimised, *kept);
  }
  return CheckGcode(original, original_name, optimised, optimised_name, rules);
}

void Add(VerifyReport report, VerifyReport& sum) {
  sum.permissions = report.permissions;
  for (size_t rule = 0; rule < sum.counts.size(); ++rule) sum.counts[rule] += report.counts[rule];
  for (VerifyBreak& found : report.breaks) sum.breaks.push_back(std::move(found));
}

}  // namespace

absl::StatusOr<VerifyReport> VerifyFiles(std::string original, const std::string& original_name,
                                         std::string optimised, const std::string& optimised_name,
                                         const VerifyFilesOptions& options) {
  auto was = OpenContainer(std::move(original), original_name, options.container);
  if (!was.ok()) return was.status();
  auto is = OpenContainer(std::move(optimised), optimised_name, options.container);
  if (!is.ok()) return is.status();
  const Side before = {*std::move(was), original_name};
  const Side after = {*std::move(is), optimised_name};
  const auto plates = Plates(before, after, options.plate);
  if (!plates.ok()) return plates.status();
  std::optional<CommentsKept> kept;
  if (before.container->kind() == ContainerKind::kBgcode ||
      after.container->kind() == ContainerKind::kBgcode) {
    kept = std::min(before.container->comments_kept(), after.container->comments_kept());
  }
  VerifyReport sum;
  for (const uint32_t plate : *plates) {
    const auto first = PartOf(before, plate, plates->size() == 1);
    if (!first.ok()) return first.status();
    const auto second = PartOf(after, plate, plates->size() == 1);
    if (!second.ok()) return second.status();
    absl::StatusOr<std::string> given = before.container->Text(*first);
    if (!given.ok()) return given.status();
    absl::StatusOr<std::string> made = after.container->Text(*second);
    if (!made.ok()) return made.status();
    Add(CheckTexts(*std::move(given), PartName(before, before.container->parts()[*first]),
                   *std::move(made), PartName(after, after.container->parts()[*second]), kept,
                   options),
        sum);
    if (absl::Status status = options.limit.status(); !status.ok()) return status;
  }
  return sum;
}

}  // namespace traverse

// Segments that adjoin in a path stay adjoined; only a closed path may be cut, once, and its ends
// then join.

#include <set>

#include "absl/strings/str_format.h"
#include "client/gcode/verify/rules/rules.h"

namespace traverse::gcode {
namespace {

// A path that continues across a line whose position matters does so in both files.
void CheckJoint(const LayerPair& layer, size_t section, LayerFindings& findings) {
  const uint32_t path = layer.SectionWas(section).first_path;
  if (!layer.was().paths[path].joined) return;
  const uint32_t begins = layer.SectionIs(section).first_path;
  const absl::Span<const Visit> visits = layer.SectionVisits(section);
  const bool joined = layer.is().paths[begins].joined && !visits.empty() &&
                      visits[0].path == path && visits[0].entry == 0 && visits[0].forward;
  if (joined) return;
  findings.breaks.push_back({VerifyRule::kWholePaths, layer.was().LineOf(path),
                             layer.is().LineOf(begins),
                             "does not continue from the segment before it"});
}

}  // namespace

void CheckWholePaths(const LayerPair& layer, LayerFindings& findings) {
  for (size_t k = 0; k < layer.section_count(); ++k) CheckJoint(layer, k, findings);
  const TraceChunk& was = layer.was();
  std::set<uint32_t> begun;
  for (const Visit& visit : layer.visits()) {
    if (layer.Ended()) return;
    const TracePath& path = was.paths[visit.path];
    if (visit.segments == path.size()) continue;
    // Of each path all parts but the one that is printed first.
    if (begun.insert(visit.path).second) continue;
    findings.breaks.push_back(
        {VerifyRule::kWholePaths, was.segments[path.first_segment + visit.entry].line,
         layer.LineOf(visit),
         absl::StrFormat(
             "begins with %d of the %d segments of a path that is printed without interruption",
             visit.segments, path.size())});
  }
}

}  // namespace traverse::gcode

// The rules, one a file. Each says what it finds in one layer; some only look, and compare what
// they saw with the whole of the original when both files are done.

#ifndef TRAVERSE_CLIENT_GCODE_VERIFY_RULES_RULES_H_
#define TRAVERSE_CLIENT_GCODE_VERIFY_RULES_RULES_H_

#include <vector>

#include "client/gcode/verify/findings.h"
#include "client/gcode/verify/match/layer_pair.h"
#include "client/gcode/verify/permissions.h"

namespace traverse::gcode {

struct RuleContext {
  VerifyPermissions permissions;
  SlicerSettings settings;
};

// Layer by layer.
void CheckWholePaths(const LayerPair& layer, LayerFindings& findings);
void CheckOrder(const LayerPair& layer, const RuleContext& context, LayerFindings& findings);
void CheckDirection(const LayerPair& layer, const RuleContext& context, LayerFindings& findings);
void CheckSeam(const LayerPair& layer, const RuleContext& context, LayerFindings& findings);
void CheckBends(const LayerPair& layer, LayerFindings& findings);
void CheckOpenTravels(const LayerPair& layer, LayerFindings& findings);
void CheckKeptTravels(const LayerPair& layer, LayerFindings& findings);
void CheckFixedMoves(const LayerPair& layer, LayerFindings& findings);
void CheckScriptedTravels(const LayerPair& layer, LayerFindings& findings);
void ObserveLifts(const LayerPair& layer, LayerFindings& findings);
void ObserveHeights(const LayerPair& layer, LayerFindings& findings);
void ObserveParts(const LayerPair& layer, LayerFindings& findings);
void ObservePrimes(const LayerPair& layer, LayerFindings& findings);
void ObserveTravelLengths(const LayerPair& layer, LayerFindings& findings);
void ObserveSpeeds(const LayerPair& layer, LayerFindings& findings);
void CheckWipes(const LayerPair& layer, const RuleContext& context, LayerFindings& findings);
void CheckCommands(const LayerPair& layer, LayerFindings& findings);
void CheckPathEnds(const LayerPair& layer, LayerFindings& findings);
void CheckDepartures(const LayerPair& layer, LayerFindings& findings);

// The same for what follows the last layer of both files.
void ObserveLastParts(const LayerPair& layer, LayerFindings& findings);
void ObserveLastSpeeds(const LayerPair& layer, LayerFindings& findings);
void CheckLeaving(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks);

// Chunk by chunk: what belongs to sections.
void CheckStandstill(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks);
void CheckLineFaults(const TraceChunk& was, const TraceChunk& is, std::vector<Finding>& breaks);

// What one file states about its progress, and when.
struct ProgressLog {
  std::vector<Progress> lines;
  std::vector<SectionBegin> begins;
  double seconds = 0;      // up to the last deposit
  double all_seconds = 0;  // of the whole file, with what its end script does

  void Append(const TraceChunk& chunk);
};

// At the end.
void CompareProgress(const ProgressLog& was, const ProgressLog& is, std::vector<Finding>& breaks);
void CompareLifts(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void CompareHeights(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void CompareBounds(const Observations& was, const Observations& is, const RuleContext& context,
                   std::vector<Finding>& breaks);
void CompareTravelLengths(const Observations& was, const Observations& is,
                          std::vector<Finding>& breaks);
void CompareParts(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void ComparePrimes(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void ComparePokes(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void CompareDepartures(const Observations& was, const Observations& is, const RuleContext& context,
                       std::vector<Finding>& breaks);
void CompareSpeeds(const Observations& was, const Observations& is, std::vector<Finding>& breaks);
void CompareWipes(const Observations& was, const Observations& is, std::vector<Finding>& breaks);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_VERIFY_RULES_RULES_H_

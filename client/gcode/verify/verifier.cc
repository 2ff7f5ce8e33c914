#include "client/gcode/verify/verifier.h"

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "absl/container/flat_hash_set.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "client/gcode/parallel.h"
#include "client/gcode/verify/line_numbers.h"
#include "client/gcode/verify/machine/text_lines.h"
#include "client/gcode/verify/match/hidden_links.h"
#include "client/gcode/verify/match/layer_shape.h"
#include "client/gcode/verify/match/moved_gaps.h"
#include "client/gcode/verify/match/moved_objects.h"
#include "client/gcode/verify/match/path_lines.h"
#include "client/gcode/verify/rules/obstacles.h"
#include "client/gcode/verify/rules/rest.h"
#include "client/gcode/verify/rules/rules.h"
#include "client/gcode/verify/same_print.h"
#include "client/gcode/verify/text.h"
#include "client/gcode/verify/trace/side_reader.h"

namespace traverse {
namespace gcode {
namespace {

// How much of the original is checked at once: enough to keep all threads busy, but a small part of
// the file, because its paths take up to twelve times the memory of their text.
constexpr size_t kLeastChunkBytes = 1 << 20;
constexpr size_t kMostChunkBytes = 4 << 20;
constexpr size_t kChunksOfAFile = 32;

size_t ChunkBytes(size_t file_bytes) {
  return std::clamp(file_bytes / kChunksOfAFile, kLeastChunkBytes, kMostChunkBytes);
}

// One of the two files, as it is read: without the numbers of its lines, for example.
struct File {
  std::string_view text;
  const std::string& name;
  bool right_digest = false;  // its first line states the digest of the whole file

  File With(std::string_view other_text) const { return {other_text, name, right_digest}; }
};

class Verifier {
 public:
  Verifier(const File& original, const File& optimised, const VerifyOptions& options)
      : original_(original),
        optimised_(optimised),
        rules_(options.rules),
        threads_(ThreadsFor(original.text.size())),
        limit_(options.limit),
        context_{options.permissions.value_or(
                     PermissionsInHead(optimised.text).value_or(VerifyPermissions{})),
                 ReadSettings(original.text)},
        obstacles_(context_.settings, limit_),
        was_(original.text, kOptimisedMark, HasLayerMarks(original.text), original.right_digest,
             limit_),
        is_(optimised.text, kOptimisedMark, HasLayerMarks(original.text), optimised.right_digest,
            limit_) {
    report_.permissions = context_.permissions;
    const bool rests =
        !context_.permissions.is_free() && (rules_ & RuleBit(VerifyRule::kRest)) != 0;
    if (rests) rest_.emplace(context_.settings.least_layer_seconds);
  }

  VerifyReport Verify();

 private:
  void ReadNext();
  void FindMoved();
  void TakeBackGaps();
  bool SamePrint();
  void CheckChunk();
  std::vector<LayerShape> ShapesOfChunk();
  std::vector<double> HeightsOfLayers();
  void CheckLayer(const LayerPair& layer, LayerFindings& findings) const;
  void CheckObstacles(size_t layers);
  void CheckLabels(size_t first, size_t end);
  void CheckLabel(const Section& was, const Section& is);
  void CheckText();
  void Finish();
  void Compare(std::vector<Finding>& breaks) const;
  void Add(Finding finding);
  int64_t LayerOf(uint32_t optimised_line) const;

  const File original_;
  const File optimised_;
  const uint32_t rules_;
  const int threads_;
  const WorkLimit limit_;
  const RuleContext context_;
  Obstacles obstacles_;
  SideReader was_;
  SideReader is_;
  TraceChunk next_was_;  // the one after chunk_was_
  TraceChunk chunk_was_;
  TraceChunk chunk_is_;
  LayerShape shape_before_;                 // of the last layer of the chunk before
  absl::flat_hash_set<uint64_t> gaps_was_;  // digests of deposits that a moved gap is about
  absl::flat_hash_set<uint64_t> gaps_is_;
  std::vector<MovedLayer> moved_;      // among the layers of the chunks
  std::vector<MovedLayer> all_moved_;  // so far
  bool more_ = true;                   // next_was_ is not empty
  uint32_t sections_ = 0;              // that were compared
  Observations seen_was_;
  Observations seen_is_;
  ProgressLog progress_was_;
  ProgressLog progress_is_;
  std::optional<RestWatch> rest_;  // unless islands need not rest
  double last_z_mm_ = 0;           // of the layers checked
  std::vector<Finding> findings_;
  PathLines path_lines_;
  std::vector<uint32_t> layer_lines_;  // where the layers of the optimised file begin
  VerifyReport report_;
};

// Reads the next layers of the original, and the layers of the other file that match those read
// before.
void Verifier::ReadNext() {
  chunk_was_ = std::exchange(next_was_, TraceChunk{});
  const bool last = was_.done();
  ParallelFor(2, threads_, [&](size_t i) {
    if (i == 1) {
      chunk_is_ = is_.NextSections(last ? UINT32_MAX : chunk_was_.end_section);
    } else if (!last) {
      next_was_ = was_.NextBytes(ChunkBytes(original_.text.size()));
    }
  });
  more_ = !last;
}

// Whole objects may have changed places within a layer.
void Verifier::FindMoved() {
  moved_ = FindMovedLayers(was_.cut(), is_.cut(), sections_, chunk_was_.end_section);
  all_moved_.insert(all_moved_.end(), moved_.begin(), moved_.end());
  OrderAsMoved(moved_, chunk_was_);
}

// Loops may take their gap along, so that some deposits differ; the rest is compared without them.
void Verifier::TakeBackGaps() {
  for (const MovedGap& gap :
       TakeBackMovedGaps(chunk_was_, chunk_is_, threads_, findings_, limit_)) {
    is_.Count(gap.section, gap.printed, gap.as);
    gaps_is_.insert(gap.printed.begin(), gap.printed.end());
    gaps_was_.insert(gap.as.begin(), gap.as.end());
  }
}

bool Verifier::SamePrint() {
  const Side was{original_.text, original_.name, was_.cut(), gaps_was_, original_.right_digest};
  const Side is{optimised_.text, optimised_.name, is_.cut(), gaps_is_, optimised_.right_digest};
  std::vector<VerifyBreak> found =
      Differences(was, is, sections_, chunk_was_.end_section, !more_, moved_, limit_);
  if (found.empty()) CheckLabels(sections_, chunk_was_.end_section);
  sections_ = chunk_was_.end_section;
  if (chunk_is_.end_section != chunk_was_.end_section) {
    // A line ends a section in only one of the files; comparing further sections shows which.
    more_ = false;
    if (found.empty()) found = Differences(was, is, 0, UINT32_MAX, true, all_moved_, limit_);
  }
  for (VerifyBreak& difference : found) {
    const bool fits = report_.breaks.size() < VerifyReport::kMostBreaks;
    if (fits) report_.breaks.push_back(std::move(difference));
  }
  report_.counts[static_cast<size_t>(VerifyRule::kSamePrint)] += static_cast<int64_t>(found.size());
  return report_.breaks.empty();
}

// A printer may be told to skip an object, with everything between its labels: a retraction and its
// prime must be on the same side of a label.
void Verifier::CheckLabels(size_t first, size_t end) {
  const std::vector<Section>& was = was_.cut().sections;
  const std::vector<Section>& is = is_.cut().sections;
  end = std::min({end, was.size(), is.size()});
  // The first label of one file is the first of the other, whatever object it names.
  for (size_t i = first, k = first; i < end; ++i) {
    if (!was[i].label) continue;
    while (k < end && !is[k].label) ++k;
    if (k == end) return;
    CheckLabel(was[i], is[k++]);
  }
}

void Verifier::CheckLabel(const Section& was, const Section& is) {
  const auto add = [&](VerifyRule rule, const char* what) {
    findings_.push_back({rule, was.last_line, is.last_line, what});
  };
  if (was.lift != is.lift) {
    add(VerifyRule::kLifts, "at another height at this label of an object than in the original");
  }
  if (was.retracted == is.retracted) return;
  add(VerifyRule::kRetractions,
      is.retracted ? "retracted at this label of an object, unlike the original"
                   : "not retracted at this label of an object, unlike the original");
}

void Verifier::CheckLayer(const LayerPair& layer, LayerFindings& findings) const {
  using Rule = void (*)(const LayerPair&, LayerFindings&);
  using RuleInContext = void (*)(const LayerPair&, const RuleContext&, LayerFindings&);
  static constexpr RuleInContext kInContext[] = {CheckOrder, CheckDirection, CheckSeam, CheckWipes};
  static constexpr Rule kRules[] = {
      CheckWholePaths,      CheckOpenTravels, CheckKeptTravels, CheckBends,    CheckFixedMoves,
      CheckScriptedTravels, ObserveLifts,     ObserveHeights,   ObservePrimes, ObserveParts,
      ObserveTravelLengths, ObserveSpeeds,    CheckCommands,    CheckPathEnds, CheckDepartures};
  for (const RuleInContext check : kInContext) {
    if (!layer.Ended()) check(layer, context_, findings);
  }
  for (const Rule check : kRules) {
    if (!layer.Ended()) check(layer, findings);
  }
}

// Of all layers of the chunk, and of those before and behind it.
std::vector<LayerShape> Verifier::ShapesOfChunk() {
  const size_t layers = chunk_was_.layers.size();
  std::vector<LayerShape> shapes(layers + 2);
  if (layers == 0) return shapes;
  shapes.front() = std::move(shape_before_);
  const auto add = [&](size_t i) {
    if (i == layers && next_was_.layers.empty()) return;
    const TraceChunk& chunk = i == layers ? next_was_ : chunk_was_;
    shapes[i + 1] = LayerShape(LayerPair(chunk, chunk, i % layers, limit_));
  };
  ParallelFor(layers + 1, threads_, add, limit_);
  shape_before_ = shapes[layers];
  return shapes;
}

// [layer] of the chunk: above what was printed before. 0 where it goes down.
std::vector<double> Verifier::HeightsOfLayers() {
  std::vector<double> heights;
  for (const TraceLayer& layer : chunk_was_.layers) {
    const TraceSection& section = chunk_was_.sections[layer.first_section];
    const double z_mm = chunk_was_.paths[section.first_path].z_mm;
    heights.push_back(std::max(z_mm - std::exchange(last_z_mm_, z_mm), 0.0));
  }
  return heights;
}

void Verifier::CheckChunk() {
  const size_t layers = std::min(chunk_was_.layers.size(), chunk_is_.layers.size());
  const bool hides = context_.permissions.hides_travel();
  const std::vector<LayerShape> shapes = hides ? ShapesOfChunk() : std::vector<LayerShape>();
  std::vector<LayerFindings> found(layers);
  std::vector<PathLines> lines(layers);
  std::vector<PrintedIslands> islands(layers);
  const std::vector<double> heights = HeightsOfLayers();
  const auto check = [&](size_t i) {
    LayerPair layer(chunk_was_, chunk_is_, i, limit_);
    if (layer.Ended()) return;
    layer.FindTails();
    if (hides) {
      layer.SetHidden(HiddenLinksOf(layer, {shapes[i], shapes[i + 1], shapes[i + 2]},
                                    context_.permissions.max_hidden_travel_mm,
                                    context_.permissions.leads_within()));
    }
    lines[i].Add(layer);
    CheckLayer(layer, found[i]);
    if (rest_) islands[i] = FindPrintedIslands(layer, heights[i], context_.settings.filament_mm);
    if (more_ || i + 1 < layers || layer.Ended()) return;
    ObserveLastParts(layer, found[i]);
    ObserveLastSpeeds(layer, found[i]);
  };
  ParallelFor(layers, threads_, check, limit_);
  if (limit_.Ended()) return;
  for (size_t i = 0; i < layers; ++i) {
    const TraceSection& section = chunk_is_.sections[chunk_is_.layers[i].first_section];
    layer_lines_.push_back(chunk_is_.LineOf(section.first_path));
    path_lines_.Append(lines[i]);
    seen_was_.Append(found[i].was);
    seen_is_.Append(found[i].is);
    for (Finding& finding : found[i].breaks) {
      finding.at.layer = chunk_was_.layers[i].index;
      findings_.push_back(std::move(finding));
    }
    if (rest_) rest_->Take(std::move(islands[i]), chunk_was_.layers[i].index, findings_);
  }
  if ((rules_ & RuleBit(VerifyRule::kObstacles)) != 0) CheckObstacles(layers);
  seen_was_.deposit_accelerations.insert(chunk_was_.accelerations.begin(),
                                         chunk_was_.accelerations.end());
  CheckStandstill(chunk_was_, chunk_is_, findings_);
  CheckLineFaults(chunk_was_, chunk_is_, findings_);
  progress_was_.Append(chunk_was_);
  progress_is_.Append(chunk_is_);
  // What follows the last path is a script.
  if (!more_) CheckLeaving(chunk_was_, chunk_is_, findings_);
}

// One layer after the other: what stands is what was printed before.
void Verifier::CheckObstacles(size_t layers) {
  for (size_t i = 0; i < layers; ++i) {
    obstacles_.CheckLayer(chunk_was_, chunk_is_, i, findings_);
  }
  if (!more_) obstacles_.CheckEnd(chunk_was_, chunk_is_, findings_);
}

void Verifier::Compare(std::vector<Finding>& breaks) const {
  CompareProgress(progress_was_, progress_is_, breaks);
  CompareLifts(seen_was_, seen_is_, breaks);
  CompareHeights(seen_was_, seen_is_, breaks);
  CompareBounds(seen_was_, seen_is_, context_, breaks);
  CompareTravelLengths(seen_was_, seen_is_, breaks);
  CompareParts(seen_was_, seen_is_, breaks);
  ComparePrimes(seen_was_, seen_is_, breaks);
  CompareSpeeds(seen_was_, seen_is_, breaks);
  ComparePokes(seen_was_, seen_is_, breaks);
  CompareDepartures(seen_was_, seen_is_, context_, breaks);
  CompareWipes(seen_was_, seen_is_, breaks);
}

int64_t Verifier::LayerOf(uint32_t optimised_line) const {
  const auto behind = std::ranges::upper_bound(layer_lines_, optimised_line);
  return behind - layer_lines_.begin() - 1;
}

void Verifier::Add(Finding finding) {
  const auto rule = static_cast<size_t>(finding.rule);
  if (((rules_ >> rule) & 1u) == 0) return;
  if (report_.counts[rule]++ >= static_cast<int64_t>(VerifyReport::kMostBreaks)) return;
  // What one file lacks was to be done on the way to the same path.
  auto& [line, layer] = finding.at;
  if (finding.original_line == 0 && line > 0) {
    finding.original_line = path_lines_.OriginalOf(line);
  } else if (line == 0 && finding.original_line > 0) {
    line = path_lines_.OptimisedOf(finding.original_line);
  }
  if (layer < 0 && line > 0) layer = LayerOf(line);
  const auto place = [](const std::string& name, uint32_t of) {
    return of == 0 ? name : absl::StrCat(name, ":", of);
  };
  report_.breaks.push_back({finding.rule, finding.original_line, line, layer,
                            absl::StrFormat("%s: %s (%s; %s)", place(optimised_.name, line),
                                            finding.what, std::string(VerifyRuleName(finding.rule)),
                                            place(original_.name, finding.original_line)),
                            finding.before_line});
}

// What no line of G-code shows: the byte order mark and the line ends. And the line that says what
// may have changed, which is compared with nothing: there is one.
void Verifier::CheckText() {
  if (is_.cut().ignored > std::max(was_.cut().ignored, 1u)) {
    findings_.push_back({VerifyRule::kSamePrint, 1, is_.cut().last_ignored,
                         "one more line that says by what this file was optimised"});
  }
  if (original_.text.starts_with(kMarkOfUtf8) != optimised_.text.starts_with(kMarkOfUtf8)) {
    findings_.push_back({VerifyRule::kSamePrint, 1, 1,
                         "only one of the files begins with a byte order mark of UTF-8"});
  }
  // A file transfer may convert all line ends, but not some of them.
  const uint32_t ends = is_.lines().ends();
  const bool one_kind = (ends & (ends - 1)) == 0 && (ends & TextLines::kLoneReturn) == 0;
  if (const uint32_t odd = ends & ~was_.lines().ends(); odd != 0 && !one_kind) {
    findings_.push_back({VerifyRule::kSamePrint, 0, is_.lines().FirstWithEnds(odd),
                         "some lines have line ends that no line of the original has"});
  }
}

void Verifier::Finish() {
  CheckText();
  Compare(findings_);
  std::ranges::stable_sort(findings_, {}, [](const Finding& finding) {
    return std::pair(finding.rule, finding.at.line);
  });
  for (Finding& finding : findings_) Add(std::move(finding));
}

VerifyReport Verifier::Verify() {
  next_was_ = was_.NextBytes(ChunkBytes(original_.text.size()));
  while (more_ && !limit_.Ended()) {
    ReadNext();
    FindMoved();
    TakeBackGaps();
    if (!SamePrint()) continue;
    NumberAsOriginal(moved_, chunk_is_);
    CheckChunk();
  }
  if (!limit_.Ended() && report_.ok()) Finish();
  // What was compared until then is no proof, and what was missed is no difference.
  if (const absl::Status status = limit_.status(); !status.ok()) {
    report_.breaks = {
        {VerifyRule::kSamePrint, 0, 0, -1,
         absl::StrCat(optimised_.name, ": not compared: ", std::string(status.message()))}};
    report_.counts = {};
    report_.counts[static_cast<size_t>(VerifyRule::kSamePrint)] = 1;
  }
  return std::move(report_);
}

// The next slash with which a line begins, after blanks: machines execute such lines or skip them.
size_t NextOptional(std::string_view text, size_t from) {
  for (size_t at = text.find('/', from); at != std::string_view::npos;
       at = text.find('/', at + 1)) {
    size_t begin = at;
    while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
    if (begin == 0 || text[begin - 1] == '\n' || text[begin - 1] == '\r') return at;
  }
  return std::string_view::npos;
}

// The text as a machine reads it that executes such lines.
std::string WithOptionalLines(std::string_view text) {
  std::string done(text);
  for (size_t at = NextOptional(done, 0); at != std::string::npos;
       at = NextOptional(done, at + 1)) {
    done[at] = ' ';
  }
  return done;
}

VerifyReport CheckUnnumbered(const File& was, const File& is, const VerifyOptions& options) {
  VerifyReport report = Verifier(was, is, options).Verify();
  if (!report.ok() || NextOptional(was.text, 0) == std::string_view::npos) return report;
  const std::string all_was = WithOptionalLines(was.text);
  const std::string all_is = WithOptionalLines(is.text);
  return Verifier(was.With(all_was), is.With(all_is), options).Verify();
}

}  // namespace
}  // namespace gcode

VerifyReport CheckGcode(std::string_view original, const std::string& original_name,
                        std::string_view optimised, const std::string& optimised_name,
                        const VerifyOptions& options) {
  const gcode::File was{original, original_name, gcode::HasRightMd5(original)};
  const gcode::File is{optimised, optimised_name, gcode::HasRightMd5(optimised)};
  if (const std::optional<gcode::Unnumbered> numbered = gcode::WithoutNumbers(original)) {
    const std::optional<gcode::Unnumbered> other = gcode::WithoutNumbers(optimised);
    // Else they are compared with their numbers.
    if (other && other->form == numbered->form) {
      return gcode::CheckUnnumbered(was.With(numbered->text), is.With(other->text), options);
    }
  }
  return gcode::CheckUnnumbered(was, is, options);
}

}  // namespace traverse

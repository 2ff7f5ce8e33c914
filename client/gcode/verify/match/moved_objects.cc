#include "client/gcode/verify/match/moved_objects.h"

#include <algorithm>
#include <optional>

#include "absl/container/flat_hash_map.h"
#include "absl/types/span.h"

namespace traverse::gcode {
namespace {

// Sections [begin, end) of a layer under the same labels, or under none, some of which print.
struct Run {
  size_t begin = 0;
  size_t end = 0;
  uint64_t under = 0;
  bool stays = false;      // something within it is not known, or heats
  bool separated = false;  // the same stands before it, behind the run before
};

bool Stays(const Section& section) { return section.fixed || section.heats; }

// What is only cut off where the first path of a layer is higher than what was before it: it comes
// first whichever object that path is of.
bool IsCutAtHeight(const Section& section) {
  return section.fence == 0 && section.deposits.count == 0;
}

// The sections of a layer of one file.
struct LayerSections {
  const Sections& cut;
  std::vector<size_t> whole;      // their indices
  std::vector<size_t> at_height;  // those that are only cut off

  LayerSections(const Sections& of, size_t first, size_t end) : cut(of) {
    for (size_t i = first; i < end; ++i) {
      (IsCutAtHeight(of.sections[i]) ? at_height : whole).push_back(i);
    }
  }

  const Section& operator[](size_t i) const { return cut.sections[whole[i]]; }
  size_t size() const { return whole.size(); }
};

std::vector<Run> RunsOf(const LayerSections& sections) {
  std::vector<Run> runs;
  bool separated = false;
  bool labelled = false;
  for (size_t i = 0; i < sections.size();) {
    // Up to the first label that of the layer before may still hold.
    if (!labelled && sections[i].deposits.count == 0) {
      labelled = sections[i].names;
      separated = separated || Stays(sections[i]);
      ++i;
      continue;
    }
    labelled = true;
    // What stands between the labels that begin an object is not of it.
    if (sections[i].deposits.count == 0 && sections[i].names) {
      ++i;
      continue;
    }
    Run run{i, i, sections[i].under, false, separated};
    bool prints = false;
    for (; run.end < sections.size() && sections[run.end].under == run.under; ++run.end) {
      const Section& section = sections[run.end];
      prints = prints || section.deposits.count > 0;
      // What ends the last one stands between it and the next.
      if (run.end > run.begin) run.stays = run.stays || Stays(sections[run.end - 1]);
    }
    i = run.end;
    if (prints) {
      runs.push_back(run);
      separated = false;
    } else {
      separated = separated || run.stays;
    }
    separated = separated || Stays(sections[run.end - 1]);
  }
  return runs;
}

// The run of `was` that each run of `is` is; nothing if that is not certain.
std::optional<std::vector<size_t>> Pair(const std::vector<Run>& was, const std::vector<Run>& is) {
  if (was.size() != is.size()) return std::nullopt;
  std::vector<size_t> pairs(is.size());
  std::vector<bool> taken(was.size(), false);
  absl::flat_hash_map<uint64_t, std::vector<size_t>> runs_under;
  for (size_t j = 0; j < was.size(); ++j) runs_under[was[j].under].push_back(j);
  for (size_t k = 0; k < is.size(); ++k) {
    const auto same = [&](size_t j) {
      return !taken[j] && was[j].under == is[k].under &&
             was[j].end - was[j].begin == is[k].end - is[k].begin;
    };
    size_t found = k;
    if (!same(k)) {
      // One printed twice is the first of the two, or neither.
      const std::vector<size_t>& under = runs_under[is[k].under];
      if (under.size() != 1 || !same(under[0])) return std::nullopt;
      found = under[0];
    }
    taken[found] = true;
    pairs[k] = found;
  }
  return pairs;
}

// Nothing passes what stays: as many runs, and the same ones, are before it in both files.
bool KeepsWhatStays(const std::vector<Run>& was, const std::vector<size_t>& pairs) {
  size_t latest = 0;  // of the runs so far, behind the last of them
  for (size_t k = 0; k < pairs.size(); ++k) {
    const bool stays = was[k].under == 0 || was[k].stays;
    if ((stays || was[k].separated) && latest > k) return false;
    if (stays && pairs[k] != k) return false;
    latest = std::max(latest, pairs[k] + 1);
    if (stays && latest > k + 1) return false;
  }
  return true;
}

std::optional<MovedLayer> Match(const Sections& was, const Sections& is, size_t first, size_t end) {
  const LayerSections all_was(was, first, end);
  const LayerSections all_is(is, first, end);
  if (all_was.size() != all_is.size()) return std::nullopt;
  const std::vector<Run> runs_was = RunsOf(all_was);
  const std::vector<Run> runs_is = RunsOf(all_is);
  const std::optional<std::vector<size_t>> pairs = Pair(runs_was, runs_is);
  if (!pairs || !KeepsWhatStays(runs_was, *pairs)) return std::nullopt;
  MovedLayer layer{first, end, std::vector<uint32_t>(end - first),
                   std::vector<uint32_t>(end - first), std::vector<bool>(end - first, false)};
  const auto take = [&](size_t to, size_t from) {
    layer.was[to - first] = layer.ends[to - first] = static_cast<uint32_t>(from);
  };
  for (size_t i = 0; i < all_is.at_height.size(); ++i) {
    take(all_is.at_height[i], all_was.at_height[i]);
  }
  size_t next_was = 0;  // behind the run before
  size_t next_is = 0;
  for (size_t k = 0; k <= runs_is.size(); ++k) {
    const bool last = k == runs_is.size();
    const size_t end_was = last ? all_was.size() : runs_was[k].begin;
    const size_t end_is = last ? all_is.size() : runs_is[k].begin;
    if (end_was - next_was != end_is - next_is) return std::nullopt;
    for (; next_is < end_is; ++next_is, ++next_was) {
      take(all_is.whole[next_is], all_was.whole[next_was]);
    }
    if (last) break;
    const Run& run = runs_was[(*pairs)[k]];
    for (size_t i = 0; i < run.end - run.begin; ++i) {
      take(all_is.whole[runs_is[k].begin + i], all_was.whole[run.begin + i]);
      layer.goes_on[all_is.whole[runs_is[k].begin + i] - first] = i + 1 < run.end - run.begin;
    }
    next_is = runs_is[k].end;
    next_was = runs_was[k].end;
    layer.ends[all_is.whole[next_is - 1] - first] =
        static_cast<uint32_t>(all_was.whole[next_was - 1]);
  }
  return layer;
}

}  // namespace

std::vector<MovedLayer> FindMovedLayers(const Sections& was, const Sections& is, size_t first,
                                        size_t end) {
  std::vector<MovedLayer> layers;
  end = std::min({end, was.sections.size(), is.sections.size()});
  while (first < end) {
    size_t last = first;
    while (last < end && !was.sections[last].ends_layer && !is.sections[last].ends_layer) ++last;
    const size_t behind = std::min(last + 1, end);
    const auto of_layer = [first, behind](const Sections& cut) {
      return absl::MakeConstSpan(cut.sections).subspan(first, behind - first);
    };
    if (!std::ranges::equal(of_layer(was), of_layer(is), {}, &Section::under, &Section::under)) {
      if (std::optional<MovedLayer> layer = Match(was, is, first, behind)) {
        layers.push_back(*std::move(layer));
      }
    }
    first = behind;
  }
  return layers;
}

void OrderAsMoved(const std::vector<MovedLayer>& layers, TraceChunk& was) {
  for (const MovedLayer& layer : layers) {
    std::vector<uint32_t> place(layer.end - layer.first);
    for (size_t i = layer.first; i < layer.end; ++i) {
      place[layer.Of(i) - layer.first] = static_cast<uint32_t>(i);
    }
    const auto begin =
        std::ranges::lower_bound(was.sections, layer.first, {}, &TraceSection::index);
    const auto end =
        std::ranges::lower_bound(begin, was.sections.end(), layer.end, {}, &TraceSection::index);
    for (auto section = begin; section != end; ++section) {
      section->index = place[section->index - layer.first];
    }
    std::ranges::sort(begin, end, {}, &TraceSection::index);
  }
}

void NumberAsOriginal(const std::vector<MovedLayer>& layers, TraceChunk& is) {
  const auto renumber = [&layers](auto& events) {
    for (auto& event : events) {
      const auto behind = std::ranges::upper_bound(layers, event.section, {}, &MovedLayer::first);
      if (behind == layers.begin()) continue;
      const MovedLayer& layer = *(behind - 1);
      if (event.section < layer.end) event.section = layer.Of(event.section);
    }
  };
  if (layers.empty()) return;
  renumber(is.moves);
  renumber(is.standstills);
  renumber(is.line_faults);
}

}  // namespace traverse::gcode

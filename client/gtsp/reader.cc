#include "client/gtsp/reader.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <system_error>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "absl/strings/str_format.h"
#include "client/files/read_file.h"
#include "client/files/utf8_mark.h"
#include "client/gtsp/instance.h"

namespace traverse {
namespace {

constexpr double kMaxCoordinateMm = 1e6;  // the service refuses more
constexpr std::string_view kBlanks = " \t\r";

// Skips blanks in the rest of the text and takes its next word.
std::string_view NextWord(std::string_view& rest) {
  rest.remove_prefix(std::min(rest.find_first_not_of(kBlanks), rest.size()));
  const std::string_view word = rest.substr(0, rest.find_first_of(kBlanks));
  rest.remove_prefix(word.size());
  return word;
}

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string Quoted(std::string_view text) {
  constexpr size_t kMostShown = 32;
  std::string out = "\"";
  for (const char c : text.substr(0, kMostShown)) out += c >= ' ' && c <= '~' ? c : '?';
  return out + (text.size() > kMostShown ? "...\"" : "\"");
}

template <typename Number>
std::optional<Number> Parse(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Number value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  absl::StatusOr<gtsp::Instance> Read(std::string_view text);

 private:
  enum class Section { kHead, kPoints, kSets, kEnd };

  absl::Status ReadLine(std::string_view line);
  absl::Status ReadKey(std::string_view line);
  absl::Status TakeValue(const std::string& key, std::string_view value);
  absl::Status TakeNumber(const std::string& key, std::string_view value, size_t& number) const;
  absl::Status Begin(Section section, const std::string& key);
  absl::Status ReadPoint(std::string_view line);
  absl::Status ReadSetWord(std::string_view word);
  absl::Status BeginSet(int64_t number);
  absl::Status AddToSet(int64_t number);
  absl::Status EndFile();

  // Where a -1 may be missing, the fault shows lines behind it.
  std::string SinceBeginning() const {
    if (open_since_ == line_) return "";
    return absl::StrFormat(" (line %d has no -1)", open_since_);
  }

  absl::Status Fault(const std::string& what) const {
    return absl::InvalidArgumentError(
        absl::StrFormat("%s:%d: %s", DisplayName(name_), line_, what));
  }

  const std::string name_;
  size_t text_size_ = 0;
  int line_ = 0;
  Section section_ = Section::kHead;
  std::map<std::string, int> seen_;  // keys and sections, and their lines
  size_t dimension_ = 0;
  size_t set_count_ = 0;

  gtsp::Instance instance_;
  std::vector<bool> has_point_;
  size_t points_found_ = 0;
  std::vector<uint32_t> set_of_;  // by point: the number of its set, from 1; 0 if it is in none yet
  size_t sets_found_ = 0;
  uint32_t open_set_ = 0;  // the set that is being read, from 1; 0 between two sets
  int open_since_ = 0;     // the line in which it begins
};

absl::StatusOr<gtsp::Instance> Reader::Read(std::string_view text) {
  text = WithoutUtf8Mark(text);
  text_size_ = text.size();
  while (!text.empty() && section_ != Section::kEnd) {
    ++line_;
    const size_t end = text.find('\n');
    const std::string_view line = Trimmed(text.substr(0, end));
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (line.empty()) continue;
    if (absl::Status status = ReadLine(line); !status.ok()) return status;
  }
  if (absl::Status status = EndFile(); !status.ok()) return status;
  for (uint32_t s = 1; s < instance_.sets.size(); ++s) {
    if (instance_.sets[s].size() < instance_.sets[instance_.first_set].size()) {
      instance_.first_set = s;
    }
  }
  if (instance_.sets[instance_.first_set].size() * dimension_ > kMostGtspPoints) {
    return Fault(absl::StrFormat(
        "too large: the smallest set has %d points, which times all %d is more than %d",
        instance_.sets[instance_.first_set].size(), dimension_, kMostGtspPoints));
  }
  return std::move(instance_);
}

absl::Status Reader::ReadLine(std::string_view line) {
  const bool is_number = (line[0] >= '0' && line[0] <= '9') || line[0] == '-' || line[0] == '+';
  if (!is_number) return ReadKey(line);
  if (section_ == Section::kPoints) return ReadPoint(line);
  if (section_ != Section::kSets) return Fault("a number outside a section");
  while (true) {
    const std::string_view word = NextWord(line);
    if (word.empty()) return absl::OkStatus();
    if (absl::Status status = ReadSetWord(word); !status.ok()) return status;
  }
}

// `KEY: value`, `KEY : value`, or the name of a section with or without a colon.
absl::Status Reader::ReadKey(std::string_view line) {
  if (open_set_ != 0) return Fault(absl::StrFormat("set %d does not end with -1", open_set_));
  const size_t end = std::min(line.find_first_of(": \t"), line.size());
  const std::string key(line.substr(0, end));
  std::string_view value = Trimmed(line.substr(end));
  if (value.starts_with(':')) value = Trimmed(value.substr(1));
  if (key == "EOF") {
    section_ = Section::kEnd;
    return absl::OkStatus();
  }
  if (key == "COMMENT") return absl::OkStatus();
  const auto [earlier, is_new] = seen_.try_emplace(key, line_);
  if (!is_new)
    return Fault(absl::StrFormat("second %s, after line %d", Quoted(key), earlier->second));
  if (key == "NODE_COORD_SECTION") return Begin(Section::kPoints, key);
  if (key == "GTSP_SET_SECTION") return Begin(Section::kSets, key);
  return TakeValue(key, value);
}

absl::Status Reader::TakeValue(const std::string& key, std::string_view value) {
  if (key == "NAME" || key == "DISPLAY_DATA_TYPE") return absl::OkStatus();
  if (key == "TYPE") {
    if (value == "GTSP") return absl::OkStatus();
    return Fault(absl::StrFormat("TYPE is %s, but only GTSP is supported", Quoted(value)));
  }
  if (key == "EDGE_WEIGHT_TYPE") {
    if (value == "EUC_2D") return absl::OkStatus();
    return Fault(
        absl::StrFormat("EDGE_WEIGHT_TYPE is %s, but only EUC_2D is supported", Quoted(value)));
  }
  if (key == "NODE_COORD_TYPE") {
    if (value == "TWOD_COORDS") return absl::OkStatus();
    return Fault(
        absl::StrFormat("NODE_COORD_TYPE is %s, but only TWOD_COORDS is supported", Quoted(value)));
  }
  if (key == "DIMENSION") return TakeNumber(key, value, dimension_);
  if (key == "GTSP_SETS") return TakeNumber(key, value, set_count_);
  return Fault(absl::StrFormat("%s is not a supported key of a GTSPLIB file", Quoted(key)));
}

absl::Status Reader::TakeNumber(const std::string& key, std::string_view value,
                                size_t& number) const {
  const std::optional<size_t> count = Parse<size_t>(value);
  if (!count || *count == 0) {
    return Fault(
        absl::StrFormat("%s is %s, but must be a whole number of at least 1", key, Quoted(value)));
  }
  // So that a file cannot claim more memory than its own size justifies.
  if (*count > text_size_) {
    return Fault(absl::StrFormat("%s is %d, but the file is too short for so many", key, *count));
  }
  number = *count;
  return absl::OkStatus();
}

absl::Status Reader::Begin(Section section, const std::string& key) {
  for (const char* before : {"TYPE", "DIMENSION", "GTSP_SETS", "EDGE_WEIGHT_TYPE"}) {
    if (!seen_.contains(before)) return Fault(absl::StrFormat("%s before %s", key, before));
  }
  if (section == Section::kPoints) {
    instance_.points.resize(dimension_);
    has_point_.resize(dimension_);
  } else {
    instance_.sets.resize(set_count_);
    set_of_.resize(dimension_);
  }
  section_ = section;
  return absl::OkStatus();
}

absl::Status Reader::ReadPoint(std::string_view line) {
  const std::optional<int64_t> number = Parse<int64_t>(NextWord(line));
  const std::optional<double> x = Parse<double>(NextWord(line));
  const std::optional<double> y = Parse<double>(NextWord(line));
  if (!number || !x || !y || !Trimmed(line).empty())
    return Fault("a point needs a number, x and y");
  if (*number < 1 || *number > static_cast<int64_t>(dimension_)) {
    return Fault(absl::StrFormat("point %d is not among 1 to DIMENSION, %d", *number, dimension_));
  }
  for (const double value : {*x, *y}) {
    if (!(std::abs(value) <= kMaxCoordinateMm)) {
      return Fault(absl::StrFormat("point %d is not within +-1e6", *number));
    }
  }
  const size_t i = static_cast<size_t>(*number) - 1;
  if (has_point_[i]) return Fault(absl::StrFormat("second point %d", *number));
  has_point_[i] = true;
  ++points_found_;
  instance_.points[i] = {*x, *y};
  return absl::OkStatus();
}

absl::Status Reader::ReadSetWord(std::string_view word) {
  const std::optional<int64_t> number = Parse<int64_t>(word);
  if (!number) return Fault(absl::StrFormat("%s is not a whole number", Quoted(word)));
  if (open_set_ == 0) return BeginSet(*number);
  if (*number != -1) return AddToSet(*number);
  if (instance_.sets[open_set_ - 1].empty()) {
    return Fault(absl::StrFormat("set %d has no point", open_set_));
  }
  ++sets_found_;
  open_set_ = 0;
  return absl::OkStatus();
}

absl::Status Reader::BeginSet(int64_t number) {
  if (number < 1 || number > static_cast<int64_t>(set_count_)) {
    return Fault(absl::StrFormat("set %d is not among 1 to GTSP_SETS, %d", number, set_count_));
  }
  if (!instance_.sets[static_cast<size_t>(number) - 1].empty()) {
    return Fault(absl::StrFormat("second set %d", number));
  }
  open_set_ = static_cast<uint32_t>(number);
  open_since_ = line_;
  return absl::OkStatus();
}

absl::Status Reader::AddToSet(int64_t number) {
  if (number < 1 || number > static_cast<int64_t>(dimension_)) {
    return Fault(absl::StrFormat("point %d of set %d is not among 1 to DIMENSION, %d", number,
                                 open_set_, dimension_));
  }
  const size_t i = static_cast<size_t>(number) - 1;
  if (set_of_[i] == open_set_) {
    return Fault(
        absl::StrFormat("point %d is in set %d twice%s", number, open_set_, SinceBeginning()));
  }
  if (set_of_[i] != 0) {
    return Fault(absl::StrFormat("point %d is in set %d and in set %d%s", number, set_of_[i],
                                 open_set_, SinceBeginning()));
  }
  set_of_[i] = open_set_;
  instance_.sets[open_set_ - 1].push_back(static_cast<uint32_t>(i));
  return absl::OkStatus();
}

absl::Status Reader::EndFile() {
  const char* cut = ": is the file cut short?";
  if (open_set_ != 0)
    return Fault(absl::StrFormat("set %d does not end with -1%s", open_set_, cut));
  for (const char* section : {"NODE_COORD_SECTION", "GTSP_SET_SECTION"}) {
    if (!seen_.contains(section)) return Fault(absl::StrFormat("no %s%s", section, cut));
  }
  if (points_found_ != dimension_) {
    return Fault(absl::StrFormat("DIMENSION is %d, but there are %d points%s", dimension_,
                                 points_found_, cut));
  }
  if (sets_found_ != set_count_) {
    return Fault(
        absl::StrFormat("GTSP_SETS is %d, but there are %d sets%s", set_count_, sets_found_, cut));
  }
  for (size_t i = 0; i < dimension_; ++i) {
    if (set_of_[i] == 0) return Fault(absl::StrFormat("point %d is in no set", i + 1));
  }
  return absl::OkStatus();
}

void AddContour(const gtsp::Instance& instance, const std::vector<uint32_t>& points, size_t set,
                v1::Plan& plan) {
  v1::Contour& contour = *plan.add_paths()->mutable_contour();
  contour.set_id(set + 1);
  for (const uint32_t i : points) {
    contour.add_points(instance.points[i].x);
    contour.add_points(instance.points[i].y);
  }
}

// The tours through `first`, a point of the first set.
v1::Layer LayerFrom(const gtsp::Instance& instance, uint32_t first) {
  v1::Layer layer;
  layer.set_id(uint64_t{first} + 1);
  layer.mutable_start()->set_x_mm(instance.points[first].x);
  layer.mutable_start()->set_y_mm(instance.points[first].y);
  v1::Plan& plan = *layer.mutable_plan();
  for (size_t s = 0; s < instance.sets.size(); ++s) {
    if (s != instance.first_set) AddContour(instance, instance.sets[s], s, plan);
  }
  AddContour(instance, {first}, instance.first_set, plan);
  // The layer's order: the other sets, in any order, then the end.
  const auto sets = static_cast<uint32_t>(instance.sets.size());
  if (sets == 1) {
    plan.add_nodes()->set_path(0);
    return layer;
  }
  v1::InOrder& root = *plan.add_nodes()->mutable_in_order();
  root.add_children(1);
  root.add_children(sets + 1);
  v1::AnyOrder& others = *plan.add_nodes()->mutable_any_order();
  for (uint32_t path = 0; path < sets; ++path) {
    if (path + 1 < sets) others.add_children(path + 2);
    plan.add_nodes()->set_path(path);
  }
  return layer;
}

}  // namespace

absl::StatusOr<InputJob> ReadGtsp(std::string_view text, const std::string& name) {
  absl::StatusOr<gtsp::Instance> instance = Reader(name).Read(text);
  if (!instance.ok()) return instance.status();
  InputJob job;
  job.name = name;
  job.format = InputFormat::kGtsp;
  const std::vector<uint32_t>& first_set = instance->sets[instance->first_set];
  for (const uint32_t first : first_set) job.layers.push_back(LayerFrom(*instance, first));
  job.facts.emplace_back(
      "sets", absl::StrFormat("%d, of %d points", instance->sets.size(), instance->points.size()));
  job.facts.emplace_back("closed", absl::StrFormat("a layer for each of the %d points of set %d",
                                                   first_set.size(), instance->first_set + 1));
  job.gtsp = std::make_shared<const gtsp::Instance>(*std::move(instance));
  return job;
}

}  // namespace traverse

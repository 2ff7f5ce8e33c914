#include "client/files/json.h"

#include <cassert>
#include <nlohmann/json.hpp>
#include <utility>

namespace traverse {

Json::Json() = default;
Json::Json(std::nullptr_t) {}
Json::Json(bool value) : value_(JsonScalar(value)) {}
Json::Json(int value) : Json(int64_t{value}) {}
Json::Json(int64_t value) : value_(JsonScalar(value)) {}
Json::Json(uint32_t value) : Json(uint64_t{value}) {}
Json::Json(uint64_t value) : value_(JsonScalar(value)) {}
Json::Json(double value) : value_(JsonScalar(value)) {}
Json::Json(const char* text) : Json(std::string(text)) {}
Json::Json(std::string text) : value_(JsonScalar(std::move(text))) {}
Json::Json(std::string_view text) : Json(std::string(text)) {}
Json::Json(JsonArray items) : value_(std::move(items)) {}
Json::Json(JsonObject members) : value_(std::move(members)) {}
Json::Json(JsonScalar scalar) : value_(std::move(scalar)) {}

Json::Json(const Json&) = default;
Json::Json(Json&&) noexcept = default;
Json& Json::operator=(const Json&) = default;
Json& Json::operator=(Json&&) noexcept = default;
Json::~Json() = default;

namespace {

// The alternative T of a scalar; null if the value is anything else.
template <typename T, typename Value>
const T* ScalarOf(const Value& value) {
  const auto* scalar = std::get_if<JsonScalar>(&value);
  return scalar == nullptr ? nullptr : std::get_if<T>(scalar);
}

}  // namespace

bool Json::is_null() const { return std::holds_alternative<std::monostate>(value_); }
bool Json::is_array() const { return std::holds_alternative<JsonArray>(value_); }
bool Json::is_object() const { return std::holds_alternative<JsonObject>(value_); }

const bool* Json::Bool() const { return ScalarOf<bool>(value_); }
const uint64_t* Json::Unsigned() const { return ScalarOf<uint64_t>(value_); }
const std::string* Json::Text() const { return ScalarOf<std::string>(value_); }

std::optional<double> Json::Number() const {
  if (const auto* number = ScalarOf<double>(value_)) return *number;
  if (const auto* number = ScalarOf<int64_t>(value_)) return static_cast<double>(*number);
  if (const auto* number = ScalarOf<uint64_t>(value_)) return static_cast<double>(*number);
  return std::nullopt;
}

const JsonArray& Json::items() const {
  assert(is_array());
  return *std::get_if<JsonArray>(&value_);
}
JsonArray& Json::items() { return const_cast<JsonArray&>(std::as_const(*this).items()); }

const JsonObject& Json::members() const {
  assert(is_object());
  return *std::get_if<JsonObject>(&value_);
}
JsonObject& Json::members() { return const_cast<JsonObject&>(std::as_const(*this).members()); }

const Json* Json::Find(std::string_view name) const {
  if (!is_object()) return nullptr;
  const JsonObject& all = members();
  for (auto member = all.rbegin(); member != all.rend(); ++member) {
    if (member->name == name) return &member->value;
  }
  return nullptr;
}
Json* Json::Find(std::string_view name) {
  return const_cast<Json*>(std::as_const(*this).Find(name));
}

Json& Json::operator[](std::string_view name) {
  if (is_null()) value_ = JsonObject();
  if (Json* const found = Find(name)) return *found;
  members().push_back({std::string(name), nullptr});
  return members().back().value;
}

void Json::Append(JsonObject more) {
  JsonObject& all = members();
  for (JsonMember& member : more) all.push_back(std::move(member));
}

// Writes a value, as nlohmann lays it out.
class JsonWriter {
 public:
  explicit JsonWriter(int indent) : indent_(indent) {}

  void Write(const Json& json) {
    if (const auto* scalar = std::get_if<JsonScalar>(&json.value_)) {
      std::visit([&](const auto& value) { Leaf(value); }, *scalar);
    } else if (json.is_array()) {
      Group('[', json.items(), ']', [&](const Json& item) { Write(item); });
    } else if (json.is_object()) {
      Group('{', json.members(), '}', [&](const JsonMember& member) {
        Leaf(member.name);
        text_ += indent_ < 0 ? ":" : ": ";
        Write(member.value);
      });
    } else {
      text_ += "null";
    }
  }

  std::string text() && { return std::move(text_); }

 private:
  template <typename T>
  void Leaf(const T& value) {
    text_ += nlohmann::json(value).dump(-1, ' ', /*ensure_ascii=*/false,
                                        nlohmann::json::error_handler_t::replace);
  }

  template <typename Parts, typename WritePart>
  void Group(char begin, const Parts& parts, char end, WritePart write) {
    text_ += begin;
    ++level_;
    const char* divider = "";
    for (const auto& part : parts) {
      text_ += divider;
      BreakLine();
      write(part);
      divider = ",";
    }
    --level_;
    if (!parts.empty()) BreakLine();
    text_ += end;
  }

  void BreakLine() {
    if (indent_ < 0) return;
    text_ += '\n';
    text_.append(level_ * static_cast<size_t>(indent_), ' ');
  }

  const int indent_;
  size_t level_ = 0;
  std::string text_;
};

std::string JsonText(const Json& json, int indent) {
  JsonWriter writer(indent);
  writer.Write(json);
  return std::move(writer).text();
}

namespace {

// The parser's events as ours.
class ParserEvents {
 public:
  explicit ParserEvents(JsonEvents& events) : events_(events) {}

  bool null() { return events_.Null(); }
  bool boolean(bool value) { return events_.Scalar(value); }
  bool number_integer(int64_t value) { return events_.Scalar(value); }
  bool number_unsigned(uint64_t value) { return events_.Scalar(value); }
  bool number_float(double value, const std::string&) { return events_.Scalar(value); }
  bool string(std::string& value) { return events_.Scalar(std::move(value)); }
  bool binary(nlohmann::json::binary_t&) { return false; }  // only of other formats
  bool start_object(size_t) { return events_.BeginObject(); }
  bool key(std::string& name) { return events_.Key(name); }
  bool end_object() { return events_.EndObject(); }
  bool start_array(size_t) { return events_.BeginArray(); }
  bool end_array() { return events_.EndArray(); }

  bool parse_error(size_t, const std::string&, const nlohmann::json::exception& error) {
    // "[json.exception.parse_error.101] parse error at line 1, column 2: ..."
    const std::string_view what = error.what();
    const size_t bracket = what.find("] ");
    events_.Fault(what.substr(bracket == std::string_view::npos ? 0 : bracket + 2));
    return false;
  }

 private:
  JsonEvents& events_;
};

// Builds the document, but for the items of one array of it.
class Tree : public JsonEvents {
 public:
  Tree() = default;
  Tree(std::string_view name, const std::function<void(const Json&)>& take)
      : name_(name), take_(&take) {}

  bool Null() override { return Add(nullptr); }
  bool Scalar(JsonScalar value) override { return Add(Json(std::move(value))); }
  bool BeginObject() override { return Open(JsonObject()); }
  bool BeginArray() override { return Open(JsonArray()); }
  bool EndObject() override { return Close(); }
  bool EndArray() override { return Close(); }
  bool Key(std::string& name) override {
    open_.back().members().push_back({std::move(name), nullptr});
    return true;
  }
  void Fault(std::string_view) override {}

  Json& root() { return root_; }

 private:
  bool Open(Json json) {
    open_.push_back(std::move(json));
    return open_.size() <= kMostJsonDepth;
  }

  bool Close() {
    Json whole = std::move(open_.back());
    open_.pop_back();
    return Add(std::move(whole));
  }

  bool Add(Json json) {
    if (open_.empty()) {
      root_ = std::move(json);
    } else if (open_.back().is_object()) {
      open_.back().members().back().value = std::move(json);
    } else if (IsTaken()) {
      (*take_)(json);
    } else {
      open_.back().items().push_back(std::move(json));
    }
    return true;
  }

  // Whether what is open last is the array whose items are taken.
  bool IsTaken() const {
    return take_ != nullptr && open_.size() == 2 && open_[0].is_object() &&
           open_[0].members().back().name == name_;
  }

  std::string_view name_;
  const std::function<void(const Json&)>* take_ = nullptr;
  std::vector<Json> open_;  // from the outermost to the innermost
  Json root_;
};

std::optional<Json> Read(std::string_view text, Tree& tree) {
  if (!ReadJson(text, tree)) return std::nullopt;
  return std::move(tree.root());
}

}  // namespace

bool ReadJson(std::string_view text, JsonEvents& events) {
  ParserEvents parser_events(events);
  return nlohmann::json::sax_parse(text.begin(), text.end(), &parser_events);
}

std::optional<Json> ParseJson(std::string_view text) {
  Tree tree;
  return Read(text, tree);
}

std::optional<Json> ParseJson(std::string_view text, std::string_view name,
                              const std::function<void(const Json& item)>& take) {
  Tree tree(name, take);
  return Read(text, tree);
}

}  // namespace traverse

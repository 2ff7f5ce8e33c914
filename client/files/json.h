// JSON: values, read and written. The only file of the client that knows a library for it: in each
// file that used nlohmann's templates by itself, they took as long to compile as all else in it.

#ifndef TRAVERSE_CLIENT_FILES_JSON_H_
#define TRAVERSE_CLIENT_FILES_JSON_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace traverse {

class Json;
struct JsonMember;
using JsonArray = std::vector<Json>;
using JsonObject = std::vector<JsonMember>;  // in the order in which they are written

// What is neither null nor array nor object. A number that was read is whole, and then unsigned
// where it has no sign, if it is written without point and exponent and fits.
using JsonScalar = std::variant<bool, int64_t, uint64_t, double, std::string>;

// One value. Converts from what it may hold, so that a document is written as it looks:
// `JsonObject{{"at", JsonArray{x, y}}, {"name", name}}`.
class Json {
 public:
  Json();  // null
  Json(std::nullptr_t);
  Json(bool value);
  Json(int value);
  Json(int64_t value);
  Json(uint32_t value);
  Json(uint64_t value);
  Json(double value);
  Json(const char* text);
  Json(std::string text);
  Json(std::string_view text);
  Json(JsonArray items);
  Json(JsonObject members);
  explicit Json(JsonScalar scalar);

  Json(const Json&);
  Json(Json&&) noexcept;
  Json& operator=(const Json&);
  Json& operator=(Json&&) noexcept;
  ~Json();

  bool is_null() const;
  bool is_array() const;
  bool is_object() const;

  // Null if the value is of another kind. Number() is of every kind of number.
  const bool* Bool() const;
  const uint64_t* Unsigned() const;
  const std::string* Text() const;
  std::optional<double> Number() const;

  // REQUIRES: is_array().
  const JsonArray& items() const;
  JsonArray& items();
  // REQUIRES: is_object().
  const JsonObject& members() const;
  JsonObject& members();

  // The member of this name, the last one if a document has it twice; null if there is none, or
  // this is no object.
  const Json* Find(std::string_view name) const;
  Json* Find(std::string_view name);

  // The member of this name, which is added if there is none. REQUIRES: is_object(), or is_null(),
  // which becomes an object.
  Json& operator[](std::string_view name);

  // Adds members behind those that there are. REQUIRES: is_object().
  void Append(JsonObject members);

 private:
  friend class JsonWriter;
  std::variant<std::monostate, JsonScalar, JsonArray, JsonObject> value_;
};

struct JsonMember {
  std::string name;
  Json value;
};

// Null if there is no value.
template <typename T>
Json JsonOrNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

// `json` in one line, or with `indent` spaces a level. Names of files may be any bytes, and JSON is
// UTF-8: what is none comes out as U+FFFD. A number that is not finite comes out as null.
std::string JsonText(const Json& json, int indent = -1);

// Takes a document as it is read. One that returns false ends the reading.
class JsonEvents {
 public:
  virtual ~JsonEvents() = default;
  virtual bool Null() = 0;
  virtual bool Scalar(JsonScalar value) = 0;
  virtual bool BeginObject() = 0;
  virtual bool Key(std::string& name) = 0;
  virtual bool EndObject() = 0;
  virtual bool BeginArray() = 0;
  virtual bool EndArray() = 0;
  // The text is not JSON: `fault` is "parse error at line 1, column 2: ...", with what of the text
  // is at fault as it is.
  virtual void Fault(std::string_view fault) = 0;
};

// False if the text is not JSON, or an event returned false.
bool ReadJson(std::string_view text, JsonEvents& events);

// Unset if `text` is not JSON, or is nested more than kMostJsonDepth deep.
inline constexpr size_t kMostJsonDepth = 100;
std::optional<Json> ParseJson(std::string_view text);

// As ParseJson, but the items of the array `name` of the document go to `take` as soon as they are
// read, and the array stays empty: as one tree of values a large document would need many times
// its text's memory.
std::optional<Json> ParseJson(std::string_view text, std::string_view name,
                              const std::function<void(const Json& item)>& take);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_JSON_H_

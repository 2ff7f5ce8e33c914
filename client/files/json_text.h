// JSON as text, there and back. Compiled here alone: in each file that writes or reads a document
// by itself, nlohmann's templates take as long to compile as all else that is in it.

#ifndef TRAVERSE_CLIENT_FILES_JSON_TEXT_H_
#define TRAVERSE_CLIENT_FILES_JSON_TEXT_H_

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace traverse {

// `json` in one line, or with `indent` spaces a level. Names of files may be any bytes, and JSON is
// UTF-8: what is none comes out as U+FFFD.
std::string JsonText(const nlohmann::json& json, int indent = -1);
std::string JsonText(const nlohmann::ordered_json& json, int indent = -1);
std::string JsonText(const std::string& text);

// Discarded, and so of no other kind, if `text` is not JSON.
nlohmann::json ParseJson(std::string_view text);
nlohmann::ordered_json ParseOrderedJson(std::string_view text);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_JSON_TEXT_H_

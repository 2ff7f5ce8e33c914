#include "client/gcode/verify/machine/told_progress.h"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>
#include <vector>

#include "client/gcode/verify/machine/command_words.h"
#include "client/gcode/verify/text.h"

namespace traverse::gcode {
namespace {

bool IsOfWord(char c) { return UpperCase(c) >= 'A' && UpperCase(c) <= 'Z'; }
bool IsOfNumber(char c) { return c >= '0' && c <= '9'; }

// A word in capitals, a number ("#"), or one of `%`, `/`, `:`, `=`.
struct Token {
  std::string text;
  double number = 0;
};

std::vector<Token> TokensOf(std::string_view text) {
  std::vector<Token> tokens;
  for (size_t at = 0; at < text.size();) {
    Token token;
    if (IsOfNumber(text[at])) {
      const auto read = std::from_chars(text.data() + at, text.data() + text.size(), token.number);
      token.text.push_back('#');
      at = static_cast<size_t>(read.ptr - text.data());
    } else if (IsOfWord(text[at])) {
      while (at < text.size() && IsOfWord(text[at])) token.text.push_back(UpperCase(text[at++]));
    } else {
      token.text.push_back(text[at++]);
      if (std::string_view("%/:=").find(token.text) == std::string_view::npos) continue;
    }
    tokens.push_back(std::move(token));
  }
  return tokens;
}

bool Is(const std::vector<Token>& tokens, size_t i, std::string_view text) {
  return i < tokens.size() && tokens[i].text == text;
}

}  // namespace

bool CommentTellsProgress(std::string_view line) {
  if (line.find_first_of(":=") == std::string_view::npos) return false;
  const std::vector<Token> tokens = TokensOf(line);
  bool tells = false;
  for (size_t i = 0; i < tokens.size(); ++i) {
    const std::string& word = tokens[i].text;
    if (word == ":" || word == "=") return tells && Is(tokens, i + 1, "#");
    tells |= word == "ELAPSED" || word == "REMAINING" || word == "PROGRESS";
    tells |=
        word == "TIME" && (Is(tokens, i + 1, "LEFT") || (i > 0 && Is(tokens, i - 1, "PRINTING")));
    tells |= word == "NUM" && Is(tokens, i + 1, "/") && Is(tokens, i + 2, "TOTAL");
  }
  return false;
}

bool MessageTellsProgress(std::string_view line) {
  const std::vector<Token> tokens =
      TokensOf(line.substr(std::min(line.find_first_of(" \t"), line.size())));
  bool number = false;
  bool time = false;
  for (size_t i = 0; i < tokens.size(); ++i) {
    const std::string& word = tokens[i].text;
    number |= word == "#";
    time |= word == "LEFT" || word == "REMAIN" || word == "REMAINING" || word == "ELAPSED";
    if (word != "#") continue;
    if (Is(tokens, i + 1, "%")) return true;
    if ((Is(tokens, i + 1, "/") || Is(tokens, i + 1, "OF")) && Is(tokens, i + 2, "#")) return true;
  }
  return number && time;
}

double PercentTold(std::string_view line) {
  if (line[0] == ';') return -1;
  if (BeginsInAnyCase(line, "M73")) {
    const CommandWords words(WordsOf(line));
    return static_cast<double>(words.ValueOr('P', words.ValueOr('Q', -1'000'000))) * kMicro;
  }
  if (BeginsInAnyCase(line, "M532")) {
    const CommandWords words(WordsOf(line));
    return static_cast<double>(words.ValueOr('X', -1'000'000)) * kMicro;
  }
  const std::vector<Token> tokens = TokensOf(line);
  for (size_t i = 0; i < tokens.size(); ++i) {
    if (Is(tokens, i, "#") && Is(tokens, i + 1, "%")) return tokens[i].number;
  }
  return -1;
}

}  // namespace traverse::gcode

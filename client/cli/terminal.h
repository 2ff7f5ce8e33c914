// What the user's terminal supports.

#ifndef TRAVERSE_CLIENT_CLI_TERMINAL_H_
#define TRAVERSE_CLIENT_CLI_TERMINAL_H_

#include <cstdio>
#include <string>

#include "client/report/table.h"

namespace traverse::cli {

// True if `file` is a terminal that understands cursor movement.
bool IsTerminal(std::FILE* file);

// True if text on `file` may be colored: it is a terminal, and the user has not set NO_COLOR
// (https://no-color.org).
bool MayColor(std::FILE* file);

// Columns of the terminal behind `file`; 80 if unknown.
int TerminalWidth(std::FILE* file);

// The style of tables on `file`: as wide as the terminal, otherwise as a page.
report::TextStyle StyleFor(std::FILE* file);

// Writes all of `text`.
void Print(std::FILE* file, const std::string& text);

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_TERMINAL_H_

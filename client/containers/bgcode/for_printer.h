// G-code as a printer reads it, so that text and binary can be compared.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_FOR_PRINTER_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_FOR_PRINTER_H_

#include <string>
#include <string_view>

#include "client/containers/container.h"

namespace traverse::containers {

// `text` with spaces in moves as MeatPack restores them, and without the comments that binary
// G-code does not keep: those before the first command and after the last one, and entries (`; key
// = value`) anywhere, which are metadata; with kLines also those behind commands and empty ones,
// with kNone all of them. The line that Traverse adds stays. Lines keep their numbers.
std::string ForPrinter(std::string_view text, CommentsKept kept);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_FOR_PRINTER_H_

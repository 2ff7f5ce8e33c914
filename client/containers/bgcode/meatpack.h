// MeatPack: G-code with two characters in a byte, as files of .bgcode have it.
//
// While packing is on, each byte holds two characters, the first in its low half: 0 to 9, '.',
// 'E' (without the mode for no spaces: ' '), line end, 'G', 'X'; 15 means that the character
// follows as a byte of its own. A line end in the low half ends the pair: each line begins with a
// byte. FF FF and a byte are a command: 251 packing on, 250 off, 249 both modes off, 247 no spaces,
// 246 spaces.
//
// In lines that begin with G and a digit spaces say nothing; they are left out, and put back before
// each letter when the text is decoded. All else keeps every byte: lines that begin with ';' are
// written as they are, with packing off, as PrusaSlicer does; so is a last line without its end.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse::containers {

// Appends `text`, packed, to `out`. REQUIRES: CanMeatPack(text).
void MeatPack(std::string_view text, std::string& out);

// False if `text` holds a byte 0xFF, which is no part of any UTF-8 text and which MeatPack lacks.
bool CanMeatPack(std::string_view text);

// Appends the text that `packed` is to `out`, with spaces in lines of G. Packing is off at first.
// InvalidArgument if `packed` ends within a pair or a command, or holds an unknown command;
// ResourceExhausted if `out` would become longer than `max_bytes`.
absl::Status MeatUnpack(std::string_view packed, size_t max_bytes, std::string& out);

// Appends `line`, one without its end, as MeatUnpack gives it back.
void AppendAsUnpacked(std::string_view line, std::string& out);

// True if a printer reads the same in both: equal but for the spaces that MeatPack leaves out.
bool EqualToAPrinter(std::string_view a, std::string_view b);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_

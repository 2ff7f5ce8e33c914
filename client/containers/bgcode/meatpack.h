// MeatPack: G-code with two characters per byte, as in .bgcode files.
//
// While packing is on, each byte holds two characters, the first in its low half: 0 to 9, '.', 'E'
// (without the mode for no spaces: ' '), line end, 'G', 'X'; 15 means that the character follows
// as a separate byte. A line end in the low half ends the pair, so each line begins with a byte.
// FF FF and a byte are a command: 251 packing on, 250 off, 249 both modes off, 247 no spaces, 246
// spaces.
//
// In lines that begin with G and a digit, spaces mean nothing: the packer drops them, and the
// unpacker puts them back before each letter. Everything else keeps every byte: lines that begin
// with ';' are written unpacked, as PrusaSlicer does, and so is a last line without its end.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_
#define TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_

#include <cstddef>
#include <string>
#include <string_view>

#include "absl/status/status.h"

namespace traverse::containers {

// Appends `text`, packed, to `out`. REQUIRES: CanMeatPack(text).
void MeatPack(std::string_view text, std::string& out);

// False if `text` has a byte 0xFF, which no UTF-8 text contains and MeatPack cannot express.
bool CanMeatPack(std::string_view text);

// Appends the text of `packed` to `out`, with spaces in lines of G. Packing is off at first.
// InvalidArgument if `packed` ends within a pair or a command, or has an unknown command;
// ResourceExhausted if `out` would become longer than `max_bytes`.
absl::Status MeatUnpack(std::string_view packed, size_t max_bytes, std::string& out);

// Appends `line`, without its end, in the form in which MeatUnpack restores it.
void AppendAsUnpacked(std::string_view line, std::string& out);

// True if a printer reads both alike: they are equal except for the spaces that MeatPack drops.
bool EqualToAPrinter(std::string_view a, std::string_view b);

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BGCODE_MEATPACK_H_

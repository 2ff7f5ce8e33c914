// Little-endian numbers in bytes, as both kinds of container have them.

#ifndef TRAVERSE_CLIENT_CONTAINERS_BYTES_H_
#define TRAVERSE_CLIENT_CONTAINERS_BYTES_H_

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace traverse::containers {

// The number at `offset`. REQUIRES: it lies within `bytes`.
inline uint16_t LoadU16(std::string_view bytes, size_t offset) {
  assert(offset + 2 <= bytes.size());
  const auto at = [&](size_t i) { return static_cast<uint8_t>(bytes[offset + i]); };
  return static_cast<uint16_t>(at(0) | at(1) << 8);
}

inline uint32_t LoadU32(std::string_view bytes, size_t offset) {
  return LoadU16(bytes, offset) | static_cast<uint32_t>(LoadU16(bytes, offset + 2)) << 16;
}

inline void AppendU16(std::string& out, uint16_t value) {
  out.push_back(static_cast<char>(value & 0xff));
  out.push_back(static_cast<char>(value >> 8));
}

inline void AppendU32(std::string& out, uint32_t value) {
  AppendU16(out, static_cast<uint16_t>(value & 0xffff));
  AppendU16(out, static_cast<uint16_t>(value >> 16));
}

// Puts `value` in place of the number at `offset`. REQUIRES: it lies within `bytes`.
inline void StoreU16(std::string& bytes, size_t offset, uint16_t value) {
  assert(offset + 2 <= bytes.size());
  bytes[offset] = static_cast<char>(value & 0xff);
  bytes[offset + 1] = static_cast<char>(value >> 8);
}

inline void StoreU32(std::string& bytes, size_t offset, uint32_t value) {
  StoreU16(bytes, offset, static_cast<uint16_t>(value & 0xffff));
  StoreU16(bytes, offset + 2, static_cast<uint16_t>(value >> 16));
}

}  // namespace traverse::containers

#endif  // TRAVERSE_CLIENT_CONTAINERS_BYTES_H_

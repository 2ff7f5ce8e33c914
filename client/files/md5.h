// MD5 in the form in which G-code and files beside it state it, by OpenSSL.

#ifndef TRAVERSE_CLIENT_FILES_MD5_H_
#define TRAVERSE_CLIENT_FILES_MD5_H_

#include <optional>
#include <string>
#include <string_view>

namespace traverse {

// 32 digits in capitals. Empty if the system's OpenSSL refuses MD5.
std::string Md5Hex(std::string_view bytes);

// The 32 hexadecimal digits in `stated`, in capitals; unset if there are not exactly 32.
std::optional<std::string> FindMd5(std::string_view stated);

// `stated` with another digest in its place: in the same case, with the same characters around it.
// REQUIRES: FindMd5(stated).
std::string WithMd5(std::string_view stated, const std::string& digest);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FILES_MD5_H_

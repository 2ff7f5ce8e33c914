// Recognises the format of a file.

#ifndef TRAVERSE_CLIENT_FORMATS_DETECT_H_
#define TRAVERSE_CLIENT_FORMATS_DETECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "client/input/input_job.h"

namespace traverse {

// The format of `bytes` (decompressed), judged by their content. Of text it looks at the first
// thousand lines, each of which may look like a record of DAMAT, a line of G-code or a key of
// GTSPLIB. Containers of G-code begin with a magic number, JSON begins with a brace; binary data
// that begin like an OptimizeBatchRequest are kProto. Unset if nothing fits.
std::optional<InputFormat> DetectByContent(std::string_view bytes);

// The format by the extension of `name`, ignoring `.gz`, `.xz` and case; unset if it is
// unknown.
std::optional<InputFormat> DetectByExtension(const std::string& name);

// "DAMAT", "G-code", "JSON", "protobuf", "GTSPLIB".
const char* FormatName(InputFormat format);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_DETECT_H_

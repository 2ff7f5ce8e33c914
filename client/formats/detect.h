// Which format a file is in.

#ifndef TRAVERSE_CLIENT_FORMATS_DETECT_H_
#define TRAVERSE_CLIENT_FORMATS_DETECT_H_

#include <optional>
#include <string>
#include <string_view>

#include "client/input/input_job.h"

namespace traverse {

// The format of `bytes` (decompressed) by what they look like: the first thousand lines of text are
// asked, of which each may look like a record of DAMAT, a line of G-code or a key of GTSPLIB;
// containers of G-code begin with a magic number; JSON begins with a brace; what is not text but
// begins as a message of OptimizeBatchRequest does is kProto. Nothing if there is no sign.
std::optional<InputFormat> DetectByContent(std::string_view bytes);

// The format by the extension of `name`, `.gz` and `.xz` ignored, capitals as small letters;
// nothing if the extension is none of ours.
std::optional<InputFormat> DetectByExtension(const std::string& name);

// "DAMAT", "G-code", "JSON", "protobuf", "GTSPLIB".
const char* FormatName(InputFormat format);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_FORMATS_DETECT_H_

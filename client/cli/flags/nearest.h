// Guesses what a mistyped word was meant to be.

#ifndef TRAVERSE_CLIENT_CLI_FLAGS_NEAREST_H_
#define TRAVERSE_CLIENT_CLI_FLAGS_NEAREST_H_

#include <string>

#include "absl/types/span.h"

namespace traverse::cli {

// The word of `known` that `word` probably means; empty if none is near.
std::string Nearest(const std::string& word, absl::Span<const std::string> known);

// "; did you mean NEAREST?", or an empty text.
std::string DidYouMean(const std::string& word, absl::Span<const std::string> known,
                       const std::string& prefix = "");

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_FLAGS_NEAREST_H_

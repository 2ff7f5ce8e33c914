// The feature that a block of the file belongs to.

#ifndef TRAVERSE_CLIENT_GCODE_MODEL_BLOCK_FEATURE_H_
#define TRAVERSE_CLIENT_GCODE_MODEL_BLOCK_FEATURE_H_

#include <string_view>

#include "client/gcode/dialects/feature.h"
#include "client/gcode/model/gcode_file.h"

namespace traverse::gcode {

// The name of the type in force at `block`; empty if there is none.
std::string_view TypeOf(const GcodeFile& file, const Block& block);

// The feature of that name; kCount if there is none, or it is unknown.
Feature NamedFeature(const GcodeFile& file, const Block& block);

// The feature of `block`: by its type, else by the comment on its first line (Slic3r with verbose
// G-code), else by its shape, `closed` or not.
Feature FeatureOf(const GcodeFile& file, const Block& block, bool closed);

}  // namespace traverse::gcode

#endif  // TRAVERSE_CLIENT_GCODE_MODEL_BLOCK_FEATURE_H_

// What a reader makes of a file: a job for the service, and what the file knows beyond it.

#ifndef TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_
#define TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

struct GcodeFile;  // client/gcode: the text and its parts, for the writer

namespace gtsp {
struct Instance;  // client/gtsp
}

// The formats that the client reads.
enum class InputFormat {
  kDamat,
  kGcode,
  kJson,   // OptimizeBatchRequest in protobuf's JSON mapping
  kProto,  // OptimizeBatchRequest on the wire
  kGtsp,   // GTSPLIB
};

// What is known of the paths of one layer that is a plan, beside the plan; either list may be
// empty. Layers of islands need none of it.
struct PathNotes {
  // `feature[i]`: index into InputJob::features of what Plan.paths[i] is (wall, infill, ...).
  std::vector<uint16_t> feature;

  // `island[i]`: label of the island that Plan.paths[i] lies in, as --json states it.
  std::vector<uint32_t> island;
};

// One file's work. Labels for --json are the ids in the layers: Layer.id, Island.id, Contour.id,
// OpenPath.id. Open paths hold all their points, so that they can be drawn; what goes to the
// service is stripped to the ends by client/api.
struct InputJob {
  // As the user named it; "-" for standard input.
  std::string name;
  InputFormat format = InputFormat::kDamat;

  // What the file itself says of how the job is done: start, cost model, idle speed and, in the
  // service's own formats, all the rest. Fields that the file is silent on are unset. Flags of the
  // command line override it.
  v1::JobOptions options;

  // Of DAMAT alone: the far corner of the build envelope, whose near corner is (0, 0).
  std::optional<v1::Point> envelope;

  // The layers in build order: those of the file, or the stretch of them that was asked for.
  std::vector<v1::Layer> layers;

  // Position in the file of layers[0].
  size_t first_layer = 0;

  // Names of features, such as "External perimeter"; PathNotes refer to them by index.
  std::vector<std::string> features;

  // One for each layer, or empty if nothing is known.
  std::vector<PathNotes> notes;

  // What `inspect` prints of the file as a whole, in this order: ("slicer", "PrusaSlicer 2.5.0").
  std::vector<std::pair<std::string, std::string>> facts;

  // Of G-code alone: the file as read. Null otherwise.
  std::shared_ptr<const GcodeFile> gcode;

  // Of GTSPLIB alone: the instance. Null otherwise.
  std::shared_ptr<const gtsp::Instance> gtsp;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_

// What a reader makes of a file: a job for the service, and other facts about the file.

#ifndef TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_
#define TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "client/input/input_format.h"
#include "traverse/v1/options.pb.h"
#include "traverse/v1/plan.pb.h"

namespace traverse {

struct GcodeFile;  // client/gcode: the text and its parts, for the writer

namespace gcode {
class HiddenMoves;  // client/gcode/hidden
}

namespace gtsp {
struct Instance;  // client/gtsp
}

// Notes on the paths of one layer that is a plan; either list may be empty. Layers of islands need
// none.
struct PathNotes {
  // `feature[i]`: index into InputJob::features for Plan.paths[i] (wall, infill, ...).
  std::vector<uint16_t> feature;

  // `island[i]`: label of the island of Plan.paths[i], as --json states it.
  std::vector<uint32_t> island;
};

// One file's work. Labels for --json are the ids in the layers: Layer.id, Island.id, Contour.id,
// OpenPath.id. Open paths have all their points, so that they can be drawn; client/api sends only
// their ends to the service.
struct InputJob {
  // As the user named it; "-" for standard input.
  std::string name;
  InputFormat format = InputFormat::kDamat;

  // What the file says about how to do the job: start, cost model, idle speed and, in the service's
  // own formats, everything else. Fields that the file does not mention are unset. Flags on the
  // command line override it.
  v1::JobOptions options;

  // Only for DAMAT: the far corner of the build envelope, whose near corner is (0, 0).
  std::optional<v1::Point> envelope;

  // The layers in build order: those of the file, or the requested range of them.
  std::vector<v1::Layer> layers;

  // Position in the file of layers[0].
  size_t first_layer = 0;

  // Names of features, such as "External perimeter"; PathNotes refer to them by index.
  std::vector<std::string> features;

  // One for each layer, or empty if there are none.
  std::vector<PathNotes> notes;

  // What `inspect` prints about the file, in this order: ("slicer", "PrusaSlicer 2.5.0").
  std::vector<std::pair<std::string, std::string>> facts;

  // Only for G-code: the file as read. Otherwise null.
  std::shared_ptr<const GcodeFile> gcode;

  // Only for G-code, and if travel that nobody can see is written in another way for that.
  std::shared_ptr<const gcode::HiddenMoves> hidden;

  // Only for GTSPLIB: the instance. Otherwise null.
  std::shared_ptr<const gtsp::Instance> gtsp;
};

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_INPUT_INPUT_JOB_H_

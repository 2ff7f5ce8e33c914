// Writes DAMAT (format.h).

#ifndef TRAVERSE_CLIENT_DAMAT_WRITER_H_
#define TRAVERSE_CLIENT_DAMAT_WRITER_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/input/input_job.h"

namespace traverse {

// `job` as DAMAT, each coordinate with the digits that give it back exactly: reading it again gives
// the same layers, z where all layers are equally thick from the bed on. Without an envelope of its
// own the job's bounding box stands in M. InvalidArgument with the place for what DAMAT cannot
// hold: a layer that is a plan or that has a start or a cost of its own, limited entries, one-way
// paths, repeated ids, contours outside the first one of their island.
absl::StatusOr<std::string> WriteDamat(const InputJob& job);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_DAMAT_WRITER_H_

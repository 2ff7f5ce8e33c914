// Writes DAMAT (format.h).

#ifndef TRAVERSE_CLIENT_DAMAT_WRITER_H_
#define TRAVERSE_CLIENT_DAMAT_WRITER_H_

#include <string>

#include "absl/status/statusor.h"
#include "client/input/input_job.h"

namespace traverse {

// `job` as DAMAT, with enough digits to restore each coordinate exactly. Reading it again gives the
// same layers, and z too if all layers are equally thick from the bed on. If the job has no
// envelope, M has its bounding box. InvalidArgument, with the position, for what DAMAT cannot hold:
// a layer that is a plan or has a start or a cost of its own, limited entries, one-way paths,
// repeated ids, contours outside the first one of their island.
absl::StatusOr<std::string> WriteDamat(const InputJob& job);

}  // namespace traverse

#endif  // TRAVERSE_CLIENT_DAMAT_WRITER_H_

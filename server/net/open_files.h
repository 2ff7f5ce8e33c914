// The files that the process may have open at a time, sockets among them, and who may have how
// many.
//
// Whoever opens files for callers asks for his part of them: connections, requests, results that
// are kept. So whatever one of them has taken, the others can open theirs, and the process its log,
// its certificates, and connections to other servers.

#ifndef TRAVERSE_SERVER_NET_OPEN_FILES_H_
#define TRAVERSE_SERVER_NET_OPEN_FILES_H_

namespace traverse {

// How many files may be open now (RLIMIT_NOFILE).
int MaxOpenFiles();

// `part` of those that are not the process's own, by the limit of this moment. REQUIRES: 0 < part
// <= 1.
int FilesFor(double part);

// How many things of `files_each` files each there may be in that part: `wanted`, or as many as it
// has room for, but one at least.
int PlacesFor(double part, int files_each, int wanted);

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_OPEN_FILES_H_

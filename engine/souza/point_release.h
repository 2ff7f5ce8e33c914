// Point release: chooses the entry of one visit again, between its two neighbors. The order stays.
//
//   before   a ------> p@3 ------> b         p@i: path p, entered at its entry i
//   after    a ---> p@17 ---> b
//
// Source: [S] (Souza et al. 2017), SPEC 3.4; here for open paths as well, where the entry is the
// direction.

#ifndef TRAVERSE_ENGINE_SOUZA_POINT_RELEASE_H_
#define TRAVERSE_ENGINE_SOUZA_POINT_RELEASE_H_

#include "engine/base/budget.h"
#include "engine/souza/search_route.h"

namespace traverse {

// The change of cost, in the unit of the layer's cost, if the visit at `position` were entered at
// `entry` (of the layer's table); negative is better. REQUIRES: 0 <= position < route.size(), and
// `entry` is one of that path.
double PointReleaseDelta(const SearchRoute& route, int position, int entry);

// Which paths point release works on.
enum class Released {
  kAll,
  kOpenPaths,  // only directions: the second pass of NI2OPT, SPEC 3.3
};

// Gives each pending visit its best entry until nothing improves. Returns the change of cost, <= 0.
// O(m) for a visit with m entries.
double ReleasePoints(SearchRoute& route, Released released, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_POINT_RELEASE_H_

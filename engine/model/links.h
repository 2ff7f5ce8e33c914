// What lies between two paths besides the move of the head: how it leaves the one and comes to the
// other.

#ifndef TRAVERSE_ENGINE_MODEL_LINKS_H_
#define TRAVERSE_ENGINE_MODEL_LINKS_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "engine/model/plan.h"
#include "engine/model/point.h"
#include "engine/model/route.h"

namespace traverse {

// Times in s, at least 0: if the move behind a departure, or before an arrival, retracts or not.
// The retracted one is not less than the open one.
struct LinkSeconds {
  double open = 0;
  double retracted = 0;

  friend bool operator==(const LinkSeconds&, const LinkSeconds&) = default;
};

struct Departure {
  std::optional<Point> from;  // where the move begins; unset: at the exit
  LinkSeconds seconds;
};

// Each list is empty, has one element for the whole path, or one for each of Path::points: for the
// exit and for the entry there. One departure for several exits has no `from`.
struct PathLinks {
  std::vector<Departure> departures;
  std::vector<LinkSeconds> arrivals;
};

// [path]; empty: the head leaves each path at its exit, and departures and arrivals take no time.
// Seconds count if CostSpec::kind is kTime.
using LayerLinks = std::vector<PathLinks>;

// The number of points at which `path` may be left.
size_t ExitCount(const Path& path);

// Whether `links` are as the comments above state, of the paths of `plan`.
bool LinksFit(const LayerLinks& links, const Plan& plan);

// How the head leaves the path of `visit`, and what the arrival there takes.
Departure DepartureOf(const LayerLinks& links, const Plan& plan, const Visit& visit);
LinkSeconds ArrivalOf(const LayerLinks& links, const Visit& visit);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_MODEL_LINKS_H_

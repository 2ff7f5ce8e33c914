// The closed tour of a GTSPLIB instance, as published values count it.

#ifndef TRAVERSE_CLIENT_GTSP_TOUR_H_
#define TRAVERSE_CLIENT_GTSP_TOUR_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gtsp/instance.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gtsp {

// The distance EUC_2D of TSPLIB: the true one, rounded to the nearest whole number.
int64_t RoundedDistance(const Instance::Point& a, const Instance::Point& b);

struct Tour {
  int64_t rounded_length =
      0;  // the sum of RoundedDistance from each point to the next, and back to the first
  std::vector<uint32_t> points;  // from 0, one of each set
};

// The tour of the layer with the least travel. The service minimises true distances, and the
// published values are of rounded ones: the sets stay in the order found, and of each set the point
// is chosen again, exactly, for rounded distances. Time: the product of the sizes of each two sets
// that follow each other, times the smallest set's. REQUIRES: `layers` answer layers of ReadGtsp
// for `instance`, at least one, and passed CheckVisits.
Tour BestTour(const Instance& instance, absl::Span<const v1::LayerResult> layers);

}  // namespace traverse::gtsp

#endif  // TRAVERSE_CLIENT_GTSP_TOUR_H_

// The closed tour of a GTSPLIB instance, measured as published values are.

#ifndef TRAVERSE_CLIENT_GTSP_TOUR_H_
#define TRAVERSE_CLIENT_GTSP_TOUR_H_

#include <cstdint>
#include <vector>

#include "absl/types/span.h"
#include "client/gtsp/instance.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::gtsp {

// The distance EUC_2D of TSPLIB: the true distance, rounded to the nearest whole number.
int64_t RoundedDistance(const Instance::Point& a, const Instance::Point& b);

struct Tour {
  int64_t rounded_length =
      0;  // the sum of RoundedDistance from each point to the next, and back to the first
  std::vector<uint32_t> points;  // from 0, one of each set
};

// The tour of the layer with the least travel. The service minimises true distances, while
// published values use rounded ones. So the sets stay in the order found, and the point of each set
// is chosen again, exactly, for rounded distances. Time: the product of the sizes of each two
// successive sets, times that of the smallest. REQUIRES: `layers` answer layers of ReadGtsp for
// `instance`, at least one, and passed CheckVisits.
Tour BestTour(const Instance& instance, absl::Span<const v1::LayerResult> layers);

}  // namespace traverse::gtsp

#endif  // TRAVERSE_CLIENT_GTSP_TOUR_H_

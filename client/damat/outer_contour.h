// Finds the contour that encloses an island, by geometry.

#ifndef TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_
#define TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_

#include <vector>

#include "traverse/v1/plan.pb.h"

namespace traverse::damat {

struct OuterContour {
  int index = 0;  // of the contour with the largest area; the first one if none has any

  // Contours that lie outside it with all their vertices, in the given order.
  std::vector<int> outside;
};

// O(vertices) in the usual case, contours that lie apart or within each other. If it would take
// long, for very many contours with very many vertices, compares only bounding boxes.
OuterContour FindOuterContour(const v1::Island& island);

}  // namespace traverse::damat

#endif  // TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_

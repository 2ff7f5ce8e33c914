// Which contour of an island encloses it, by geometry.

#ifndef TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_
#define TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_

#include <vector>

#include "traverse/v1/plan.pb.h"

namespace traverse::damat {

struct OuterContour {
  int index = 0;  // of the contour with the largest area; the first one if none has any

  // Contours that lie outside it with all their vertices, in the order given.
  std::vector<int> outside;
};

// O(vertices) where contours lie apart or within each other, as they do; for islands of very many
// contours of very many vertices, where that would take long, bounding boxes alone are compared.
OuterContour FindOuterContour(const v1::Island& island);

}  // namespace traverse::damat

#endif  // TRAVERSE_CLIENT_DAMAT_OUTER_CONTOUR_H_

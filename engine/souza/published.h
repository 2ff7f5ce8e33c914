// Métodos 2 and 3 of Souza et al. (2017) as published, with nothing of ours among them.
//
//   contours   nearest insertion, then 2-opt; the vertices chosen at insertion stay
//   rasters    the same on pairs of ends, from where the contours end; a reversed stretch of the
//              2-opt may be a single raster, which is the second pass of thesis 2.6.2
//   Método 3   then point release over the whole route, until nothing improves
//
// Source: [S] section 2, thesis 2.6.2 (p. 49, after Volpato et al. 2019); SPEC 3.3 and 3.4. On any
// plan: the parts that are done one after the other (StagesOf) take the roles of contours and
// rasters.

#ifndef TRAVERSE_ENGINE_SOUZA_PUBLISHED_H_
#define TRAVERSE_ENGINE_SOUZA_PUBLISHED_H_

#include "engine/base/budget.h"
#include "engine/cost/layer_view.h"
#include "engine/model/route.h"

namespace traverse {

// The route of Método 2, or with `point_release` of Método 3. It may be longer than any other: no
// other method's route replaces it. The given order if the budget runs out first.
Route PublishedRoute(const LayerView& layer, bool point_release, Budget& budget);

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_SOUZA_PUBLISHED_H_

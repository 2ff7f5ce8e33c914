// The page of --report: one self-contained HTML file.
//
// The page itself is web/bundle/page.html, built from the sources in web/src and contained in this
// program. The scene goes into it as data:
//
//   @SCENE@   one JSON object: titles, features with colors, figures by route and layer
//   @LAYERS@  a script element `layer-I` for each layer with its LayerCode, deflated, in base64; it
//             is read when it is looked at. The first one on view comes first, so that there is
//             something to see while the rest is being loaded.

#ifndef TRAVERSE_CLIENT_VIEW_REPORT_PAGE_H_
#define TRAVERSE_CLIENT_VIEW_REPORT_PAGE_H_

#include <string>

#include "client/view/scene/scene.h"

namespace traverse::view {

// The file. `made` is the line at its foot that names the program that made it. Uses `threads`
// threads; the same scene gives the same bytes on any number of them.
std::string ReportPage(const Scene& scene, const std::string& made, int threads);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_REPORT_PAGE_H_

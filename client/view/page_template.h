// The page of --report before a scene is put into it: web/bundle/page.html, as built in.

#ifndef TRAVERSE_CLIENT_VIEW_PAGE_TEMPLATE_H_
#define TRAVERSE_CLIENT_VIEW_PAGE_TEMPLATE_H_

#include <string_view>

namespace traverse::view {

std::string_view PageTemplate();

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_PAGE_TEMPLATE_H_

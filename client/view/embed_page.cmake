# Writes a C++ source that holds a file's bytes: cmake -DINPUT=page.html -DOUTPUT=page_template.cc -P embed_page.cmake
file(READ ${INPUT} bytes HEX)
string(REGEX REPLACE "(................................)" "\\1\n" bytes "${bytes}")
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUTPUT}
"#include \"client/view/page_template.h\"

namespace traverse::view {
namespace {

constexpr unsigned char kPage[] = {
${bytes}};

}  // namespace

std::string_view PageTemplate() {
  return {reinterpret_cast<const char*>(kPage), sizeof(kPage)};
}

}  // namespace traverse::view
")

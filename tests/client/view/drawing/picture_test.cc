// One layer before and after: client/view/picture.h.

#include "client/view/drawing/picture.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/view/drawing/canvas.h"
#include "client/view/drawing/markup.h"
#include "tests/support/golden.h"

namespace traverse::view {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

// A square, a dot and a line; the route shown does them in another order.
Scene SmallScene() {
  Scene scene;
  scene.title = "<odd> & \"title\".gcode";
  scene.features = {"outer wall", "sparse infill"};
  scene.layer_ids = {7};
  scene.layer_z_mm = {0.25};
  scene.first_layer = 4;
  scene.routes.resize(2);
  scene.routes[0].layers = {{100, 1, 3}};
  scene.routes[1].layers = {{75, 1, 1}};
  scene.layer = [](size_t) {
    DrawnLayer layer;
    layer.paths = {{0, true, {{0, 0}, {10, 0}, {10, 10}, {0, 10}}},
                   {0, true, {{20, 5}}},
                   {1, false, {{0, 20}, {10, 20}}}};
    layer.routes = {{{0, -5}, {{0, 0, {}}, {1, 0, {}}, {2, 0, {}}}},
                    {{0, -5}, {{0, 1, {}}, {1, 0, {{20, 0}}}, {2, 1, {}}}}};
    return layer;
  };
  return scene;
}

TEST(Picture, MatchesItsGolden) {
  EXPECT_TRUE(
      testing::MatchesGolden("view/picture.svg", Picture(SmallScene(), 0, PictureFormat::kSvg)));
}

TEST(Picture, TextsCannotBreakOutOfTheMarkup) {
  const std::string svg = Picture(SmallScene(), 0, PictureFormat::kSvg);

  EXPECT_THAT(svg, HasSubstr("&lt;odd&gt; &amp; &quot;title&quot;.gcode, layer 5, z = 0.25"));
  EXPECT_THAT(svg, Not(HasSubstr("<odd>")));
}

TEST(Picture, IsAPngOfTwoPixelsAUnit) {
  const std::string png = Picture(SmallScene(), 0, PictureFormat::kPng);

  ASSERT_GT(png.size(), 1000u);
  EXPECT_THAT(png, StartsWith("\x89PNG\r\n\x1a\n"));
  const auto number = [&](size_t at) {
    return (static_cast<uint8_t>(png[at + 2]) << 8) + static_cast<uint8_t>(png[at + 3]);
  };
  EXPECT_EQ(number(16), 2360);  // the width in IHDR
}

TEST(Picture, LayersWithoutPathsAndOfOnePointHaveOneToo) {
  Scene scene = SmallScene();
  scene.layer = [](size_t) {
    DrawnLayer layer;
    layer.routes.resize(2);
    return layer;
  };
  const std::string svg = Picture(scene, 0, PictureFormat::kSvg);
  EXPECT_THAT(svg, HasSubstr("start</text>"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_GT(Picture(scene, 0, PictureFormat::kPng).size(), 500u);
}

TEST(PictureFormatOf, IsTheEndOfTheName) {
  EXPECT_EQ(PictureFormatOf("a.svg"), PictureFormat::kSvg);
  EXPECT_EQ(PictureFormatOf("dir.svg/a.PNG"), PictureFormat::kPng);
  EXPECT_EQ(PictureFormatOf("a.svgz"), std::nullopt);
  EXPECT_EQ(PictureFormatOf(""), std::nullopt);
}

TEST(Canvas, LinesOfAnSvgKeepTheirPlacesHoweverManySteps) {
  std::vector<DrawnPoint> line;
  for (int i = 0; i <= 1000; ++i) line.push_back({i * 0.0149, 0});
  const std::unique_ptr<Canvas> canvas = MakeSvgCanvas(10, 10);
  canvas->Lines({line}, {"#000000"});
  const std::string svg = canvas->Finish();

  // Steps are rounded to hundredths; their sum must not be.
  const size_t begin = svg.find("d=\"M0 0l") + 8;
  std::string data = svg.substr(begin, svg.find('"', begin) - begin);
  double x = 0;
  for (const char* p = data.c_str(); *p != '\0';) {
    char* end = nullptr;
    x += std::strtod(p, &end);
    std::strtod(end, &end);
    p = end;
  }
  EXPECT_NEAR(x, 14.9, 1e-6);
}

TEST(EscapeMarkup, LeavesNoMarkupAndNoInvalidText) {
  EXPECT_EQ(EscapeMarkup("</script>'\"&"), "&lt;/script&gt;&#39;&quot;&amp;");
  EXPECT_EQ(EscapeMarkup("m\xC3\xBCll \xF0\x9F\x98\x80"), "m\xC3\xBCll \xF0\x9F\x98\x80");
  const std::string mark = "\xEF\xBF\xBD";
  for (const std::string bad : {"\xff", "\xC3", "\xC0", "\n", "\x7f"}) {
    EXPECT_EQ(EscapeMarkup("a" + bad + "b"), "a" + mark + "b");
  }
  EXPECT_EQ(EscapeMarkup(std::string("\0", 1)), mark);
  EXPECT_EQ(EscapeMarkup("\xED\xA0\x80"), mark + mark + mark);  // half a surrogate pair
}

}  // namespace
}  // namespace traverse::view

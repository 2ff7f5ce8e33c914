// PathLinks: what is translated, in layers of islands and in plans, and what is refused.

#include "engine/model/links.h"

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_cat.h"
#include "server/translate/translate.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::StatusIs;

absl::StatusOr<LabelledLayer> Translated(const std::string& text) {
  v1::Layer layer;
  EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &layer)) << text;
  return LayerFromProto(layer, 0, false);
}

TEST(LinksFromProto, AreOfThePathsTheyStandAt) {
  const auto layer = Translated(R"(
    islands { contours { points: [0, 0, 9, 0] } rasters { points: [1, 1, 5, 5, 8, 1] links {
      departures { open_seconds: 1 } departures { from { x_mm: 7 } retracted_seconds: 2 }
      arrivals { open_seconds: 3 retracted_seconds: 4 } } } }
    islands { contours { points: [5, 5] links { departures { from { y_mm: 6 } } } } } )");
  ASSERT_OK(layer);
  const LayerLinks& links = layer->layer.links;
  ASSERT_EQ(links.size(), 3);
  EXPECT_TRUE(links[0].departures.empty() && links[0].arrivals.empty());
  ASSERT_EQ(links[1].departures.size(), 2);
  EXPECT_FALSE(links[1].departures[0].from);
  EXPECT_EQ(links[1].departures[0].seconds, (LinkSeconds{1, 1}));
  EXPECT_EQ(links[1].departures[1].from, (Point{7, 0}));
  EXPECT_EQ(links[1].departures[1].seconds, (LinkSeconds{0, 2}));
  ASSERT_EQ(links[1].arrivals.size(), 1);
  EXPECT_EQ(links[1].arrivals[0], (LinkSeconds{3, 4}));
  EXPECT_EQ(links[2].departures[0].from, (Point{0, 6}));
}

TEST(LinksFromProto, AreNoneWhereNoPathHasAny) {
  const auto layer = Translated("islands { contours { points: [0, 0] } }");
  ASSERT_OK(layer);
  EXPECT_TRUE(layer->layer.links.empty());
}

TEST(LinksFromProto, AreRefusedByName) {
  const struct {
    const char* links;
    const char* fault;
  } cases[] = {
      {"departures { open_seconds: -1 }", "departures[0].open_seconds: -1 is not from 0 to 10000"},
      {"departures { open_seconds: nan }", "departures[0].open_seconds: not finite"},
      {"departures { open_seconds: 2 retracted_seconds: 1 }",
       "departures[0].retracted_seconds: 1 is less than open_seconds, 2"},
      {"arrivals { retracted_seconds: 20000 }",
       "arrivals[0].retracted_seconds: 20000 is not from 0 to 10000"},
      {"departures {} departures {} departures {}", "departures: 3 for a path of 2 ends"},
      {"arrivals {} arrivals {} arrivals {}", "arrivals: 3 for a path of 2 ends"},
      {"departures { from {} }",
       "departures[0].from: one place for all exits of a path that may be left at several"},
      {"departures {} departures { from { x_mm: 1e7 } }",
       "departures[1].from.x_mm: 1e+07 is not from -1000000 to 1000000"},
  };
  for (const auto& [links, fault] : cases) {
    const auto layer = Translated(
        absl::StrCat("plan { paths { contour { points: [0, 0] } } paths { open_path { ",
                     "points: [1, 1, 8, 1] links { ", links, " } } } nodes { in_order { ",
                     "children: [1, 2] } } nodes { path: 0 } nodes { path: 1 } }"));
    EXPECT_THAT(layer.status(), StatusIs(absl::StatusCode::kInvalidArgument,
                                         absl::StrCat("layers[0].plan.paths[1].links.", fault)));
  }
}

// An end at which the path cannot be left, or the only one.
TEST(LinksFromProto, MayBeOnePlaceForAPathWithOneExit) {
  EXPECT_OK(
      Translated("islands { contours { points: [0, 0, 9, 0] entries: [1] "
                 "links { departures { from { x_mm: 3 } } } } }"));
  EXPECT_OK(
      Translated("islands { rasters { points: [0, 0, 9, 0] one_way: true "
                 "links { departures { from { x_mm: 3 } } } } }"));
}

}  // namespace
}  // namespace traverse

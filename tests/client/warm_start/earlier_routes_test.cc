#include "client/warm_start/earlier_routes.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/report/json.h"
#include "tests/client/report/small_run.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;
using testing::StatusIs;

TEST(EarlierRoutes, AreWhatTheReportStates) {
  ASSERT_OK_AND_ASSIGN(
      const auto layers,
      ReadEarlierRoutes(report::RoutesJson(report::SmallJob(), report::SmallRun()), "a.json"));

  ASSERT_EQ(layers.size(), 2u);
  EXPECT_EQ(layers[0].id, 1u);
  ASSERT_EQ(layers[0].route.size(), 5u);
  const EarlierVisit& contour = layers[0].route[1];
  EXPECT_TRUE(contour.contour);
  EXPECT_EQ(contour.island, 1u);
  EXPECT_EQ(contour.id, 7u);
  EXPECT_EQ(contour.entry, 2u);
  EXPECT_EQ(contour.from->x, 25);
  EXPECT_EQ(contour.to->y, 25);
  const EarlierVisit& raster = layers[0].route[3];
  EXPECT_FALSE(raster.contour);
  EXPECT_EQ(raster.entry, 1u);
  EXPECT_EQ(raster.from->x, 11);
  EXPECT_EQ(raster.to->x, 29);
  EXPECT_EQ(layers[1].route[0].from->x, 3);  // the ends of an open path of three points
  EXPECT_EQ(layers[1].route[0].to->x, 1);
}

std::string Document(const std::string& layers) {
  return R"({"input": "a", "strategy": "auto", "seed": 1, "total": {}, "layers": )" + layers + "}";
}

TEST(EarlierRoutes, OfEarlierVersionsHaveNoPlaces) {
  ASSERT_OK_AND_ASSIGN(
      const auto layers,
      ReadEarlierRoutes(
          Document(R"([{"id": 1, "route": [{"kind": "raster", "id": 2, "reversed": true}]}])"),
          "a.json"));

  EXPECT_FALSE(layers[0].route[0].from.has_value());
}

TEST(EarlierRoutes, RefusesWhatIsNoneOfThem) {
  const struct {
    std::string text;
    const char* why;
  } cases[] = {
      {"", "it is not JSON, or is cut short"},
      {"M,100,80\nnF,1\n", "it is not JSON, or is cut short"},
      {Document("[{").substr(0, 60), "it is not JSON, or is cut short"},
      {"[]", "no \"input\""},
      {"7", "no \"input\""},
      {"{\"layers\": []}", "no \"input\""},
      {R"({"input": "a", "strategy": "auto", "total": {}})", "no \"layers\""},
      {Document("{}"), "\"layers\" is not a list"},
      {Document("[7]"), "layers[0]: no \"id\""},
      {Document("[[]]"), "layers[0]: no \"id\""},
      {Document("[{\"id\": -1}]"), "layers[0]: \"id\" is not a whole number up to "},
      {Document("[{\"id\": 1}]"), "layers[0]: no \"route\""},
      {Document("[{\"id\": 1, \"route\": {}}]"), "layers[0]: \"route\" is not a list"},
      {Document("[{\"id\": 1, \"route\": []}, {\"id\": 2, \"route\": [7]}]"),
       "layers[1].route[0]: no \"kind\""},
      {Document(R"([{"id": 1, "route": [{"kind": "line", "id": 1}]}])"),
       "layers[0].route[0]: \"kind\" is neither contour nor raster"},
      {Document(R"([{"id": 1, "route": [{"kind": "contour", "id": 1, "entry": 1.5}]}])"),
       "layers[0].route[0]: \"entry\" is not a whole number up to 4294967295"},
      {Document(R"([{"id": 1, "route": [{"kind": "contour", "id": 1, "entry": 1, "at": [1]}]}])"),
       "layers[0].route[0]: \"at\" is not [x, y]"},
      {Document(R"([{"id": 1, "route": [{"kind": "raster", "id": 1, "reversed": 1}]}])"),
       "layers[0].route[0]: \"reversed\" is neither true nor false"},
      // The API's own layers, and the document of `compare`.
      {R"({"layers": [{"id": "1"}]})", "layers[0]: \"id\" is not a whole number"},
      {R"({"input": "a", "runs": []})", "no \"strategy\""},
  };
  for (const auto& bad : cases) {
    EXPECT_THAT(
        ReadEarlierRoutes(bad.text, "a.json"),
        StatusIs(absl::StatusCode::kInvalidArgument,
                 StartsWith(std::string("a.json: not what `traverse optimize --json` writes: ") +
                            bad.why)))
        << bad.text;
  }
}

}  // namespace
}  // namespace traverse

// The page of --report: client/view/report_page.h and layer_code.h. Browsers look at it in
// browser/.

#include "client/view/report_page.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <utility>

#include "absl/strings/escaping.h"
#include "client/files/json.h"
#include "client/view/page_template.h"
#include "client/view/scene/layer_code.h"
#include "engine/base/rng.h"

namespace traverse::view {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Reads what LayerCode writes, by its description.
class Reader {
 public:
  explicit Reader(std::string bytes) : bytes_(std::move(bytes)) {}

  size_t Next() {
    size_t value = 0;
    for (int shift = 0;; shift += 7) {
      const auto byte = static_cast<uint8_t>(bytes_.at(at_++));
      value |= size_t{byte & 127u} << shift;
      if (byte < 128) return value;
    }
  }
  int64_t NextSigned() {
    const size_t value = Next();
    const auto half = static_cast<int64_t>(value / 2);
    return value % 2 == 0 ? half : -half - 1;
  }
  bool done() const { return at_ == bytes_.size(); }

 private:
  std::string bytes_;
  size_t at_ = 0;
};

double Steps(double mm) { return std::round(mm / kGridMm); }

// [x, y] in steps, from `at` on.
struct Pen {
  double x = 0;
  double y = 0;
  double dx = 0;
  double dy = 0;
  void Move(Reader& reader, bool goes_on) {
    dx = static_cast<double>(reader.NextSigned()) + (goes_on ? dx : 0);
    dy = static_cast<double>(reader.NextSigned()) + (goes_on ? dy : 0);
    x += dx;
    y += dy;
  }
  void ExpectAt(const DrawnPoint& point) const {
    EXPECT_EQ(x, Steps(point.x));
    EXPECT_EQ(y, Steps(point.y));
  }
};

void ExpectRoute(const DrawnLayer& layer, const DrawnRoute& route, Reader& reader) {
  Pen pen;
  pen.Move(reader, false);
  pen.ExpectAt(route.start);
  int64_t next = 0;
  for (const DrawnVisit& visit : route.visits) {
    EXPECT_EQ(next + reader.NextSigned(), static_cast<int64_t>(visit.path));
    next = static_cast<int64_t>(visit.path) + 1;
    const size_t token = reader.Next();
    EXPECT_EQ(token / 8, visit.entry);
    EXPECT_EQ(token / 2 % 4, static_cast<size_t>(visit.form));
    ASSERT_EQ(token % 2 == 1 ? reader.Next() : 0, visit.via.size());
    for (const DrawnPoint& corner : visit.via) {
      pen.Move(reader, false);
      pen.ExpectAt(corner);
    }
    const DrawnPoint exit = ExitOf(layer.paths[visit.path], visit);
    pen.x = Steps(exit.x);
    pen.y = Steps(exit.y);
  }
}

DrawnPoint RandomPoint(Rng& rng) {
  const auto coordinate = [&] { return static_cast<double>(rng.Below(4'000'000)) / 1000 - 2000; };
  const double x = coordinate();
  return {x, coordinate()};
}

DrawnLayer RandomLayer(Rng& rng) {
  DrawnLayer layer;
  const size_t paths = rng.Below(20);
  for (size_t i = 0; i < paths; ++i) {
    DrawnPath& path = layer.paths.emplace_back();
    path.feature = rng.Below(90);
    path.closed = rng.Below(2) == 0;
    const size_t points = (path.closed ? 1 : 2) + rng.Below(200);
    for (size_t j = 0; j < points; ++j) path.points.push_back(RandomPoint(rng));
  }
  for (DrawnRoute& route : (layer.routes = std::vector<DrawnRoute>(1 + rng.Below(3)))) {
    route.start = RandomPoint(rng);
    for (size_t i = 0; i < paths; ++i) {
      DrawnVisit& visit = route.visits.emplace_back();
      visit.path = paths - 1 - i;
      const DrawnPath& path = layer.paths[visit.path];
      visit.entry = rng.Below(path.closed ? static_cast<uint32_t>(path.points.size()) : 2);
      visit.form = static_cast<DrawnForm>(rng.Below(4));
      visit.via.resize(rng.Below(3));
      for (DrawnPoint& corner : visit.via) corner = RandomPoint(rng);
    }
  }
  return layer;
}

TEST(LayerCode, HoldsEveryNumberOfTheLayer) {
  for (uint64_t seed = 1; seed <= 50; ++seed) {
    SCOPED_TRACE(seed);
    Rng rng(seed);
    const DrawnLayer layer = RandomLayer(rng);
    Reader reader(LayerCode(layer));
    ASSERT_EQ(reader.Next(), layer.paths.size());
    Pen pen;
    for (const DrawnPath& path : layer.paths) {
      EXPECT_EQ(reader.Next(), 2 * path.feature + (path.closed ? 1 : 0));
      ASSERT_EQ(reader.Next(), path.points.size());
      for (size_t i = 0; i < path.points.size(); ++i) {
        pen.Move(reader, i >= 2);
        pen.ExpectAt(path.points[i]);
      }
    }
    for (const DrawnRoute& route : layer.routes) ExpectRoute(layer, route, reader);
    EXPECT_TRUE(reader.done());
  }
}

TEST(DeflatedBase64, InflatesToTheSameBytes) {
  const std::string text = "deposit, travel, deposit, travel, deposit";
  std::string bytes;
  ASSERT_TRUE(absl::Base64Unescape(DeflatedBase64(text), &bytes));
  std::string out(100, '\0');
  uLongf size = out.size();
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(out.data()), &size,
                       reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()),
            Z_OK);
  EXPECT_EQ(out.substr(0, size), text);
}

Scene SmallScene(const std::string& title) {
  Scene scene;
  scene.title = title;
  scene.seconds_name = "idle time";
  scene.features = {"outer wall"};
  scene.layer_ids = {1, 2, 3};
  scene.layer_z_mm = {0.2, 0.4, 0.6};
  scene.routes.resize(2);
  scene.routes[0].layers = {{10, 1, {}}, {20, 1, {}}, {30, 1, {}}};
  scene.routes[1].layers = {{10, 1, {}}, {10, 1, {}}, {30, 1, {}}};
  scene.routes[1].label = title;
  scene.layer = [](size_t i) {
    DrawnLayer layer;
    layer.paths.push_back({0, true, {{static_cast<double>(i), 0}, {1, 1}, {2, 0}}});
    layer.routes.resize(2);
    for (DrawnRoute& route : layer.routes) route.visits.resize(1);
    return layer;
  };
  return scene;
}

size_t Count(const std::string& text, const std::string& word) {
  size_t count = 0;
  for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++count;
  return count;
}

// Names of files and labels are others' texts.
TEST(ReportPage, TextsCannotBreakOutOfTheirElement) {
  const std::string plain = ReportPage(SmallScene("part"), "Made by traverse", 1);
  for (const std::string name : {"</script><script>alert(1)</script>", "<!-- <script",
                                 "a@LAYERS@b@SCENE@", "q\"'\\\n\xff"}) {
    const std::string page = ReportPage(SmallScene(name), "Made by traverse", 1);
    EXPECT_EQ(Count(page, "<script"), Count(plain, "<script")) << name;
    EXPECT_EQ(Count(page, "</script"), Count(plain, "</script")) << name;
    EXPECT_EQ(Count(page, "<!--"), Count(plain, "<!--")) << name;
    EXPECT_EQ(Count(page, "id=\"layer-1\""), 1u) << name;
  }
}

TEST(ReportPage, HoldsItsFiguresAsJsonAndTheLayerOnViewFirst) {
  const std::string page = ReportPage(SmallScene("q\"<\\"), "Made by traverse 1.2.3", 2);

  const std::string begin = "<script id=\"scene\" type=\"application/json\">";
  const size_t at = page.find(begin) + begin.size();
  const Json scene = ParseJson(page.substr(at, page.find("</script", at) - at)).value();
  const Json& route = scene.Find("routes")->items().at(1);
  EXPECT_EQ(*scene.Find("title")->Text(), "q\"<\\");
  EXPECT_EQ(scene.Find("open")->Number(), 1);
  EXPECT_EQ(scene.Find("paths")->Number(), 3);
  EXPECT_EQ(JsonText(*route.Find("layers")->Find("travel")), "[10.0,10.0,30.0]");
  EXPECT_TRUE(route.Find("layers")->Find("retractions")->is_null());
  EXPECT_TRUE(route.Find("crossings")->is_null());
  EXPECT_LT(page.find("id=\"layer-1\""), page.find("id=\"layer-0\""));
  EXPECT_LT(page.find("id=\"layer-0\""), page.find("id=\"layer-2\""));
}

TEST(ReportPage, HoldsWhatFilesTell) {
  Scene told = SmallScene("part");
  for (RouteNotes& route : told.routes) {
    route.total.crossings = 6;
    for (size_t i = 0; i < route.layers.size(); ++i) {
      route.layers[i].crossings = static_cast<int64_t>(i) + 1;
    }
  }
  EXPECT_THAT(ReportPage(told, "", 1), HasSubstr("\"crossings\":6,"));
  EXPECT_THAT(ReportPage(told, "", 1), HasSubstr("\"crossings\":[1,2,3]"));
}

TEST(ReportPage, IsTheSameOnAnyNumberOfThreads) {
  EXPECT_EQ(ReportPage(SmallScene("part"), "", 1), ReportPage(SmallScene("part"), "", 8));
}

TEST(PageTemplate, AsksNoNetwork) {
  const std::string page(PageTemplate());
  EXPECT_THAT(page, HasSubstr("default-src 'none'"));
  for (const char* word : {"src=\"http", "href=\"http", "url(http", "@import", "fetch("}) {
    EXPECT_THAT(page, Not(HasSubstr(word)));
  }
}

}  // namespace
}  // namespace traverse::view

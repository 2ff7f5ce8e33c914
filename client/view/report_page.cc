#include "client/view/report_page.h"

#include <atomic>
#include <cmath>
#include <optional>
#include <string_view>
#include <vector>

#include "absl/strings/str_format.h"
#include "client/files/json.h"
#include "client/gcode/parallel.h"
#include "client/view/drawing/markup.h"
#include "client/view/drawing/palette.h"
#include "client/view/page_template.h"
#include "client/view/scene/layer_code.h"

namespace traverse::view {
namespace {

// Files state three digits, so three are enough.
double Rounded(double value) { return std::round(value * 1000) / 1000; }

// [layer] of a figure that a file states; null unless the file states it for all layers.
Json LayersJson(const RouteNotes& route, std::optional<int64_t> Figures::*figure) {
  JsonArray values;
  for (const Figures& layer : route.layers) {
    if (!(layer.*figure)) return nullptr;
    values.push_back(*(layer.*figure));
  }
  return values;
}

Json RouteJson(const RouteNotes& route) {
  JsonArray travel;
  for (const Figures& layer : route.layers) travel.push_back(Rounded(layer.travel_mm));
  return JsonObject{{"label", ValidUtf8(route.label)},
                    {"travel", Rounded(route.total.travel_mm)},
                    {"seconds", Rounded(route.total.seconds)},
                    {"retractions", JsonOrNull(route.total.retractions)},
                    {"hidden", JsonOrNull(route.total.hidden_retractions)},
                    {"crossings", JsonOrNull(route.total.crossings)},
                    {"gap", JsonOrNull(route.gap)},
                    {"compute", Rounded(route.compute_seconds)},
                    {"layers", JsonObject{{"travel", std::move(travel)},
                                          {"retractions", LayersJson(route, &Figures::retractions)},
                                          {"crossings", LayersJson(route, &Figures::crossings)}}}};
}

Json SceneJson(const Scene& scene, const std::string& made, size_t paths) {
  JsonArray features;
  for (const std::string& name : scene.features) {
    const FeatureColor color = ColorOf(name);
    features.push_back(
        JsonObject{{"name", ValidUtf8(name)}, {"light", color.light}, {"dark", color.dark}});
  }
  JsonArray routes;
  for (const RouteNotes& route : scene.routes) routes.push_back(RouteJson(route));
  JsonArray heights;
  for (const double z : scene.layer_z_mm) heights.push_back(Rounded(z));
  return JsonObject{
      {"title", ValidUtf8(scene.title)},
      {"made", ValidUtf8(made)},
      {"moves", scene.moves_note},
      {"seconds", scene.seconds_name},
      {"grid", kGridMm},
      {"first", scene.first_layer},
      {"open", LayerWithMostSaved(scene)},
      {"shown", scene.shown},
      {"paths", paths},
      {"features", std::move(features)},
      {"routes", std::move(routes)},
      {"layers", JsonObject{{"id", JsonArray(scene.layer_ids.begin(), scene.layer_ids.end())},
                            {"z", std::move(heights)}}}};
}

// JSON that neither ends a script element nor begins a comment in one, whatever its texts are.
std::string ScriptSafe(const Json& json) {
  std::string out;
  for (const char c : JsonText(json)) {
    if (c == '<') {
      out += "\\u003c";
    } else {
      out += c;
    }
  }
  return out;
}

}  // namespace

std::string ReportPage(const Scene& scene, const std::string& made, int threads) {
  std::vector<std::string> layers(scene.layers());
  std::atomic<size_t> paths = 0;
  gcode::ParallelFor(layers.size(), threads, [&](size_t i) {
    const DrawnLayer layer = scene.layer(i);
    paths += layer.paths.size();
    layers[i] = DeflatedBase64(LayerCode(layer));
  });

  const std::string_view page = PageTemplate();
  constexpr std::string_view kScene = "@SCENE@";
  constexpr std::string_view kLayers = "@LAYERS@";
  const size_t scene_at = page.find(kScene);
  const size_t layers_at = page.find(kLayers, scene_at);
  std::string out(page.substr(0, scene_at));
  out += ScriptSafe(SceneJson(scene, made, paths));
  out += page.substr(scene_at + kScene.size(), layers_at - scene_at - kScene.size());
  const auto append = [&](size_t i) {
    absl::StrAppendFormat(&out, "<script id=\"layer-%d\" type=\"text/plain\">%s</script>\n", i,
                          layers[i]);
    layers[i] = {};
  };
  const size_t open = LayerWithMostSaved(scene);
  append(open);
  for (size_t i = 0; i < layers.size(); ++i) {
    if (i != open) append(i);
  }
  out += page.substr(layers_at + kLayers.size());
  return out;
}

}  // namespace traverse::view

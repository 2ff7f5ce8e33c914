// What pictures show: the paths of layers, and the routes through them.
//
// Pictures and the report are made only from scenes; they know neither formats nor the service.

#ifndef TRAVERSE_CLIENT_VIEW_SCENE_SCENE_H_
#define TRAVERSE_CLIENT_VIEW_SCENE_SCENE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace traverse::view {

// In mm.
struct DrawnPoint {
  double x = 0;
  double y = 0;

  friend bool operator==(const DrawnPoint&, const DrawnPoint&) = default;
};

// A path that is deposited without interruption.
struct DrawnPath {
  size_t feature = 0;   // index into Scene::features
  bool closed = false;  // its last point is joined to its first
  std::vector<DrawnPoint> points;
};

// What travel does, each in a color of its own.
enum class DrawnForm : uint8_t {
  kTravel,     // nothing else is known
  kRetracted,  // with filament pulled back
  kOpen,       // without
  kHidden,     // without, and nobody sees it
};

// One path of a route.
struct DrawnVisit {
  size_t path = 0;              // index into DrawnLayer::paths
  size_t entry = 0;             // vertex where a closed path begins; else 0, or 1 for its other end
  std::vector<DrawnPoint> via;  // corners of the travel to it; empty: straight
  DrawnForm form = DrawnForm::kTravel;
};

// A route through a layer.
struct DrawnRoute {
  DrawnPoint start;
  std::vector<DrawnVisit> visits;
};

struct DrawnLayer {
  std::vector<DrawnPath> paths;
  std::vector<DrawnRoute> routes;  // one for each of Scene::routes
};

// The totals of a route, for a layer or for all of them.
struct Figures {
  double travel_mm = 0;
  double seconds = 0;
  std::optional<int64_t> retractions = {};         // if the file shows them
  std::optional<int64_t> crossings = {};           // of visible walls; likewise
  std::optional<int64_t> hidden_retractions = {};  // at travel that nobody would see; likewise
};

// One route through the job: as given, or by a strategy.
struct RouteNotes {
  std::string label;  // "as given", "auto"
  Figures total;
  std::vector<Figures> layers;  // [layer]
  std::optional<double> gap;    // to a proven lower bound, 0 to 1
  double compute_seconds = 0;   // as the caller waited
};

// A job and its routes. routes[0] is the given order.
struct Scene {
  std::string title;                  // the name of the file, for people
  std::string seconds_name;           // the meaning of Figures::seconds: "idle time"
  std::string moves_note;             // a sentence about the moves
  std::vector<std::string> features;  // names, each with a color of the palette
  std::vector<RouteNotes> routes;     // at least two
  size_t shown = 1;                   // index of the one that is compared with the given order
  size_t first_layer = 0;             // position in the file of layer 0
  std::vector<uint64_t> layer_ids;    // [layer] labels of the file
  std::vector<double> layer_z_mm;     // [layer]

  // Makes layer `i` when needed: scenes are large, and not all of them is looked at.
  std::function<DrawnLayer(size_t i)> layer;

  size_t layers() const { return layer_ids.size(); }
};

// Where `visit` begins and ends depositing.
DrawnPoint EntryOf(const DrawnPath& path, const DrawnVisit& visit);
DrawnPoint ExitOf(const DrawnPath& path, const DrawnVisit& visit);

// One travel move, corner by corner; at least two positions.
using DrawnMove = std::vector<DrawnPoint>;

// The moves of `route` in its order, all or those of one form, without those of length zero.
std::vector<DrawnMove> MovesOf(const DrawnLayer& layer, const DrawnRoute& route,
                               std::optional<DrawnForm> form = std::nullopt);

// The forms that moves of `layer` have, each once, in their order.
std::vector<DrawnForm> FormsOf(const DrawnLayer& layer);

// Where the route ends.
DrawnPoint EndOf(const DrawnLayer& layer, const DrawnRoute& route);

// The moves that are in `before` but not in `after`, in either direction.
std::vector<DrawnMove> Vanished(const std::vector<DrawnMove>& before,
                                const std::vector<DrawnMove>& after);

// The layer where the shown route saves the most travel over the given order; the first of several.
size_t LayerWithMostSaved(const Scene& scene);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_SCENE_H_

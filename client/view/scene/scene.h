// What there is to look at: the paths of layers, and the ways through them.
//
// Pictures and the report are made of scenes alone; they know neither formats nor the service.

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
struct Place {
  double x = 0;
  double y = 0;

  friend bool operator==(const Place&, const Place&) = default;
};

// What is deposited in one go.
struct DrawnPath {
  size_t feature = 0;   // index into Scene::features
  bool closed = false;  // its last point is joined to its first
  std::vector<Place> points;
};

// One path of a route.
struct DrawnVisit {
  size_t path = 0;  // index into DrawnLayer::paths
  size_t entry =
      0;  // of a closed path the vertex where it is begun; else 0, or 1 for its other end
  std::vector<Place> via;  // corners of the way there; empty: it is straight
};

// A way through a layer.
struct DrawnRoute {
  Place start;
  std::vector<DrawnVisit> visits;
};

struct DrawnLayer {
  std::vector<DrawnPath> paths;
  std::vector<DrawnRoute> routes;  // one for each of Scene::routes
};

// What a route comes to; of a layer, or of them all.
struct Figures {
  double travel_mm = 0;
  double seconds = 0;
  std::optional<int64_t> retractions = {};  // where the file tells
  std::optional<int64_t> crossings = {};    // of visible walls; the same
};

// One way of doing the job: as given, or by a strategy.
struct RouteNotes {
  std::string label;  // "as given", "auto"
  Figures total;
  std::vector<Figures> layers;  // [layer]
  std::optional<double> gap;    // to a proven bound, 0 to 1
  double compute_seconds = 0;   // as the caller waited
};

// A job and its routes. routes[0] is the order given.
struct Scene {
  std::string title;                  // the name of the file, for people
  std::string seconds_name;           // what Figures::seconds are: "idle time"
  std::string moves_note;             // what the moves are, a sentence
  std::vector<std::string> features;  // names, each with a color of the palette
  std::vector<RouteNotes> routes;     // at least two
  size_t shown = 1;                   // index of the one that is set against the order given
  size_t first_layer = 0;             // position in the file of layer 0
  std::vector<uint64_t> layer_ids;    // [layer] labels of the file
  std::vector<double> layer_z_mm;     // [layer]

  // Makes layer `i`: scenes are large, and not all of it is looked at.
  std::function<DrawnLayer(size_t i)> layer;

  size_t layers() const { return layer_ids.size(); }
};

// Where `visit` begins and ends to deposit.
Place EntryOf(const DrawnPath& path, const DrawnVisit& visit);
Place ExitOf(const DrawnPath& path, const DrawnVisit& visit);

// One move without deposition, corner by corner; at least two places.
using DrawnMove = std::vector<Place>;

// The moves of `route` in its order; those of no length are left out.
std::vector<DrawnMove> MovesOf(const DrawnLayer& layer, const DrawnRoute& route);

// Where the route ends.
Place EndOf(const DrawnLayer& layer, const DrawnRoute& route);

// The moves that are in `before` and not in `after`, whichever way they lead.
std::vector<DrawnMove> Vanished(const std::vector<DrawnMove>& before,
                                const std::vector<DrawnMove>& after);

// The layer where the route shown saves the most travel over the order given; the first of several.
size_t LayerWithMostSaved(const Scene& scene);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_SCENE_SCENE_H_

#include "client/view/scene/layer_code.h"

#include <zlib.h>

#include <cmath>
#include <cstdint>
#include <utility>

#include "absl/strings/escaping.h"

namespace traverse::view {
namespace {

class NumberWriter {
 public:
  void Add(uint64_t value) {
    for (; value >= 128; value /= 128) out_ += static_cast<char>(128 + value % 128);
    out_ += static_cast<char>(value);
  }
  void AddSigned(int64_t value) {
    Add(value >= 0 ? 2 * static_cast<uint64_t>(value)
                   : 2 * static_cast<uint64_t>(-(value + 1)) + 1);
  }

  // Appends the difference to the last point.
  void AddPoint(const DrawnPoint& place) {
    Bend(0, 0);
    AddNext(place);
  }

  // Appends the difference to the point that the last two points predict.
  void AddNext(const DrawnPoint& place) {
    const int64_t x = std::llround(place.x / kGridMm);
    const int64_t y = std::llround(place.y / kGridMm);
    AddSigned(x - x_ - dx_);
    AddSigned(y - y_ - dy_);
    Bend(x - x_, y - y_);
    x_ = x;
    y_ = y;
  }

  // Appends nothing: the reader knows the point too.
  void Skip(const DrawnPoint& place) {
    x_ = std::llround(place.x / kGridMm);
    y_ = std::llround(place.y / kGridMm);
  }

  std::string Take() { return std::move(out_); }

 private:
  void Bend(int64_t dx, int64_t dy) {
    dx_ = dx;
    dy_ = dy;
  }

  std::string out_;
  int64_t x_ = 0;
  int64_t y_ = 0;
  int64_t dx_ = 0;
  int64_t dy_ = 0;
};

void AddPath(const DrawnPath& path, NumberWriter& out) {
  out.Add(2 * path.feature + (path.closed ? 1 : 0));
  out.Add(path.points.size());
  for (size_t i = 0; i < path.points.size(); ++i) {
    if (i < 2) {
      out.AddPoint(path.points[i]);
    } else {
      out.AddNext(path.points[i]);
    }
  }
}

void AddRoute(const DrawnLayer& layer, const DrawnRoute& route, NumberWriter& out) {
  out.Skip({0, 0});
  out.AddPoint(route.start);
  size_t next = 0;
  for (const DrawnVisit& visit : route.visits) {
    out.AddSigned(static_cast<int64_t>(visit.path) - static_cast<int64_t>(next));
    next = visit.path + 1;
    out.Add(8 * visit.entry + 2 * static_cast<uint64_t>(visit.form) + (visit.via.empty() ? 0 : 1));
    if (!visit.via.empty()) out.Add(visit.via.size());
    for (const DrawnPoint& corner : visit.via) out.AddPoint(corner);
    out.Skip(ExitOf(layer.paths[visit.path], visit));
  }
}

}  // namespace

std::string LayerCode(const DrawnLayer& layer) {
  NumberWriter out;
  out.Add(layer.paths.size());
  for (const DrawnPath& path : layer.paths) AddPath(path, out);
  for (const DrawnRoute& route : layer.routes) AddRoute(layer, route, out);
  return out.Take();
}

std::string DeflatedBase64(std::string_view bytes) {
  uLongf size = compressBound(static_cast<uLong>(bytes.size()));
  std::string deflated(size, '\0');
  // With room for the worst case it can fail only for lack of memory.
  const int status = compress2(reinterpret_cast<Bytef*>(deflated.data()), &size,
                               reinterpret_cast<const Bytef*>(bytes.data()),
                               static_cast<uLong>(bytes.size()), Z_DEFAULT_COMPRESSION);
  if (status != Z_OK) return "";
  deflated.resize(size);
  return absl::Base64Escape(absl::string_view(deflated.data(), deflated.size()));
}

}  // namespace traverse::view

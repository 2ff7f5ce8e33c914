#include "client/view/drawing/picture.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <limits>
#include <map>
#include <memory>
#include <vector>

#include "absl/strings/ascii.h"
#include "absl/strings/match.h"
#include "absl/strings/str_format.h"
#include "client/report/numbers.h"
#include "client/view/drawing/canvas.h"
#include "client/view/drawing/palette.h"

namespace traverse::view {
namespace {

constexpr double kPanelWidth = 560;
constexpr double kMargin = 20;
constexpr double kHeaderHeight = 76;
constexpr double kLegendRow = 22;
constexpr double kPathWidth = 0.9;
constexpr double kMoveWidth = 1.9;
constexpr double kFaded = 0.16;
const char kInk[] = "#111827";
const char kPale[] = "#6b7280";

struct Box {
  double x0 = std::numeric_limits<double>::infinity();
  double y0 = std::numeric_limits<double>::infinity();
  double x1 = -std::numeric_limits<double>::infinity();
  double y1 = -std::numeric_limits<double>::infinity();

  void Add(const DrawnPoint& point) {
    x0 = std::min(x0, point.x);
    y0 = std::min(y0, point.y);
    x1 = std::max(x1, point.x);
    y1 = std::max(y1, point.y);
  }
};

Box BoxOf(const DrawnLayer& layer, const std::array<std::vector<DrawnMove>, 2>& moves) {
  Box box;
  for (const DrawnRoute& route : layer.routes) box.Add(route.start);
  for (const DrawnPath& path : layer.paths) {
    for (const DrawnPoint& point : path.points) box.Add(point);
  }
  for (const auto& list : moves) {
    for (const DrawnMove& move : list) {
      for (const DrawnPoint& point : move) box.Add(point);
    }
  }
  return box;
}

// From mm, with y upwards, to units of the picture.
class Projection {
 public:
  explicit Projection(const Box& box) : box_(box) {
    const double width = std::max(box.x1 - box.x0, 1e-3);
    const double height = std::max(box.y1 - box.y0, 1e-3);
    constexpr double kMostHeight = 1.3 * kPanelWidth;
    scale_ = std::min(kPanelWidth / width, kMostHeight / height);
    height_ = std::max(height * scale_, 0.25 * kPanelWidth);
    left_ = (kPanelWidth - width * scale_) / 2;
    top_ = (height_ - height * scale_) / 2;
  }

  double height() const { return height_; }

  DrawnPoint operator()(const DrawnPoint& point, double panel_x) const {
    return {panel_x + left_ + (point.x - box_.x0) * scale_,
            kHeaderHeight + top_ + (box_.y1 - point.y) * scale_};
  }
  std::vector<DrawnPoint> operator()(const std::vector<DrawnPoint>& line, double panel_x) const {
    std::vector<DrawnPoint> out;
    out.reserve(line.size());
    for (const DrawnPoint& point : line) out.push_back((*this)(point, panel_x));
    return out;
  }

 private:
  Box box_;
  double scale_ = 1;
  double height_ = 0;
  double left_ = 0;
  double top_ = 0;
};

class Painter {
 public:
  Painter(const Scene& scene, size_t index, PictureFormat format)
      : scene_(scene), index_(index), layer_(scene.layer(index)) {
    layer_.routes = {layer_.routes.front(), layer_.routes[scene.shown]};
    moves_ = {MovesOf(layer_, layer_.routes[0]), MovesOf(layer_, layer_.routes[1])};
    forms_ = FormsOf(layer_);
    projection_ = std::make_unique<Projection>(BoxOf(layer_, moves_));
    for (const DrawnPath& path : layer_.paths) used_[path.feature] = true;
    const double height =
        kHeaderHeight + projection_->height() + kMargin + LegendRows() * kLegendRow + kMargin / 2;
    const double width = 2 * kPanelWidth + 3 * kMargin;
    canvas_ =
        format == PictureFormat::kSvg ? MakeSvgCanvas(width, height) : MakePngCanvas(width, height);
  }

  std::string Paint() {
    Title();
    for (size_t side = 0; side < 2; ++side) {
      Caption(side);
      Panel(side);
    }
    Legend();
    return canvas_->Finish();
  }

 private:
  static double PanelX(size_t side) {
    return kMargin + static_cast<double>(side) * (kPanelWidth + kMargin);
  }

  void Title() {
    std::string title =
        absl::StrFormat("%s, layer %d", scene_.title, scene_.first_layer + index_ + 1);
    if (scene_.layer_z_mm[index_] != 0) {
      absl::StrAppendFormat(&title, ", z = %.2f mm", scene_.layer_z_mm[index_]);
    }
    canvas_->Text({kMargin, 26}, title, {14, kPale});
  }

  void Caption(size_t side) {
    const Figures& before = scene_.routes.front().layers[index_];
    const RouteNotes& notes = scene_.routes[side == 0 ? 0 : scene_.shown];
    const Figures& figures = notes.layers[index_];
    std::string text = absl::StrFormat("%s: travel %s", side == 0 ? "before" : "after",
                                       report::Length(figures.travel_mm));
    if (side == 1) {
      absl::StrAppendFormat(&text, " (%s)", report::Change(before.travel_mm, figures.travel_mm));
    }
    if (figures.retractions) {
      absl::StrAppendFormat(&text, ", %d %s", *figures.retractions,
                            *figures.retractions == 1 ? "retraction" : "retractions");
    }
    canvas_->Text({PanelX(side), 54}, text, {16, kInk, /*bold=*/true});
  }

  void Panel(size_t side) {
    const double x = PanelX(side);
    for (const auto& [feature, used] : used_) {
      for (const bool closed : {true, false}) {
        std::vector<std::vector<DrawnPoint>> lines;
        for (const DrawnPath& path : layer_.paths) {
          if (path.feature == feature && path.closed == closed) {
            lines.push_back((*projection_)(path.points, x));
          }
        }
        canvas_->Lines(lines, {ColorOf(scene_.features[feature]).light, kPathWidth, 1, closed});
      }
    }
    if (side == 1) Moves(Vanished(moves_[0], moves_[1]), x, {kTravelColor, kMoveWidth, kFaded});
    const DrawnRoute& route = layer_.routes[side];
    for (const DrawnForm form : forms_) {
      Moves(MovesOf(layer_, route, form), x, {ColorOf(form).light, kMoveWidth});
    }
    const DrawnPoint end = (*projection_)(EndOf(layer_, route), x);
    constexpr double kHalf = 5;
    canvas_->Rectangle({end.x - kHalf, end.y - kHalf}, 2 * kHalf, 2 * kHalf, kEndColor);
    canvas_->Disc((*projection_)(route.start, x), kHalf, kStartColor);
  }

  void Moves(const std::vector<DrawnMove>& moves, double x, const Pen& pen) {
    std::vector<std::vector<DrawnPoint>> lines;
    for (const DrawnMove& move : moves) lines.push_back((*projection_)(move, x));
    canvas_->Lines(lines, pen);
  }

  // The features in use, and before them the forms of travel, removed moves, start and end.
  static constexpr int kOwnItems = 3;
  static constexpr int kItemsPerRow = 7;
  int LegendRows() const {
    const size_t items = used_.size() + forms_.size() + kOwnItems;
    return (static_cast<int>(items) + kItemsPerRow - 1) / kItemsPerRow;
  }

  void Legend() {
    int item = 0;
    const double top = kHeaderHeight + projection_->height() + kMargin + kLegendRow / 2;
    const double step = (2 * kPanelWidth + kMargin) / kItemsPerRow;
    const auto next = [&](const std::string& name) {
      const DrawnPoint at = {kMargin + step * (item % kItemsPerRow),
                             top + kLegendRow * (item / kItemsPerRow)};
      ++item;
      canvas_->Text({at.x + 30, at.y + 4}, name, {12, kPale});
      return at;
    };
    const auto line = [&](const std::string& name, const Pen& pen) {
      const DrawnPoint at = next(name);
      canvas_->Lines({{at, {at.x + 22, at.y}}}, pen);
    };
    for (const DrawnForm form : forms_) {
      line(ColorOf(form).name, {ColorOf(form).light, kMoveWidth});
    }
    line("removed", {kTravelColor, kMoveWidth, kFaded});
    DrawnPoint at = next("start");
    canvas_->Disc({at.x + 11, at.y}, 5, kStartColor);
    at = next("end");
    canvas_->Rectangle({at.x + 6, at.y - 5}, 10, 10, kEndColor);
    for (const auto& [feature, used] : used_) {
      line(scene_.features[feature], {ColorOf(scene_.features[feature]).light, 2});
    }
  }

  const Scene& scene_;
  const size_t index_;
  DrawnLayer layer_;
  std::array<std::vector<DrawnMove>, 2> moves_;
  std::vector<DrawnForm> forms_;
  std::unique_ptr<Projection> projection_;
  std::map<size_t, bool> used_;  // features of this layer
  std::unique_ptr<Canvas> canvas_;
};

}  // namespace

std::optional<PictureFormat> PictureFormatOf(const std::string& name) {
  const std::string lower = absl::AsciiStrToLower(name);
  if (lower.ends_with(".svg")) return PictureFormat::kSvg;
  if (lower.ends_with(".png")) return PictureFormat::kPng;
  return std::nullopt;
}

std::string Picture(const Scene& scene, size_t layer, PictureFormat format) {
  return Painter(scene, layer, format).Paint();
}

}  // namespace traverse::view

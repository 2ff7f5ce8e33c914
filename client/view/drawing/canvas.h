// The canvas of a picture: an SVG text, or the pixels of a PNG.

#ifndef TRAVERSE_CLIENT_VIEW_DRAWING_CANVAS_H_
#define TRAVERSE_CLIENT_VIEW_DRAWING_CANVAS_H_

#include <memory>
#include <string>
#include <vector>

#include "client/view/scene/scene.h"

namespace traverse::view {

// A line of a picture. Positions and widths are in its units, from the upper left corner.
struct Pen {
  std::string color;  // "#rrggbb"
  double width = 1;
  double opacity = 1;
  bool closed = false;
};

enum class Anchor { kStart, kMiddle, kEnd };

struct Lettering {
  double size = 12;
  std::string color;
  bool bold = false;
  Anchor anchor = Anchor::kStart;
};

class Canvas {
 public:
  virtual ~Canvas() = default;

  // Lines with round ends and corners. Lines that share a pen are drawn together.
  virtual void Lines(const std::vector<std::vector<DrawnPoint>>& lines, const Pen& pen) = 0;
  virtual void Disc(DrawnPoint center, double radius, const std::string& color) = 0;
  virtual void Rectangle(DrawnPoint corner, double width, double height,
                         const std::string& color) = 0;
  virtual void Text(DrawnPoint at, const std::string& text, const Lettering& lettering) = 0;

  // Returns the file. Call it once, at the end.
  virtual std::string Finish() = 0;
};

// A picture of `width` x `height` units on white.
std::unique_ptr<Canvas> MakeSvgCanvas(double width, double height);

// The same, with two pixels per unit.
std::unique_ptr<Canvas> MakePngCanvas(double width, double height);

}  // namespace traverse::view

#endif  // TRAVERSE_CLIENT_VIEW_DRAWING_CANVAS_H_

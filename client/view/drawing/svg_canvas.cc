#include <cmath>
#include <cstdint>
#include <string>

#include "absl/strings/str_format.h"
#include "client/view/drawing/canvas.h"
#include "client/view/drawing/markup.h"

namespace traverse::view {
namespace {

// Coordinates are whole hundredths of a unit: the files are small, and no screen is finer.
constexpr double kGrid = 100;

std::string Hundredths(int64_t value) {
  std::string text = absl::StrFormat("%.2f", static_cast<double>(value) / kGrid);
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
  return text;
}

class SvgCanvas : public Canvas {
 public:
  SvgCanvas(double width, double height) {
    absl::StrAppendFormat(
        &svg_,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"%g\" height=\"%g\" "
        "viewBox=\"0 0 %g %g\" font-family=\"DejaVu Sans, Verdana, sans-serif\">\n"
        "<rect width=\"100%%\" height=\"100%%\" fill=\"#ffffff\"/>\n",
        width, height, width, height);
  }

  void Lines(const std::vector<std::vector<DrawnPoint>>& lines, const Pen& pen) override {
    std::string data;
    for (const std::vector<DrawnPoint>& line : lines) AppendLine(line, pen.closed, data);
    if (data.empty()) return;
    absl::StrAppendFormat(&svg_,
                          "<path fill=\"none\" stroke=\"%s\" stroke-width=\"%g\" "
                          "stroke-linecap=\"round\" stroke-linejoin=\"round\"",
                          pen.color, pen.width);
    if (pen.opacity < 1) absl::StrAppendFormat(&svg_, " stroke-opacity=\"%g\"", pen.opacity);
    absl::StrAppendFormat(&svg_, " d=\"%s\"/>\n", data);
  }

  void Disc(DrawnPoint center, double radius, const std::string& color) override {
    absl::StrAppendFormat(&svg_,
                          "<circle cx=\"%.2f\" cy=\"%.2f\" r=\"%g\" fill=\"%s\" "
                          "stroke=\"#ffffff\"/>\n",
                          center.x, center.y, radius, color);
  }

  void Rectangle(DrawnPoint corner, double width, double height,
                 const std::string& color) override {
    absl::StrAppendFormat(&svg_,
                          "<rect x=\"%.2f\" y=\"%.2f\" width=\"%g\" height=\"%g\" fill=\"%s\" "
                          "stroke=\"#ffffff\"/>\n",
                          corner.x, corner.y, width, height, color);
  }

  void Text(DrawnPoint at, const std::string& text, const Lettering& lettering) override {
    const char* anchors[] = {"start", "middle", "end"};
    absl::StrAppendFormat(&svg_,
                          "<text x=\"%.2f\" y=\"%.2f\" font-size=\"%g\" fill=\"%s\" "
                          "text-anchor=\"%s\"%s>%s</text>\n",
                          at.x, at.y, lettering.size, lettering.color,
                          anchors[static_cast<int>(lettering.anchor)],
                          lettering.bold ? " font-weight=\"bold\"" : "", EscapeMarkup(text));
  }

  std::string Finish() override { return svg_ + "</svg>\n"; }

 private:
  // "M3 4l1 0 2.5-1z": relative moves, as whole steps of the grid, so that errors do not add up.
  static void AppendLine(const std::vector<DrawnPoint>& line, bool closed, std::string& data) {
    int64_t x = 0;
    int64_t y = 0;
    for (size_t i = 0; i < line.size(); ++i) {
      const int64_t to_x = std::llround(line[i].x * kGrid);
      const int64_t to_y = std::llround(line[i].y * kGrid);
      if (i > 0 && i + 1 < line.size() && to_x == x && to_y == y) continue;
      data += i == 0 ? "M" : i == 1 ? "l" : " ";
      data += Hundredths(to_x - x);
      if (to_y - y >= 0) data += ' ';
      data += Hundredths(to_y - y);
      x = to_x;
      y = to_y;
    }
    if (closed || line.size() == 1) data += 'z';  // a line of one point is a dot
  }

  std::string svg_;
};

}  // namespace

std::unique_ptr<Canvas> MakeSvgCanvas(double width, double height) {
  return std::make_unique<SvgCanvas>(width, height);
}

}  // namespace traverse::view

#include <cairo.h>

#include <cmath>
#include <cstdlib>
#include <string>

#include "client/view/drawing/canvas.h"
#include "client/view/drawing/markup.h"

namespace traverse::view {
namespace {

constexpr double kPixels = 2;  // pixels per unit

cairo_status_t Append(void* out, const unsigned char* bytes, unsigned int count) {
  static_cast<std::string*>(out)->append(reinterpret_cast<const char*>(bytes), count);
  return CAIRO_STATUS_SUCCESS;
}

class PngCanvas : public Canvas {
 public:
  PngCanvas(double width, double height)
      : surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24,
                                            static_cast<int>(std::ceil(width * kPixels)),
                                            static_cast<int>(std::ceil(height * kPixels)))),
        cairo_(cairo_create(surface_)) {
    cairo_scale(cairo_, kPixels, kPixels);
    cairo_set_source_rgb(cairo_, 1, 1, 1);
    cairo_paint(cairo_);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
  }
  ~PngCanvas() override {
    cairo_destroy(cairo_);
    cairo_surface_destroy(surface_);
  }
  PngCanvas(const PngCanvas&) = delete;
  PngCanvas& operator=(const PngCanvas&) = delete;

  void Lines(const std::vector<std::vector<DrawnPoint>>& lines, const Pen& pen) override {
    SetColor(pen.color, pen.opacity);
    cairo_set_line_width(cairo_, pen.width);
    for (const std::vector<DrawnPoint>& line : lines) {
      for (const DrawnPoint& point : line) cairo_line_to(cairo_, point.x, point.y);
      if (pen.closed || line.size() == 1) cairo_close_path(cairo_);
      cairo_new_sub_path(cairo_);
      // Strokes opaque lines one by one: cairo's time grows with the crossings in a path.
      if (pen.opacity == 1) cairo_stroke(cairo_);
    }
    cairo_stroke(cairo_);
  }

  void Disc(DrawnPoint center, double radius, const std::string& color) override {
    cairo_new_path(cairo_);
    cairo_arc(cairo_, center.x, center.y, radius, 0, 2 * std::acos(-1.0));
    FillWithRim(color);
  }

  void Rectangle(DrawnPoint corner, double width, double height,
                 const std::string& color) override {
    cairo_rectangle(cairo_, corner.x, corner.y, width, height);
    FillWithRim(color);
  }

  void Text(DrawnPoint at, const std::string& text, const Lettering& lettering) override {
    const std::string valid = ValidUtf8(text);
    cairo_select_font_face(cairo_, "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           lettering.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_, lettering.size);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_, valid.c_str(), &extents);
    const double shares[] = {0, 0.5, 1};
    cairo_move_to(cairo_, at.x - extents.x_advance * shares[static_cast<int>(lettering.anchor)],
                  at.y);
    SetColor(lettering.color, 1);
    cairo_show_text(cairo_, valid.c_str());
    cairo_new_path(cairo_);
  }

  std::string Finish() override {
    std::string png;
    if (cairo_surface_write_to_png_stream(surface_, Append, &png) != CAIRO_STATUS_SUCCESS)
      return "";
    return png;
  }

 private:
  void SetColor(const std::string& color, double opacity) {
    const auto rgb = static_cast<unsigned>(std::strtoul(color.c_str() + 1, nullptr, 16));
    cairo_set_source_rgba(cairo_, ((rgb >> 16) & 255) / 255.0, ((rgb >> 8) & 255) / 255.0,
                          (rgb & 255) / 255.0, opacity);
  }

  void FillWithRim(const std::string& color) {
    SetColor(color, 1);
    cairo_fill_preserve(cairo_);
    SetColor("#ffffff", 1);
    cairo_set_line_width(cairo_, 1);
    cairo_stroke(cairo_);
  }

  cairo_surface_t* surface_;
  cairo_t* cairo_;
};

}  // namespace

std::unique_ptr<Canvas> MakePngCanvas(double width, double height) {
  return std::make_unique<PngCanvas>(width, height);
}

}  // namespace traverse::view

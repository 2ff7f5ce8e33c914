#include "client/report/reproduce/figures_page.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "absl/strings/numbers.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "absl/strings/str_split.h"

namespace traverse::report {
namespace {

constexpr double kWidth = 420;   // of a drawing, in pixels
constexpr double kHeight = 240;  // of a chart

std::string Escaped(const std::string& text) {
  return absl::StrReplaceAll(text, {{"&", "&amp;"}, {"<", "&lt;"}, {">", "&gt;"}});
}

std::string Figure(const std::string& caption, const std::string& svg, double height) {
  return absl::StrFormat(
      "<figure><svg viewBox=\"0 0 %.0f %.0f\" width=\"%.0f\" height=\"%.0f\">%s</svg>"
      "<figcaption>%s</figcaption></figure>\n",
      kWidth, height, kWidth, height, svg, Escaped(caption));
}

struct Bar {
  std::string label;
  double value = 0;
};

std::string BarChart(const std::string& caption, const std::vector<Bar>& bars,
                     const std::string& unit) {
  double most = 0;
  for (const Bar& bar : bars) most = std::max(most, bar.value);
  if (most <= 0) return "";
  const double row = 20;
  std::string svg;
  for (size_t i = 0; i < bars.size(); ++i) {
    const double y = row * static_cast<double>(i);
    absl::StrAppendFormat(&svg,
                          "<text x=\"112\" y=\"%.1f\" text-anchor=\"end\">%s</text>"
                          "<rect x=\"118\" y=\"%.1f\" width=\"%.1f\" height=\"14\"/>"
                          "<text x=\"%.1f\" y=\"%.1f\">%.5g %s</text>",
                          y + 13, Escaped(bars[i].label), y + 2, 210 * bars[i].value / most,
                          122 + 210 * bars[i].value / most, y + 13, bars[i].value, unit);
  }
  return Figure(caption, svg, row * static_cast<double>(bars.size()) + 4);
}

// Maps a layer's points to the drawing.
class Frame {
 public:
  explicit Frame(const v1::Layer& layer) {
    for (const v1::Island& island : layer.islands()) {
      for (const v1::Contour& c : island.contours()) Take(c.points());
      for (const v1::OpenPath& r : island.rasters()) Take(r.points());
    }
    Include(0, 0);
    scale_ = (kWidth - 20) / std::max(1e-9, high_[0] - low_[0]);
  }
  double x(double mm) const { return 10 + (mm - low_[0]) * scale_; }
  double y(double mm) const { return 10 + (high_[1] - mm) * scale_; }
  double height() const { return 20 + (high_[1] - low_[1]) * scale_; }

 private:
  void Include(double px, double py) {
    low_[0] = std::min(low_[0], px), high_[0] = std::max(high_[0], px);
    low_[1] = std::min(low_[1], py), high_[1] = std::max(high_[1], py);
  }
  void Take(const google::protobuf::RepeatedField<double>& points) {
    for (int i = 0; i + 1 < points.size(); i += 2) Include(points[i], points[i + 1]);
  }
  double low_[2] = {0, 0}, high_[2] = {0, 0}, scale_ = 1;
};

std::string Polyline(const Frame& frame, const google::protobuf::RepeatedField<double>& points,
                     bool closed) {
  std::string path;
  for (int i = 0; i + 1 < points.size(); i += 2) {
    absl::StrAppendFormat(&path, "%s%.1f,%.1f", i > 0 ? " " : "", frame.x(points[i]),
                          frame.y(points[i + 1]));
  }
  return absl::StrFormat("<%s class=\"part\" points=\"%s\"/>", closed ? "polygon" : "polyline",
                         path);
}

std::string PartOf(const Frame& frame, const v1::Layer& layer, bool rasters) {
  std::string svg;
  for (const v1::Island& island : layer.islands()) {
    for (const v1::Contour& c : island.contours()) svg += Polyline(frame, c.points(), true);
    for (const v1::OpenPath& r : island.rasters()) {
      if (rasters) svg += Polyline(frame, r.points(), false);
    }
  }
  return svg;
}

std::string Line(const Frame& frame, const char* kind, double x1, double y1, double x2, double y2) {
  return absl::StrFormat("<line class=\"%s\" x1=\"%.1f\" y1=\"%.1f\" x2=\"%.1f\" y2=\"%.1f\"/>",
                         kind, frame.x(x1), frame.y(y1), frame.x(x2), frame.y(y2));
}

// The paths in the numbering of `trace`: island by island, first contours, then rasters.
std::vector<const google::protobuf::RepeatedField<double>*> NumberedPaths(const v1::Layer& layer) {
  std::vector<const google::protobuf::RepeatedField<double>*> paths;
  for (const v1::Island& island : layer.islands()) {
    for (const v1::Contour& c : island.contours()) paths.push_back(&c.points());
    for (const v1::OpenPath& r : island.rasters()) paths.push_back(&r.points());
  }
  return paths;
}

class Page {
 public:
  Page(const ReproduceForm& form, const OutcomeOfRun& outcome,
       const std::map<std::string, v1::Layer>& layers)
      : form_(form), outcome_(outcome), layers_(layers) {
    methods_ = {{"NO", "none"}, {"Guloso", GreedyMethod()}, {"NI2OPT", Ni2optMethod()}};
    for (const char* r : {"sp", "nrp", "bbcp"}) {
      methods_.push_back({absl::StrCat("MILP ", r), MilpMethodName(r, true, form)});
    }
    for (const char* r : {"nrp", "bbcp"}) {
      for (const int d : form.diversifications) {
        methods_.push_back({absl::StrCat("BT ", r, " ", d), TabuMethodName(r, d)});
      }
    }
  }

  std::string Figures() const {
    std::string out;
    for (const char* part : kThesisParts) {
      absl::StrAppend(&out, "<h2>", part, "</h2>\n", Charts(part), Drawings(part), Courses(part));
    }
    return out;
  }

 private:
  const RunOutcome* Find(const std::string& part, const std::string& method) const {
    return outcome_(ThesisRun(part, method, 1, form_));
  }

  std::string Charts(const std::string& part) const {
    const auto chart = [&](const std::string& caption, const std::string& unit,
                           double (*value)(const RunOutcome&)) {
      std::vector<Bar> bars;
      for (const auto& [label, method] : methods_) {
        const RunOutcome* found = Find(part, method);
        if (found != nullptr && found->HasRoute()) bars.push_back({label, value(*found)});
      }
      return BarChart(caption, bars, unit);
    };
    return chart("Figura 5.1 - totais das distâncias de reposicionamento", "mm",
                 [](const RunOutcome& o) { return o.TotalMm(); }) +
           chart("Figura 5.2 - entre contornos", "mm",
                 [](const RunOutcome& o) { return o.Get("c_mm"); }) +
           chart("Figura 5.3 - entre trechos de rasters", "mm",
                 [](const RunOutcome& o) { return o.Get("crs_mm"); }) +
           chart("Figura 5.14 - tempos de processamento", "s",
                 [](const RunOutcome& o) { return o.Get("solve_seconds"); });
  }

  std::string Drawings(const std::string& part) const {
    const auto layer = layers_.find(part);
    if (layer == layers_.end()) return "";
    std::string out;
    for (const auto& [label, method] : methods_) {
      const RunOutcome* found = Find(part, method);
      if (found == nullptr || !found->HasRoute()) continue;
      if (label.starts_with("MILP") || label.starts_with("BT")) {
        out += Steps(layer->second, *found, label);
      }
      out += Routes(layer->second, *found, label);
    }
    return out;
  }

  // Figures 3.7, 3.8 and 5.12.
  static std::string Steps(const v1::Layer& layer, const RunOutcome& found,
                           const std::string& label) {
    const Frame frame(layer);
    const auto paths = NumberedPaths(layer);
    const auto center = [&](size_t path) {
      if (path >= paths.size()) return std::pair(0.0, 0.0);
      double sum[2] = {0, 0};
      for (int i = 0; i < paths[path]->size(); ++i) sum[i % 2] += (*paths[path])[i];
      const double n = std::max(1, paths[path]->size() / 2);
      return std::pair(sum[0] / n, sum[1] / n);
    };
    std::string neighbors, sequence, visible;
    size_t last = paths.size();
    for (const auto& [name, value] : found.values) {
      const std::vector<std::string> words = absl::StrSplit(name, '_');
      if (!name.starts_with("first.trace_") || words.size() < 3) continue;
      std::vector<size_t> numbers;
      for (size_t i = 2; i < words.size(); ++i) {
        uint32_t number = 0;
        if (absl::SimpleAtoi(words[i], &number)) numbers.push_back(number);
      }
      if (words[1] == "neighbors" && numbers.size() == 2) {
        const auto [x1, y1] = center(numbers[0]);
        const auto [x2, y2] = center(numbers[1]);
        neighbors += Line(frame, "neighbor", x1, y1, x2, y2);
      } else if (words[1] == "sequence") {
        const size_t next = static_cast<size_t>(value);
        const auto [x1, y1] = center(last);
        const auto [x2, y2] = center(next);
        sequence += Line(frame, "contour", x1, y1, x2, y2);
        last = next;
      } else if (words[1] == "visible" && numbers.size() == 2 && numbers[0] < paths.size()) {
        const int at = 2 * static_cast<int>(numbers[1]);
        if (at + 1 >= paths[numbers[0]]->size()) continue;
        absl::StrAppendFormat(&visible, "<circle cx=\"%.1f\" cy=\"%.1f\" r=\"2\"/>",
                              frame.x((*paths[numbers[0]])[at]),
                              frame.y((*paths[numbers[0]])[at + 1]));
      }
    }
    const std::string part = PartOf(frame, layer, false);
    std::string out;
    if (!neighbors.empty()) {
      out += Figure(label + ": vizinhanças (figura 3.7)", part + neighbors, frame.height());
    }
    if (!sequence.empty()) {
      out +=
          Figure(label + ": sequência preliminar de Cs (passo 2)", part + sequence, frame.height());
    }
    if (!visible.empty()) {
      out += Figure(label + ": pontos dos polígonos de visibilidade (figura 5.12)", part + visible,
                    frame.height());
    }
    return out;
  }

  // Figures 5.4 to 5.7, 5.10 and 5.11.
  static std::string Routes(const v1::Layer& layer, const RunOutcome& found,
                            const std::string& label) {
    const Frame frame(layer);
    std::string contours, rasters;
    for (const DrawnMove& m : found.first_layer) {
      (m.to_contour ? contours : rasters) +=
          Line(frame, m.to_contour ? "contour" : "raster", m.x1, m.y1, m.x2, m.y2);
    }
    return Figure(label + ": Rota-C (passo 3)", PartOf(frame, layer, false) + contours,
                  frame.height()) +
           Figure(label + ": Rota-CRS (passo 4)", PartOf(frame, layer, true) + rasters,
                  frame.height());
  }

  // Figures 5.15 to 5.17.
  std::string Courses(const std::string& part) const {
    std::string out;
    for (const char* representation : {"sp", "nrp", "bbcp"}) {
      const RunOutcome* found = Find(part, MilpMethodName(representation, true, form_));
      if (found == nullptr) continue;
      for (const auto& [step, title] : {std::pair("contours", "passo 2"), {"rasters", "passo 4"}}) {
        out += Course(*found, step,
                      absl::StrFormat("MILP %s, %s: evolução da função objetivo, camada 1",
                                      representation, title));
      }
    }
    return out;
  }

  static std::string Course(const RunOutcome& found, const std::string& step,
                            const std::string& caption) {
    std::vector<std::pair<double, double>> course;
    for (int i = 1; i < 1000; ++i) {
      const std::string name = absl::StrFormat("first.%s_incumbent_%02d", step, i);
      if (found.values.count(name + "_value") == 0) continue;
      course.emplace_back(found.Get(name + "_seconds"), found.Get(name + "_value"));
    }
    if (course.empty()) return "";
    course.emplace_back(std::max(course.back().first, found.Get("first." + step + "_seconds")),
                        course.back().second);
    const double last = std::max(1e-6, course.back().first);
    double least = course.front().second, most = least;
    for (const auto& [seconds, value] : course) {
      least = std::min(least, value);
      most = std::max(most, value);
    }
    const double range = std::max(1e-9, most - least);
    std::string points;
    double before = 0;
    for (const auto& [seconds, value] : course) {
      const double x = 60 + (kWidth - 80) * seconds / last;
      const double y = 20 + (kHeight - 60) * (most - value) / range;
      if (!points.empty()) absl::StrAppendFormat(&points, "%.1f,%.1f ", x, before);
      absl::StrAppendFormat(&points, "%.1f,%.1f ", x, y);
      before = y;
    }
    const std::string svg = absl::StrFormat(
        "<polyline class=\"course\" points=\"%s\"/><text x=\"4\" y=\"24\">%.1f mm</text>"
        "<text x=\"4\" y=\"%.0f\">%.1f mm</text><text x=\"%.0f\" y=\"%.0f\" "
        "text-anchor=\"end\">%.2f s</text>",
        points, most, kHeight - 38, least, kWidth - 10, kHeight - 12, last);
    return Figure(caption, svg, kHeight);
  }

  const ReproduceForm& form_;
  const OutcomeOfRun& outcome_;
  const std::map<std::string, v1::Layer>& layers_;
  std::vector<std::pair<std::string, std::string>> methods_;
};

}  // namespace

std::string FiguresPage(const ReproduceForm& form, const OutcomeOfRun& outcome,
                        const std::map<std::string, v1::Layer>& layers, const std::string& tables) {
  return absl::StrCat(
      "<!doctype html>\n<html lang=\"pt\"><head><meta charset=\"utf-8\"><title>traverse "
      "reproduce</title><style>body{font:14px sans-serif;margin:2em;max-width:90em}"
      "figure{display:inline-block;margin:8px;vertical-align:top}figcaption{width:420px}"
      "svg{background:#fff;border:1px solid #ccc;font-size:11px}rect{fill:#3b76af}"
      ".part{fill:none;stroke:#bbb}.contour{stroke:#c22;stroke-width:1.5}"
      ".raster{stroke:#1a7f37;stroke-width:1.5}.neighbor{stroke:#888;stroke-dasharray:3}"
      ".course{fill:none;stroke:#3b76af;stroke-width:2}circle{fill:#c22}"
      "pre{overflow-x:auto}</style></head><body>\n<h1>traverse reproduce</h1>\n",
      Page(form, outcome, layers).Figures(), "<h2>Tabelas</h2>\n<pre>", Escaped(tables),
      "</pre>\n</body></html>\n");
}

}  // namespace traverse::report

// Prints of pillars, each an object with labels, in every notation that slicers have for them.

#ifndef TRAVERSE_TESTS_CLIENT_GCODE_LABELS_PILLARS_H_
#define TRAVERSE_TESTS_CLIENT_GCODE_LABELS_PILLARS_H_

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "absl/strings/str_cat.h"
#include "absl/strings/str_replace.h"

namespace traverse::gcode::testing {

// How a slicer labels object `number`.
struct Notation {
  std::string name;
  std::function<std::string(int)> begin;
  std::function<std::string(int)> end;  // empty where the next label ends it
  bool travel_inside = false;           // the travel to the next object is within this one's label
};

inline std::vector<Notation> Notations() {
  const auto line = [](const std::string& text) {
    return [text](int n) { return absl::StrCat(text, n, "\n"); };
  };
  const auto none = [](int) { return std::string(); };
  return {
      {"Prusa",
       [](int n) { return absl::StrCat("; printing object p", n, ".stl id:", n, " copy 0\n"); },
       [](int n) {
         return absl::StrCat("; stop printing object p", n, ".stl id:", n, " copy 0\n");
       },
       true},
      {"Klipper",
       [](int n) {
         return absl::StrCat("; printing object p", n, "\nEXCLUDE_OBJECT_START NAME=p", n, "\n");
       },
       [](int n) {
         return absl::StrCat("; stop printing object p", n, "\nEXCLUDE_OBJECT_END NAME=p", n, "\n");
       }},
      {"Klipper with quotes",
       [](int n) { return absl::StrCat("EXCLUDE_OBJECT_START NAME='part ", n, "'\n"); },
       [](int n) { return absl::StrCat("EXCLUDE_OBJECT_END NAME='part ", n, "'\n"); }},
      {"Bambu",
       [](int n) {
         return absl::StrCat("; start printing object, unique label id: ", n, "\nM624 A", n,
                             "AA=\n");
       },
       [](int n) {
         return absl::StrCat("; stop printing object, unique label id: ", n, "\nM625\n");
       }},
      {"M486", line("M486 S"), [](int) { return std::string("M486 S-1\n"); }},
      {"M486 switched", line("M486 S"), none},
      {"Cura", line(";MESH:p"), [](int) { return std::string(";MESH:NONMESH\n"); }},
      {"ideaMaker",
       [](int n) { return absl::StrCat(";PRINTING: p", n, ".stl\n;PRINTING_ID: ", n, "\n"); },
       none},
      {"OctoPrint", line("@OBJECT p"), [](int) { return std::string("@OBJECT none\n"); }},
      {"OctoPrint regions", line("@ExcludeRegion p"), line("@ExcludeRegion end p")},
      {"M486 in small letters", line("m486 s"), [](int) { return std::string("m486 s-1\n"); }},
      {"Klipper in small letters",
       [](int n) { return absl::StrCat("exclude_object_start NAME=p", n, "\n"); },
       [](int n) { return absl::StrCat("exclude_object_end NAME=p", n, "\n"); }},
  };
}

struct PillarPrint {
  int layers = 6;
  std::vector<int> order = {0, 2, 1, 3};  // of the pillars in each layer: to and fro
  double side = 8;
  double apart = 80;
  std::string before_object;  // behind its label; @ stands for its number
  std::string before_layer;   // behind the mark of each layer
  std::string between;        // before the label of each object but the first
  bool wipes = false;         // behind each pillar
  int unwiped = -1;           // but for this one, as slicers do behind what they cannot wipe along
  bool one_by_one = false;    // a pillar is finished before the next is begun

  double XOf(int pillar) const { return 60 + apart * (pillar % 2); }
  double YOf(int pillar) const { return 60 + apart * (pillar / 2); }
};

inline std::string Loop(double x, double y, double half) {
  std::string text;
  const double corners[][2] = {{1, -1}, {1, 1}, {-1, 1}, {-1, -1}};
  for (const auto& corner : corners) {
    absl::StrAppend(&text, "G1 X", x + half * corner[0], " Y", y + half * corner[1], " E",
                    2 * half * 0.04, "\n");
  }
  return text;
}

// Pulls filament back behind pillar `from`; less than 0: it is pulled back already.
inline std::string PullBehind(const PillarPrint& print, int from) {
  if (from < 0) return "";
  if (!print.wipes || from == print.unwiped) return "G1 E-.8 F2100\n";
  return absl::StrCat("G1 E-.2 F2100\n;WIPE_START\nG1 F7200\nG1 X", print.XOf(from), " Y",
                      print.YOf(from) + print.side / 2 - 3, " E-.55\n;WIPE_END\nG1 E-.05 F2100\n");
}

// The travel from pillar `from` to another one.
inline std::string TravelTo(const PillarPrint& print, int pillar, int from) {
  const double half = print.side / 2 - 0.45;
  return absl::StrCat(PullBehind(print, from), "G1 X", print.XOf(pillar) - half, " Y",
                      print.YOf(pillar) - half, " F9000\n");
}

// The paths of one pillar.
inline std::string PathsOf(const PillarPrint& print, int pillar) {
  const double x = print.XOf(pillar);
  const double y = print.YOf(pillar);
  const double half = print.side / 2;
  std::string text = "G1 E.8 F2100\n;TYPE:Perimeter\n;WIDTH:0.45\nG1 F1800\n";
  text += Loop(x, y, half - 0.45);
  absl::StrAppend(&text, "G1 X", x - half, " Y", y - half,
                  " F9000\n;TYPE:External perimeter\n;WIDTH:0.45\nG1 F1800\n", Loop(x, y, half));
  absl::StrAppend(&text, "G1 X", x, " Y", y - half + 1,
                  " F9000\n;TYPE:Internal infill\n;WIDTH:0.45\nG1 F2400\nG1 X", x, " Y",
                  y + half - 1, " E.2\n");
  return text;
}

inline std::string ObjectOf(const PillarPrint& print, const Notation& notation, int pillar,
                            int from) {
  const std::string travel = TravelTo(print, pillar, from);
  const std::string inner = notation.travel_inside ? "" : travel;
  const std::string before =
      absl::StrReplaceAll(print.before_object, {{"@", absl::StrCat(pillar)}});
  return absl::StrCat(notation.begin(pillar), before, inner, PathsOf(print, pillar));
}

inline std::string LayerMark(double z) {
  return absl::StrCat(";LAYER_CHANGE\n;Z:", z, "\n;HEIGHT:0.2\n");
}

inline std::string Text(const PillarPrint& print, const Notation& notation) {
  std::string text =
      "; generated by PrusaSlicer 2.9.2 on x\nM204 P1250 R1250 T1250\nG90\nG21\nM83\n";
  const auto height = [](int layer) { return std::round(layer * 20) / 100; };
  const size_t rounds = print.one_by_one ? print.order.size() : 1;
  for (size_t round = 0; round < rounds; ++round) {
    for (int layer = 1; layer <= print.layers; ++layer) {
      const std::vector<int> here =
          print.one_by_one ? std::vector<int>{print.order[round]} : print.order;
      absl::StrAppend(&text, LayerMark(height(layer)), print.before_layer, "G1 Z", height(layer),
                      " F9000\n");
      for (size_t i = 0; i < here.size(); ++i) {
        const int from = i > 0 ? here[i - 1] : print.wipes ? -1 : here[0];
        if (notation.travel_inside) text += TravelTo(print, here[i], from);
        if (i > 0) absl::StrAppend(&text, notation.end(here[i - 1]), print.between);
        text += ObjectOf(print, notation, here[i], from);
      }
      text += notation.end(here.back());
      if (print.wipes && layer < print.layers) text += PullBehind(print, here.back());
    }
  }
  return text + "G1 E-.8 F2100\nM107\nM84\n; slow_down_layer_time = 0\n";
}

}  // namespace traverse::gcode::testing

#endif  // TRAVERSE_TESTS_CLIENT_GCODE_LABELS_PILLARS_H_

// What is decided about links is what is written: random orders of all bundled files.

#include "client/gcode/link/layer_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "absl/strings/str_cat.h"
#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/plan/layer_plan.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/write/layer_writer.h"
#include "engine/base/rng.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/random_order.h"

namespace traverse::gcode {
namespace {

// About so many layers of a file are looked at.
constexpr size_t kLayers = 6;

// Scripts between paths pull filament back and push it in ways of their own.
bool HasScripts(const GcodeFile& file, const Layer& layer) {
  const auto first = file.blocks.begin() + layer.first_block;
  const auto end = file.blocks.begin() + layer.end_block;
  return std::any_of(first, end, [](const Block& block) {
    return (block.link & (kLinkFixed | kLinkFixedFrom)) != 0;
  });
}

// The file's layer in an order, as it is written.
class WrittenLayer {
 public:
  WrittenLayer(const LayerWriter& writer, const LayerOrder& order)
      : file_(writer.file()), start_(StartOfPaths(file_, order.front())) {
    writer.WriteBarePaths(order, start_, text_, &marks_);
    Interpreter interpreter(text_, 0, start_.machine);
    PartStart at = start_;
    for (Step step; interpreter.Next(step);) {
      while (states_.size() < marks_.size() && marks_[states_.size()] <= step.line.begin) {
        states_.push_back(at);
      }
      if (step.kind == StepKind::kSlot) {
        ApplySetter(at.state, file_.setters.Find(step.line.Text(text_)), step.slots);
      }
      at.machine = interpreter.state();
    }
    states_.resize(marks_.size(), at);
  }

  // The seconds of the link to `place`: of both paths with it, less those of each alone.
  double LinkSeconds(size_t place) const {
    return Seconds(2 * place - 2, 2 * place + 1) - Seconds(2 * place - 2, 2 * place - 1) -
           Seconds(2 * place, 2 * place + 1);
  }

 private:
  double Seconds(size_t from, size_t to) const {
    const auto part = std::string_view(text_).substr(marks_[from], marks_[to] - marks_[from]);
    return Measure(file_, part, states_[from]).seconds;
  }

  const GcodeFile& file_;
  const PartStart start_;
  std::string text_;
  std::vector<size_t> marks_;
  std::vector<PartStart> states_;  // [mark]
};

class DecidedLinks : public ::testing::TestWithParam<std::string> {
 protected:
  // Calls `check` with the writer of some layers of the file, and a random order of each.
  static void ForRandomOrders(
      const std::function<void(const LayerWriter& writer, const LayerOrder& order)>& check) {
    const auto read = ReadGcode(testing::TextOf(GetParam()), "part.gcode");
    ASSERT_TRUE(read.ok()) << read.status();
    const GcodeFile& file = **read;
    const RetractionHabit habit = HabitOfNewTravels(file);
    const LinkDonors donors(file);
    Rng rng(1);
    for (size_t i = 0; i < file.layers.size(); i += 1 + file.layers.size() / kLayers) {
      const Layer& layer = file.layers[i];
      if (HasScripts(file, layer)) continue;
      const LayerWriter writer(file, layer, habit, donors);
      const LayerOrder order =
          testing::RandomOrder(layer, MakeLayerPlan(file, layer, Policy::kFree).plan, rng);
      SCOPED_TRACE(absl::StrCat("layer ", i));
      check(writer, order);
    }
  }
};

TEST_P(DecidedLinks, RetractAsOftenAsIsWritten) {
  ForRandomOrders([](const LayerWriter& writer, const LayerOrder& order) {
    const PartStart start = StartOfPaths(writer.file(), order.front());
    std::string text;
    writer.WriteBarePaths(order, start, text);
    int64_t decided = 0;
    const std::vector<uint32_t> places = writer.PlacesOf(order);
    for (size_t place = 1; place < order.size(); ++place) {
      const TravelTotals link =
          writer.EstimateTravel(places[place], order[place - 1], order[place]);
      decided += link.retractions;
    }
    EXPECT_EQ(decided, Measure(writer.file(), text, start).retractions);
  });
}

// With a retraction to a millisecond; else nearly as well, as the paths beside a link are followed
// only as far as it takes to get going.
TEST_P(DecidedLinks, TakeAsLongAsIsWritten) {
  ForRandomOrders([](const LayerWriter& writer, const LayerOrder& order) {
    const std::vector<uint32_t> places = writer.PlacesOf(order);
    const WrittenLayer written(writer, order);
    LinkParts parts(writer.file());
    double off[2] = {};
    int64_t links[2] = {};
    for (size_t place = 1; place < order.size(); ++place) {
      const Placement& to = order[place];
      const TravelTotals link = writer.EstimateTravel(places[place], order[place - 1], to, parts);
      const double restart =
          parts.EndsOf(to)->seconds() - parts.EndsOf({to.block, 0, to.closed})->seconds();
      const size_t open = link.retractions > 0 ? 0 : 1;
      off[open] += std::abs(link.seconds - restart - written.LinkSeconds(place));
      ++links[open];
    }
    EXPECT_LE(off[0], .001 * static_cast<double>(links[0])) << links[0];
    EXPECT_LE(off[1], .002 * static_cast<double>(links[1])) << links[1];
  });
}

INSTANTIATE_TEST_SUITE_P(Kept, DecidedLinks, ::testing::ValuesIn(testing::KeptFiles()),
                         [](const auto& info) { return testing::NameOf(info.param); });

// A wall that the head goes on along for 0.2 mm, and a hole 0.25 mm beside the straight line from
// its end to the last line, 0.15 mm beside that from where the head is then.
TEST(LayerLinks, RetractWhereTheyPassOverAWallBehindAMoveAlongTheirPath) {
  std::string text =
      "; generated by Cura_SteamEngine 5.2\nM83\n;LAYER:0\nG0 F9000 X3.177 Y.823 Z.2\n";
  const auto loop = [&text](double x, double y, double side) {
    const std::string e = absl::StrCat(" E", 0.0333 * side, "\n");
    absl::StrAppend(&text, ";TYPE:WALL-OUTER\nG1 F1200 X", x + side, " Y", y, e);
    absl::StrAppend(&text, "G1 X", x + side, " Y", y + side, e, "G1 X", x, " Y", y + side, e);
    absl::StrAppend(&text, "G1 X", x, " Y", y, e);
  };
  loop(3.177, .823, 2);
  text += "G1 F2100 E-1\nG0 F9000 X0 Y0\nG1 F2100 E1\n";
  loop(0, 0, 20);
  text += "G0 F9000 X.2 Y0\nG1 F2100 E-1\nG0 F9000 X10 Y18\nG1 F2100 E1\n;TYPE:FILL\n";
  for (int y = 18; y >= 10; y -= 2) {
    if (y < 18) absl::StrAppend(&text, "G0 F9000 X10 Y", y, "\n");
    absl::StrAppend(&text, "G1 F1800 X18 Y", y, " E.266\n");
  }
  const auto file = *ReadGcode(text + "M107\n", "part.gcode");
  ASSERT_EQ(file->blocks.size(), 7u);
  const LinkDonors donors(*file);
  const RetractionHabit habit = HabitOfNewTravels(*file);
  const LayerWriter writer(*file, file->layers[0], habit, donors);
  LinkParts parts(*file);
  const auto retractions_to = [&](uint32_t line) {
    return writer.EstimateTravel(line, {1, 0, true}, {line, 0, false}, parts).retractions;
  };

  EXPECT_EQ(retractions_to(5), 0);
  EXPECT_EQ(retractions_to(6), 1);
}

// Thousands of links may be made like one that has thousands of bends.
TEST(LinkParts, NoBendsOrCommentsAreAmongWhatOtherLinksAreLike) {
  std::string text = "; generated by PrusaSlicer 2.5.0 on x\nM83\nG1 Z.2 F9000\n";
  text += ";TYPE:Internal infill\nG1 X0 Y0 F9000\nG1 F1200\nG1 X9 Y0 E.4\nG1 E-1 F2100\n";
  for (int i = 0; i < 100; ++i)
    absl::StrAppend(&text, "; remark\nG1 X", i % 7, " Y", i, " F9000\n");
  text += "G1 E1 F2100\nG1 F1200\nG1 X9 Y50 E.4\nM107\n";
  const auto file = *ReadGcode(text, "part.gcode");
  ASSERT_EQ(file->blocks.size(), 2u);
  LinkParts parts(*file);

  EXPECT_GT(parts.LinkTo(1)->steps.size(), 200u);
  const std::shared_ptr<const Link> model = parts.ModelOf(1);
  EXPECT_LT(model->steps.size(), 6u);
  EXPECT_TRUE(model->retracts());
  EXPECT_EQ(model->arriving().line.begin, parts.LinkTo(1)->arriving().line.begin);
}

}  // namespace
}  // namespace traverse::gcode

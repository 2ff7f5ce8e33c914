// What is decided about links is what is written: random orders of all bundled files.

#include "client/gcode/link/layer_links.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "client/gcode/measure/layer_meter.h"
#include "client/gcode/read/reader.h"
#include "client/gcode/write/layer_writer.h"
#include "engine/base/rng.h"
#include "tests/client/gcode/support/corpus.h"
#include "tests/client/gcode/support/random_order.h"

namespace traverse::gcode {
namespace {

class DecidedLinks : public ::testing::TestWithParam<std::string> {};

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

TEST_P(DecidedLinks, RetractAsOftenAsIsWritten) {
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
    const PartStart start = StartOfPaths(file, order.front());
    std::string text;
    writer.WriteBarePaths(order, start, text);
    int64_t decided = 0;
    const std::vector<uint32_t> places = writer.PlacesOf(order);
    for (size_t place = 1; place < order.size(); ++place) {
      const TravelTotals link =
          writer.EstimateTravel(places[place], order[place - 1], order[place], TravelModel());
      decided += link.retractions;
    }
    EXPECT_EQ(decided, Measure(file, text, start).retractions) << "layer " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Kept, DecidedLinks, ::testing::ValuesIn(testing::KeptFiles()),
                         [](const auto& info) { return testing::NameOf(info.param); });

}  // namespace
}  // namespace traverse::gcode

#include "client/gcode/write/placed_path.h"

#include <gtest/gtest.h>

#include <memory>

#include "client/gcode/read/reader.h"
#include "tests/client/gcode/support/samples.h"

namespace traverse::gcode {
namespace {

// The loop and the two lines of the sample.
class PlacedPathTest : public ::testing::Test {
 protected:
  PlacedPath Placed(uint32_t block, uint32_t entry) const {
    return PlacedPath(*file_, {block, entry, block == 0});
  }

  const std::shared_ptr<GcodeFile> file_ = *ReadGcode(testing::kPrusaSample, "sample.gcode");
};

TEST_F(PlacedPathTest, AnOpenPathEndsWhereItIsLedTo) {
  const PlacedPath given = Placed(1, 0);
  const PlacedPath turned = Placed(1, 1);

  EXPECT_TRUE(given.first().SameXy(turned.last()));
  EXPECT_TRUE(given.last().SameXy(turned.first()));
}

TEST_F(PlacedPathTest, TheMachineIsBehindThePathAsItIsPlaced) {
  for (const uint32_t block : {1u, 2u}) {
    for (const uint32_t entry : {0u, 1u}) {
      const PlacedPath path = Placed(block, entry);
      EXPECT_TRUE(path.Behind().machine.at.SameXy(path.last())) << block << ' ' << entry;
    }
  }
  // As given, the machine is as the file leaves it there, feed rate included.
  const PartStart behind = Placed(2, 0).Behind();
  const PartStart file = StartBehind(*file_, file_->blocks[2]);
  EXPECT_TRUE(behind.machine.at.SameXy(file.machine.at));
  EXPECT_EQ(behind.machine.feed, file.machine.feed);
  EXPECT_EQ(behind.machine.e, file.machine.e);
}

}  // namespace
}  // namespace traverse::gcode

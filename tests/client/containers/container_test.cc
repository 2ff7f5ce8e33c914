// Containers by their first bytes: client/containers/container.

#include "client/containers/container.h"

#include <gtest/gtest.h>

#include <optional>

namespace traverse::containers {
namespace {

TEST(DetectContainer, LooksAtTheFirstBytes) {
  EXPECT_EQ(DetectContainer("GCDE\x01"), ContainerKind::kBgcode);
  EXPECT_EQ(DetectContainer("PK\x03\x04"), ContainerKind::kGcode3mf);
  EXPECT_EQ(DetectContainer("G28\n"), ContainerKind::kText);
  EXPECT_EQ(ContainerByExtension("a/B.BGCODE"), ContainerKind::kBgcode);
  EXPECT_EQ(ContainerByExtension("part.gcode.3mf"), ContainerKind::kGcode3mf);
  EXPECT_EQ(ContainerByExtension("part.gcode"), ContainerKind::kText);
  EXPECT_EQ(ContainerByExtension("part.nc"), ContainerKind::kText);
  EXPECT_EQ(ContainerByExtension("part.json"), std::nullopt);
}

}  // namespace
}  // namespace traverse::containers

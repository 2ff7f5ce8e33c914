#include "engine/base/budget.h"

#include <gtest/gtest.h>

#include <chrono>

namespace traverse {
namespace {

TEST(Budget, HasAShareOfTheTimeThatIsLeft) {
  const auto now = Budget::Clock::now();
  const Budget whole(nullptr, now + std::chrono::hours(10));

  const Budget part = whole.WithShare(0.25);

  EXPECT_NEAR(std::chrono::duration<double>(*part.deadline() - now).count(), 9000, 60);
  EXPECT_EQ(whole.WithShare(1).deadline(), whole.deadline());
  EXPECT_FALSE(Budget().WithShare(0.25).deadline().has_value());
}

}  // namespace
}  // namespace traverse

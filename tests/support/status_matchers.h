// Matchers of absl::Status and absl::StatusOr, which the installed Abseil lacks.
//
//   EXPECT_OK(CheckPlan(plan));
//   EXPECT_THAT(Parse("x"), StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("x")));
//   ASSERT_OK_AND_ASSIGN(const auto strategy, MakeStrategy("greedy", {}));

#ifndef TRAVERSE_TESTS_SUPPORT_STATUS_MATCHERS_H_
#define TRAVERSE_TESTS_SUPPORT_STATUS_MATCHERS_H_

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace traverse::testing {

inline absl::Status StatusOf(const absl::Status& status) { return status; }
template <typename T>
absl::Status StatusOf(const absl::StatusOr<T>& value) {
  return value.status();
}

MATCHER(IsOk, negation ? "is an error" : "is OK") {
  const absl::Status status = StatusOf(arg);
  *result_listener << status.ToString();
  return status.ok();
}

MATCHER_P2(StatusIs, code, message, "") {
  const absl::Status status = StatusOf(arg);
  *result_listener << status.ToString();
  return status.code() == code &&
         ::testing::Matches(message)(std::string(status.message().data(), status.message().size()));
}

}  // namespace traverse::testing

#define EXPECT_OK(expression) EXPECT_THAT((expression), ::traverse::testing::IsOk())
#define ASSERT_OK(expression) ASSERT_THAT((expression), ::traverse::testing::IsOk())

#define TRAVERSE_CONCAT_INNER(a, b) a##b
#define TRAVERSE_CONCAT(a, b) TRAVERSE_CONCAT_INNER(a, b)
#define TRAVERSE_ASSERT_OK_AND_ASSIGN(variable, declaration, expression) \
  auto variable = (expression);                                          \
  ASSERT_OK(variable);                                                   \
  declaration = *std::move(variable)
#define ASSERT_OK_AND_ASSIGN(declaration, expression) \
  TRAVERSE_ASSERT_OK_AND_ASSIGN(TRAVERSE_CONCAT(status_or_, __LINE__), declaration, expression)

#endif  // TRAVERSE_TESTS_SUPPORT_STATUS_MATCHERS_H_

// What is in a file: client/report/inspection.

#include "client/report/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "client/formats/read_input.h"
#include "client/report/numbers.h"
#include "tests/client/report/small_run.h"
#include "tests/support/golden.h"

namespace traverse::report {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

TEST(InspectionText, CountsPathsByKindAndStatesTheFilesFacts) {
  InputJob job = SmallJob();
  job.name = "part.damat";

  const std::string text = InspectionText(job, SmallRun().result, 10);

  EXPECT_TRUE(testing::MatchesGolden("report/inspection.txt", text)) << text;
  EXPECT_THAT(InspectionText(job, SmallRun().result, 1), Not(HasSubstr("layer  id")));
}

}  // namespace
}  // namespace traverse::report

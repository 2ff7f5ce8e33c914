#include "client/loadgen/load_report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/files/json.h"

namespace traverse::loadgen {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

// A thousand jobs that took 1 to 1000 ms.
LoadResult Thousand() {
  LoadResult result;
  result.duration = absl::Seconds(10);
  result.sent = {1000};
  result.ok.resize(1);
  for (int ms = 1; ms <= 1000; ++ms) {
    result.ok[0].Add(absl::Milliseconds(ms), absl::Milliseconds(ms));
    result.code["OK"].Add(absl::Milliseconds(ms), absl::Milliseconds(ms));
  }
  return result;
}

LoadHeading Heading() {
  LoadHeading heading;
  heading.target = "127.0.0.1:1";
  heading.strategy = "ni2opt";
  heading.mix = {{1, 100}};
  return heading;
}

TEST(LoadReport, EachColumnIsItsOwnPercentile) {
  const Json json = ParseJson(LoadJson(Heading(), Thousand())).value();
  const Json& latency = *json.Find("sizes")->items().at(0).Find("latency_ms");

  EXPECT_NEAR(*latency.Find("p50")->Number(), 500, 5);
  EXPECT_NEAR(*latency.Find("p90")->Number(), 900, 9);
  EXPECT_NEAR(*latency.Find("p99")->Number(), 990, 9);
  EXPECT_NEAR(*latency.Find("p99_9")->Number(), 999, 9);
  EXPECT_NEAR(*latency.Find("max")->Number(), 1000, 1e-6);
  EXPECT_NEAR(*latency.Find("mean")->Number(), 500.5, 1e-6);
  EXPECT_EQ(json.Find("ok")->Number(), 1000);
  EXPECT_NEAR(*json.Find("ok_per_second")->Number(), 100, 1e-9);
}

TEST(LoadReport, StatesTheRateOrTheJobsInFlight) {
  LoadHeading heading = Heading();
  heading.options.rate = 25;
  const Json open = ParseJson(LoadJson(heading, Thousand())).value();
  heading.options.rate = 0;
  heading.options.in_flight = 7;
  const Json closed = ParseJson(LoadJson(heading, Thousand())).value();

  EXPECT_EQ(open.Find("rate")->Number(), 25);
  EXPECT_TRUE(open.Find("in_flight")->is_null());
  EXPECT_TRUE(closed.Find("rate")->is_null());
  EXPECT_EQ(closed.Find("in_flight")->Number(), 7);
}

TEST(LoadReport, TheTableHasTheSameFigures) {
  const std::string table = LoadTable(Heading(), Thousand());

  EXPECT_THAT(table, ContainsRegex("p50 +p90 +p99 +p99.9 +max ms"));
  EXPECT_THAT(
      table, ContainsRegex("1 +1000 +1000 +100.0 +50[0-4]\\.[0-9]+ +90[0-9]\\.[0-9]+ +99[0-9]\\."));
}

TEST(LoadReport, TellsOfJobsThatWereNotSent) {
  LoadResult result = Thousand();
  EXPECT_THAT(LoadTable(Heading(), result), Not(HasSubstr("not sent")));
  result.not_sent = 7;
  EXPECT_THAT(LoadTable(Heading(), result), HasSubstr("7 jobs were not sent"));
}

TEST(LoadReport, FailuresAreListedWithAnExample) {
  LoadResult result = Thousand();
  result.code["UNAVAILABLE"].Add(absl::Milliseconds(3), absl::Milliseconds(3));
  result.example["UNAVAILABLE"] = "no server there";

  EXPECT_THAT(LoadTable(Heading(), result), HasSubstr("UNAVAILABLE: no server there"));
  EXPECT_THAT(LoadTable(Heading(), result), ContainsRegex("UNAVAILABLE +1 +3\\.[0-9]+ "));
  EXPECT_THAT(LoadJson(Heading(), result), HasSubstr("\"example\": \"no server there\""));
  EXPECT_THAT(LoadTable(Heading(), Thousand()), Not(HasSubstr("not ok")));
}

}  // namespace
}  // namespace traverse::loadgen

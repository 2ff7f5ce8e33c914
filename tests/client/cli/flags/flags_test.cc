// Flags as people write them: client/cli/flags/flags.

#include "client/cli/flags/flags.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace traverse::cli {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Optional;

const std::vector<Flag>& TestTable() {
  static const std::vector<Flag> table = {
      {"o", "OUTPUT", ""},
      {"strategy", "NAME", ""},
      {"cost", "COST", "", {"length", "time"}},
      {"option", "NAME=VALUE", "", {}, true},
      {"cleaning_point", "X,Y", ""},
      {"seed", "N", ""},
      {"quiet", "", ""},
  };
  return table;
}

Flags Parse(const std::vector<std::string>& arguments) {
  absl::StatusOr<Flags> flags = Flags::Parse(TestTable(), arguments);
  EXPECT_TRUE(flags.ok()) << flags.status();
  return flags.ok() ? *std::move(flags) : Flags();
}

std::string ErrorOf(const std::vector<std::string>& arguments) {
  const absl::StatusOr<Flags> flags = Flags::Parse(TestTable(), arguments);
  EXPECT_EQ(flags.status().code(), absl::StatusCode::kInvalidArgument);
  return std::string(flags.status().message());
}

TEST(Flags, FlagsAndOperandsMayBeMixed) {
  const Flags flags = Parse({"in", "--strategy=tabu", "-o", "out", "--quiet", "more"});

  EXPECT_THAT(flags.operands(), ElementsAre("in", "more"));
  EXPECT_EQ(flags.Text("strategy"), "tabu");
  EXPECT_EQ(flags.Text("o"), "out");
  EXPECT_TRUE(flags.Switch("quiet"));
}

TEST(Flags, ValuesMayStandApart) {
  const Flags flags = Parse({"--strategy", "tabu", "--cleaning_point", "-1,-2", "-o", "-"});

  EXPECT_THAT(flags.operands(), IsEmpty());
  EXPECT_EQ(flags.Text("strategy"), "tabu");
  EXPECT_THAT(*flags.Pair("cleaning_point"), Optional(std::make_pair(-1., -2.)));
  EXPECT_EQ(flags.Text("o"), "-");
}

TEST(Flags, DashesInNamesAreUnderscores) {
  EXPECT_TRUE(Parse({"--cleaning-point=1,2"}).Has("cleaning_point"));
}

TEST(Flags, TwoDashesEndTheFlags) {
  EXPECT_THAT(Parse({"--quiet", "--", "--strategy", "-"}).operands(),
              ElementsAre("--strategy", "-"));
}

TEST(Flags, OneDashIsAnOperand) { EXPECT_THAT(Parse({"-"}).operands(), ElementsAre("-")); }

TEST(Flags, TheLastOneCountsUnlessRepeatable) {
  const Flags flags = Parse({"--seed=1", "--option=a=1", "--seed=2", "--option=b=2"});

  EXPECT_EQ(flags.Text("seed"), "2");
  EXPECT_THAT(flags.All("option"), ElementsAre("a=1", "b=2"));
}

TEST(Flags, SwitchesCanBeTurnedOff) {
  EXPECT_FALSE(Parse({"--quiet=false"}).Switch("quiet"));
  EXPECT_FALSE(Parse({}).Switch("quiet"));
}

TEST(Flags, ErrorsSayWhatWasMeant) {
  EXPECT_EQ(ErrorOf({"--strategie=x"}), "unknown flag --strategie; did you mean --strategy?");
  EXPECT_EQ(ErrorOf({"--strat=x"}), "unknown flag --strat; did you mean --strategy?");
  EXPECT_EQ(ErrorOf({"--zzz"}), "unknown flag --zzz");
  EXPECT_EQ(ErrorOf({"-x"}), "unknown flag -x");
  EXPECT_EQ(ErrorOf({"-seed=1"}), "unknown flag -seed; did you mean --seed?");
  EXPECT_EQ(ErrorOf({"--o=x"}), "unknown flag --o; did you mean -o?");
  EXPECT_EQ(ErrorOf({"--seed"}), "--seed needs a value: N");
  EXPECT_EQ(ErrorOf({"--seed", "--quiet"}), "--seed needs a value: N");
  EXPECT_EQ(ErrorOf({"--quiet=yes"}), "--quiet=yes: takes no value");
  EXPECT_EQ(ErrorOf({"--cost=tim"}), "--cost=tim: not one of length, time; did you mean time?");
}

TEST(Flags, NumbersAreChecked) {
  const auto error = [](const std::string& value) {
    return std::string(Parse({"--seed=" + value}).Integer("seed", 1, 10).status().message());
  };

  EXPECT_THAT(*Parse({"--seed=10"}).Integer("seed", 1, 10), Optional(10u));
  EXPECT_THAT(*Parse({}).Integer("seed", 1, 10), ::testing::Eq(std::nullopt));
  for (const char* value : {"0", "11", "-1", "1.5", "x", "", "1 ", "99999999999999999999"}) {
    EXPECT_EQ(error(value), "--seed=" + std::string(value) + ": not a whole number from 1 to 10");
  }
  EXPECT_THAT(*Parse({"--seed=2.5"}).Number("seed", 0, 10), Optional(2.5));
  for (const char* value : {"nan", "inf", "-0.1", "10.1", "1e300", "x"}) {
    EXPECT_FALSE(Parse({std::string("--seed=") + value}).Number("seed", 0, 10).ok()) << value;
  }
}

TEST(Flags, DurationsAreAbseils) {
  const auto duration = [](const std::string& value) {
    return Parse({"--seed=" + value}).Duration("seed");
  };

  EXPECT_THAT(*duration("0.1s"), Optional(absl::Milliseconds(100)));
  EXPECT_THAT(*duration("5m"), Optional(absl::Minutes(5)));
  EXPECT_THAT(*duration("1m30s"), Optional(absl::Seconds(90)));
  for (const char* value : {"", "5", "0s", "0.5ns", "-1s", "soon"})
    EXPECT_FALSE(duration(value).ok());
}

TEST(Flags, PointsAreTwoCoordinates) {
  const auto point = [](const std::string& value) {
    return Parse({"--seed=" + value}).Pair("seed");
  };

  EXPECT_THAT(*point("1.5,-2"), Optional(std::make_pair(1.5, -2.)));
  for (const char* value : {"", "1", "1,", ",1", "1,2,3", "1;2", "nan,1", "1,1e7"}) {
    EXPECT_FALSE(point(value).ok()) << value;
  }
}

}  // namespace
}  // namespace traverse::cli

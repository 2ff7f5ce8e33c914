#include "client/gateway/jobs/job_ids.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace traverse::gateway {
namespace {

JobIds Ids(const std::string& name) { return *JobIds::Make(name); }

TEST(JobIds, AreKnownToTheirCallerOnly) {
  const JobIds ids = Ids("farm-1");
  const std::string id = *ids.New("token:a");

  EXPECT_TRUE(ids.Check(id, "token:a").ok());
  EXPECT_TRUE(absl::IsNotFound(ids.Check(id, "token:b")));
  EXPECT_TRUE(absl::IsNotFound(ids.Check(id, "")));
}

TEST(JobIds, AreAllDifferent) {
  const JobIds ids = Ids("g");
  std::set<std::string> seen;

  for (int i = 0; i < 1000; ++i) seen.insert(*ids.New("a"));

  EXPECT_EQ(seen.size(), 1000u);
}

TEST(JobIds, OneWrongDigitIsNoId) {
  const JobIds ids = Ids("g");
  const std::string id = *ids.New("a");

  for (size_t i = 2; i < id.size(); ++i) {
    std::string wrong = id;
    wrong[i] = wrong[i] == '0' ? '1' : '0';
    EXPECT_FALSE(ids.Check(wrong, "a").ok()) << wrong;
  }
  for (const std::string& text :
       {std::string(), std::string("g"), std::string("g-"), "x" + id + "0", id + "0", id.substr(1),
        std::string(300, 'a'), std::string(56, '0')}) {
    EXPECT_FALSE(ids.Check(text, "a").ok()) << text;
  }
}

TEST(JobIds, NameTheirGateway) {
  const std::string id = *Ids("one").New("a");

  EXPECT_TRUE(absl::IsFailedPrecondition(Ids("two").Check(id, "a")));
  EXPECT_TRUE(absl::IsAborted(Ids("one").Check(id, "a"))) << "an earlier process of that name";
}

TEST(JobIds, NamesAreForPathsAndHeaders) {
  for (const char* name : {"a", "farm-1.example", "A_b-9"}) EXPECT_TRUE(IsGatewayName(name));
  for (const char* name : {"", "a/b", "a b", "a%", "\n"}) EXPECT_FALSE(IsGatewayName(name));
  EXPECT_FALSE(IsGatewayName(std::string(65, 'a')));
}

}  // namespace
}  // namespace traverse::gateway

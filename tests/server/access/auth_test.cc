#include "server/access/auth.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_cat.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using testing::StatusIs;

std::string Line(const std::string& name, const std::string& token) {
  const Sha256 hash = HashOf(token);
  const std::string bytes(reinterpret_cast<const char*>(hash.data()), hash.size());
  return absl::StrCat(name, " ", absl::BytesToHexString(bytes), "\n");
}

// A file of the test's own, removed with it.
class TokenFile {
 public:
  explicit TokenFile(const std::string& text) { Write(text); }

  // Replaces it at once, as a careful operator does.
  void Write(const std::string& text) const {
    std::ofstream(path_ + ".new") << text;
    std::rename((path_ + ".new").c_str(), path_.c_str());
  }
  const std::string& path() const { return path_; }

 private:
  const testing::ScratchFolder folder_;
  const std::string path_ = folder_.Path("tokens");
};

CallCredentials Bearer(const std::string& token) {
  return {absl::StrCat("Bearer ", token), {}, "ipv4:10.0.0.7"};
}

TEST(ParseTokens, ReadsNamesHashesAndComments) {
  ASSERT_OK_AND_ASSIGN(
      const std::vector<TokenEntry> tokens,
      ParseTokens(absl::StrCat("# the farm\n\n", Line("farm-1", "a"), Line("farm-1", "b"))));

  ASSERT_EQ(tokens.size(), 2u);
  EXPECT_EQ(tokens[0].name, "farm-1");
  EXPECT_EQ(tokens[0].hash, HashOf("a"));
}

TEST(ParseTokens, NamesTheLineAndRepeatsNothingOfIt) {
  for (const char* bad : {"farm my-secret-token", "farm", "fa/rm 00", "x 00 11"}) {
    EXPECT_THAT(ParseTokens(absl::StrCat("# a\n", bad, "\n")),
                StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 2: ")));
    EXPECT_THAT(ParseTokens(bad).status().ToString(), Not(HasSubstr("secret")));
  }
}

TEST(ParseTokens, ALineHasTwoWordsAndNoMore) {
  const std::string line = Line("farm", "a");
  EXPECT_OK(ParseTokens(line));
  EXPECT_OK(ParseTokens(line.substr(0, line.size() - 1) + " # since May"));

  EXPECT_THAT(ParseTokens(line.substr(0, line.size() - 1) + " more"),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 1: ")));
}

TEST(Authenticator, WithoutAnythingTheCallerIsTheAddress) {
  ASSERT_OK_AND_ASSIGN(const auto auth, Authenticator::Make({}, [](const absl::Status&) {}));

  ASSERT_OK_AND_ASSIGN(const std::string caller, auth->Identify(Bearer("ignored")));
  EXPECT_EQ(caller, "ipv4:10.0.0.7");
}

TEST(Authenticator, TokensNameTheCaller) {
  const TokenFile file(Line("farm-1", "sesame") + Line("farm-2", "open"));
  ASSERT_OK_AND_ASSIGN(const auto auth,
                       Authenticator::Make({file.path(), {}}, [](const absl::Status&) {}));

  ASSERT_OK_AND_ASSIGN(const std::string caller, auth->Identify(Bearer("open")));
  EXPECT_EQ(caller, "token:farm-2");
  for (const char* authorization : {"", "Bearer ", "Bearer wrong", "Basic open", "open"}) {
    const auto refused = auth->Identify({authorization, {}, "h"});
    EXPECT_THAT(refused, StatusIs(absl::StatusCode::kUnauthenticated, Not(HasSubstr("wrong"))))
        << authorization;
  }
}

TEST(Authenticator, KnowsATokenWhereverItIsShown) {
  const TokenFile file(Line("farm-1", "sesame"));
  ASSERT_OK_AND_ASSIGN(const auto auth,
                       Authenticator::Make({file.path(), {}}, [](const absl::Status&) {}));
  ASSERT_OK_AND_ASSIGN(const auto open, Authenticator::Make({}, [](const absl::Status&) {}));

  EXPECT_TRUE(auth->IsToken("sesame"));
  EXPECT_FALSE(auth->IsToken("a printer's key"));
  EXPECT_FALSE(auth->IsToken(""));
  EXPECT_FALSE(open->IsToken("sesame"));
}

TEST(Authenticator, FileIsReadAgainWhenItChanges) {
  const TokenFile file(Line("farm", "old"));
  std::vector<absl::Status> reloads;
  ASSERT_OK_AND_ASSIGN(const auto auth,
                       Authenticator::Make({file.path(), {}}, [&](const absl::Status& status) {
                         reloads.push_back(status);
                       }));
  EXPECT_OK(auth->Identify(Bearer("old")));

  file.Write(Line("farm", "new"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_OK(auth->Identify(Bearer("new")));
  EXPECT_THAT(auth->Identify(Bearer("old")),
              StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("unknown")));

  file.Write("not a token file\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  EXPECT_OK(auth->Identify(Bearer("new")));
  ASSERT_EQ(reloads.size(), 2u);
  EXPECT_OK(reloads[0]);
  EXPECT_THAT(reloads[1], StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("line 1")));
}

TEST(Authenticator, MissingFileIsAnErrorAtTheStart) {
  EXPECT_THAT(Authenticator::Make({"/proc/no_such_file", {}}, [](const absl::Status&) {}),
              StatusIs(absl::StatusCode::kInvalidArgument, HasSubstr("/proc/no_such_file")));
}

TEST(Authenticator, CertificatesNameTheCallerAndMayBeRestricted) {
  ASSERT_OK_AND_ASSIGN(const auto any, Authenticator::Make({}, [](const absl::Status&) {}));
  ASSERT_OK_AND_ASSIGN(const std::string caller, any->Identify({"", {"farm.example"}, "h"}));
  EXPECT_EQ(caller, "cert:farm.example");

  ASSERT_OK_AND_ASSIGN(const auto some,
                       Authenticator::Make({"", {"farm.example"}}, [](const absl::Status&) {}));
  EXPECT_OK(some->Identify({"", {"farm.example"}, "h"}));
  EXPECT_THAT(some->Identify({"", {"other.example"}, "h"}),
              StatusIs(absl::StatusCode::kPermissionDenied, HasSubstr("other.example")));
  for (const char* similar : {"farm", "farm.example.org", "a.farm.example", "FARM.example", ""}) {
    EXPECT_THAT(some->Identify({"", {similar}, "h"}),
                StatusIs(absl::StatusCode::kPermissionDenied, HasSubstr("not one that may call")))
        << similar;
  }
  EXPECT_THAT(some->Identify({"", {}, "h"}),
              StatusIs(absl::StatusCode::kUnauthenticated, HasSubstr("certificate")));
}

}  // namespace
}  // namespace traverse

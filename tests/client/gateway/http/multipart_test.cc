#include "client/gateway/http/multipart.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"

namespace traverse::gateway {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Writes parts down: "name(filename)=bytes".
class Recorder : public PartSink {
 public:
  absl::Status BeginPart(const PartHead& head) override {
    parts.push_back(absl::StrCat(head.name, head.filename ? "(" + *head.filename + ")" : "", "="));
    return absl::OkStatus();
  }
  absl::Status TakePart(std::string_view bytes) override {
    parts.back().append(bytes);
    return absl::OkStatus();
  }
  absl::Status EndPart() override {
    parts.back() += ".";
    return absl::OkStatus();
  }

  std::vector<std::string> parts;
};

std::string Part(const std::string& head, const std::string& body) {
  return absl::StrCat("--b\r\nContent-Disposition: form-data; ", head, "\r\n\r\n", body, "\r\n");
}

// The parts of `body`, or the fault as the last of them; fed `step` bytes at a time.
std::vector<std::string> Read(const std::string& body, size_t step) {
  Recorder recorder;
  MultipartReader reader("b", recorder);
  absl::Status status;
  for (size_t at = 0; at < body.size() && status.ok(); at += step) {
    status = reader.Feed(std::string_view(body).substr(at, step));
  }
  if (status.ok()) status = reader.Finish();
  if (!status.ok()) recorder.parts.push_back(std::string(status.message()));
  return recorder.parts;
}

TEST(Multipart, PartsAreTheSameHoweverTheyArrive) {
  const std::string body =
      Part("name=\"file\"; filename=\"a \\\"b\\\".gcode\"", "G1\r\n--a no\r\n-") +
      Part("name=empty", "") + Part("name=\"policy\"", "safe") + "--b--\r\n";
  for (size_t step = 1; step < body.size(); ++step) {
    EXPECT_THAT(Read(body, step),
                ElementsAre("file(a \"b\".gcode)=G1\r\n--a no\r\n-.", "empty=.", "policy=safe."))
        << step;
  }
}

TEST(Multipart, PreambleAndEpilogueAreNoParts) {
  EXPECT_THAT(Read("hello\r\n" + Part("name=a", "1") + "--b-- \r\nbye --b", 3),
              ElementsAre("a=1."));
}

TEST(Multipart, SaysWhatIsWrong) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {Part("name=a", "1"), "cut short"},
      {"", "cut short"},
      {"--b\r\n\r\nx\r\n--b--", "not form data"},
      {"--b\r\nContent-Type: text/plain\r\n\r\nx\r\n--b--", "not form data"},
      {"--b\r\nContent-Disposition: attachment; name=a\r\n\r\nx\r\n--b--", "not form data"},
      {"--b\r\nContent-Disposition: form-data\r\n\r\nx\r\n--b--", "has no name"},
      {"--b\r\nContent-Disposition: form-data; name=\"a\r\n\r\nx\r\n--b--", "cannot be read"},
      {"--b\r\nContent-Disposition: form-data; name=a; name=b\r\n\r\nx\r\n--b--", "cannot be read"},
      {"--b\r\nno colon\r\n\r\nx\r\n--b--", "no colon"},
      {"--bx\r\n", "bad boundary"},
      {"--b\r\nContent-Disposition: form-data; name=a\r\nContent-Transfer-Encoding: base64\r\n\r\n",
       "transfer encoding"},
      {std::string(100000, 'x'), "no boundary"},
      {"--b\r\nX: " + std::string(100000, 'x'), "longer than 8192"},
      {"--b" + std::string(1000, ' '), "bad boundary"},
  };
  for (const auto& [body, words] : cases) {
    for (const size_t step : {size_t{1}, size_t{7}, size_t{1000000}}) {
      const std::vector<std::string> parts = Read(body, step);
      ASSERT_FALSE(parts.empty());
      EXPECT_THAT(parts.back(), HasSubstr(words)) << body.substr(0, 80);
    }
  }
}

TEST(Multipart, HasABoundOfParts) {
  std::string body;
  for (int i = 0; i < 40; ++i) body += Part("name=a", "1");
  EXPECT_THAT(Read(body + "--b--", 4096).back(), HasSubstr("more than 32 parts"));
}

TEST(Multipart, BoundariesAreThoseOfRfc2046) {
  EXPECT_EQ(*BoundaryOf("multipart/form-data; boundary=abc"), "abc");
  EXPECT_EQ(*BoundaryOf("Multipart/Form-Data; charset=utf-8; Boundary=\"a b\""), "a b");
  for (const std::string type :
       {"multipart/form-data", "multipart/mixed; boundary=a", "multipart/form-data; boundary=",
        "multipart/form-data; boundary=\"a", "text/plain; boundary=a"}) {
    EXPECT_FALSE(BoundaryOf(type).ok()) << type;
  }
  EXPECT_FALSE(BoundaryOf("multipart/form-data; boundary=" + std::string(71, 'a')).ok());
}

}  // namespace
}  // namespace traverse::gateway

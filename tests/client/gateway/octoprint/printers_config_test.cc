#include "client/gateway/octoprint/printers_config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "client/files/write_file.h"
#include "tests/support/scratch_folder.h"

namespace traverse::gateway {
namespace {

using ::testing::HasSubstr;

TEST(PrintersConfig, ReadsAllFields) {
  const auto config = ParsePrinters(R"({"default": "b", "printers": [
      {"name": "a", "url": "http://a.local:5000/"},
      {"name": "b", "kind": "prusalink", "url": "https://b", "storage": "usb", "policy": "fast",
       "on_failure": "refuse", "tls_ca": "ca.pem"}]})");

  ASSERT_TRUE(config.ok()) << config.status();
  EXPECT_EQ(config->default_name, "b");
  EXPECT_EQ(config->printers[0].url, "http://a.local:5000");
  EXPECT_EQ(config->printers[0].kind, PrinterKind::kOctoPrint);
  EXPECT_FALSE(config->printers[0].refuse_on_failure);
  EXPECT_EQ(config->printers[1].kind, PrinterKind::kPrusaLink);
  EXPECT_EQ(config->printers[1].policy, gcode::Policy::kFast);
  EXPECT_TRUE(config->printers[1].refuse_on_failure);
  EXPECT_EQ(config->printers[1].storage, "usb");
}

TEST(PrintersConfig, ReadsTheLimitsOfAMachine) {
  const testing::ScratchFolder folder;
  const std::string path = folder.Path("printer.cfg");
  const std::string json =
      R"({"printers": [{"name": "a", "url": "http://a", "machine": ")" + path + "\"}]}";
  EXPECT_TRUE(absl::IsUnavailable(ParsePrinters(json).status()));

  ASSERT_TRUE(WriteWholeFile(path, "[printer]\nmax_velocity: 200\nmax_accel: 1234\n").ok());
  const auto config = ParsePrinters(json);
  ASSERT_TRUE(config.ok()) << config.status();
  ASSERT_TRUE(config->printers[0].machine.has_value());
  EXPECT_EQ(config->printers[0].machine->max_accel, 1234);

  ASSERT_TRUE(WriteWholeFile(path, "[printer]\nmax_velocity: 200\nmax_accel: fast\n").ok());
  EXPECT_THAT(std::string(ParsePrinters(json).status().message()),
              HasSubstr("printers[0].machine: " + path + ":3"));
}

TEST(PrintersConfig, OnePrinterIsTheDefault) {
  EXPECT_EQ(ParsePrinters(R"({"printers": [{"name": "a", "url": "http://a"}]})")->default_name,
            "a");
}

TEST(PrintersConfig, SaysWhatIsWrongAndWhere) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"", "not an object"},
      {"[]", "not an object"},
      {"{}", "no printers"},
      {R"({"printers": {}})", "printers:"},
      {R"({"printers": []})", "is empty"},
      {R"({"printers": [7]})", "printers[0]: not an object"},
      {R"({"printers": [{"url": "http://a"}]})", "printers[0]: has no name"},
      {R"({"printers": [{"name": "a"}]})", "printers[0]: has no url"},
      {R"({"printers": [{"name": "a/b", "url": "http://a"}]})", "printers[0].name"},
      {R"({"printers": [{"name": "a", "url": "file:///etc/passwd"}]})", "printers[0].url"},
      {R"({"printers": [{"name": "a", "url": "http://a?x=1"}]})", "printers[0].url"},
      {R"({"printers": [{"name": "a", "url": "http://a", "kind": "x"}]})", "printers[0].kind"},
      {R"({"printers": [{"name": "a", "url": "http://a", "policy": "x"}]})", "printers[0].policy"},
      {R"({"printers": [{"name": "a", "url": "http://a", "colour": "x"}]})", "printers[0].colour"},
      {R"({"printers": [{"name": "a", "url": "http://a", "policy": 7}]})", "not a string"},
      {R"({"printers": [{"name": "a", "url": "http://a", "api_key_file": "/not/there"}]})",
       "printers[0].api_key_file"},
      {R"({"printers": [{"name": "a", "url": "http://a"}, {"name": "a", "url": "http://a"}]})",
       "printers[1].name: there is another"},
      {R"({"default": "x", "printers": [{"name": "a", "url": "http://a"}]})", "default:"},
  };
  for (const auto& [json, words] : cases) {
    const auto config = ParsePrinters(json);
    ASSERT_FALSE(config.ok()) << json;
    EXPECT_THAT(std::string(config.status().message()), HasSubstr(words)) << json;
  }
}

}  // namespace
}  // namespace traverse::gateway

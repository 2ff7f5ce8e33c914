#include "server/ops/job_log.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <memory>
#include <string>

#include "tests/support/scratch_folder.h"

namespace traverse {
namespace {

constexpr auto kPatience = std::chrono::seconds(20);

// A log that a pipe holds, of which nobody reads anything yet.
class PipedLog {
 public:
  PipedLog() {
    const std::string path = folder_.Path("pipe");
    EXPECT_EQ(mkfifo(path.c_str(), 0600), 0);
    reader_ = open(path.c_str(), O_RDONLY | O_NONBLOCK);
    log_ = std::make_unique<JobLog>(path);
  }
  ~PipedLog() { close(reader_); }

  JobLog& log() { return *log_; }

  std::future<void> End() {
    return std::async(std::launch::async, [this] { log_.reset(); });
  }

  // All that comes until the log has ended.
  std::string Read(const std::future<void>& end) const {
    std::string text;
    char part[4096];
    while (true) {
      const bool ended = end.wait_for(std::chrono::milliseconds(1)) == std::future_status::ready;
      const ssize_t count = read(reader_, part, sizeof(part));
      if (count > 0) {
        text.append(part, static_cast<size_t>(count));
      } else if (ended) {
        return text;
      }
    }
  }

 private:
  const testing::ScratchFolder folder_;
  int reader_ = -1;
  std::unique_ptr<JobLog> log_;
};

// More than a pipe holds.
void Fill(JobLog& log) {
  for (int i = 0; i < 200; ++i) {
    log.Event(JobLog::Level::kInfo, "event", {{"text", std::string(1000, 'x')}});
  }
}

TEST(JobLog, EndsThoughNobodyReads) {
  PipedLog piped;
  Fill(piped.log());

  const std::future<void> end = piped.End();

  EXPECT_EQ(end.wait_for(kPatience), std::future_status::ready);
  piped.Read(end);
}

TEST(JobLog, WritesAllLinesToWhoReadsLate) {
  PipedLog piped;
  Fill(piped.log());
  piped.log().Event(JobLog::Level::kInfo, "the_last", {});

  const std::string text = piped.Read(piped.End());

  EXPECT_NE(text.find("the_last"), std::string::npos);
}

}  // namespace
}  // namespace traverse

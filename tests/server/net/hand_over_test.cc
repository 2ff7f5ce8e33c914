#include "server/net/hand_over.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "tests/server/support/service_fixture.h"

namespace traverse {
namespace {

// Two ends of a connection; that which is given away is closed by whoever has it.
struct Pair {
  Pair() { EXPECT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, ends), 0); }
  ~Pair() { close(ends[0]); }
  bool IsClosed() const {
    char byte = 0;
    return recv(ends[0], &byte, 1, 0) == 0;
  }
  int given_away() const { return ends[1]; }

  int ends[2];
};

bool Eventually(const std::function<bool()>& condition) {
  return testing::TestService::Eventually(condition);
}

TEST(HandOver, AHandThatIsKeptHoldsUpNoOther) {
  std::atomic<bool> done{false};
  std::mutex mutex;
  std::set<int> hands;
  HandOver hand_over(2, [&](int socket, int hand) {
    {
      std::lock_guard<std::mutex> lock(mutex);
      hands.insert(hand);
    }
    while (!done) usleep(1000);
    close(socket);
  });
  const Pair one;
  const Pair other;
  hand_over.Add(one.given_away(), "one");
  hand_over.Add(other.given_away(), "other");

  EXPECT_TRUE(Eventually([&] {
    std::lock_guard<std::mutex> lock(mutex);
    return hands == std::set<int>{0, 1};
  }));
  done = true;
  EXPECT_TRUE(Eventually([&] { return one.IsClosed() && other.IsClosed(); }));
  hand_over.Stop([](const std::string& peer) { ADD_FAILURE() << peer << " is done with"; });
}

TEST(HandOver, IsFullWhileManyWait) {
  std::atomic<bool> taken{false};
  std::atomic<bool> done{false};
  HandOver hand_over(1, [&](int socket, int) {
    taken = true;
    while (!done) usleep(1000);
    close(socket);
  });
  std::vector<Pair> pairs(HandOver::kMostWaiting + 1);
  for (const Pair& it : pairs) {
    EXPECT_FALSE(hand_over.IsFull());
    hand_over.Add(it.given_away(), "one of many");
    ASSERT_TRUE(Eventually([&] { return taken.load(); }));  // the first, at once
  }
  EXPECT_TRUE(hand_over.IsFull());

  done = true;
  EXPECT_TRUE(Eventually([&] { return pairs.back().IsClosed(); }));
  EXPECT_FALSE(hand_over.IsFull());
  hand_over.Stop([](const std::string&) {});
}

TEST(HandOver, StopCutsWhatIsTakenAndClosesWhatWaits) {
  std::atomic<bool> taken{false};
  std::atomic<bool> is_cut{false};
  HandOver hand_over(1, [&](int socket, int) {
    taken = true;
    while (!is_cut) usleep(1000);
    close(socket);
  });
  const Pair kept;
  const Pair waiting;
  hand_over.Add(kept.given_away(), "kept");
  ASSERT_TRUE(Eventually([&] { return taken.load(); }));
  hand_over.Add(waiting.given_away(), "waiting");

  std::vector<std::string> cut;
  hand_over.Stop([&](const std::string& peer) {
    cut.push_back(peer);
    is_cut = true;
  });

  EXPECT_THAT(cut, ::testing::ElementsAre("kept"));
  EXPECT_TRUE(kept.IsClosed());
  EXPECT_TRUE(waiting.IsClosed());
}

}  // namespace
}  // namespace traverse

#include "server/net/hand_over.h"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <atomic>
#include <mutex>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "tests/server/support/service_fixture.h"

namespace traverse {
namespace {

using testing::TestService;

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

TEST(HandOver, AHandThatIsKeptHoldsUpNoOther) {
  std::atomic<int> done{0};  // so many connections
  std::mutex mutex;
  std::vector<int> hands;
  HandOver hand_over(2, [&](int socket, int hand) {
    size_t taken = 0;
    {
      std::lock_guard<std::mutex> lock(mutex);
      hands.push_back(hand);
      taken = hands.size();
    }
    while (static_cast<size_t>(done) < taken) usleep(1000);
    close(socket);
  });
  const auto both_have_taken = [&](size_t first) {
    return TestService::Eventually([&] {
      std::lock_guard<std::mutex> lock(mutex);
      return hands.size() == first + 2 && hands[first] != hands[first + 1];
    });
  };
  const Pair one;
  const Pair other;
  hand_over.Add(one.given_away(), "one");
  hand_over.Add(other.given_away(), "other");
  EXPECT_TRUE(both_have_taken(0));
  done = 2;
  EXPECT_TRUE(TestService::Eventually([&] { return one.IsClosed() && other.IsClosed(); }));

  // Whoever takes the next has come back.
  const Pair third;
  const Pair fourth;
  hand_over.Add(third.given_away(), "third");
  hand_over.Add(fourth.given_away(), "fourth");
  EXPECT_TRUE(both_have_taken(2));
  std::set<std::string> cut;
  hand_over.Stop([&](const std::string& peer) {
    cut.insert(peer);
    done = 4;
  });
  EXPECT_EQ(cut, (std::set<std::string>{"third", "fourth"})) << "the first two are done with";
}

// One hand, kept by the first connection until it is let go.
class KeptHand {
 public:
  KeptHand()
      : hand_over_(1, [this](int socket, int) {
          taken_ = true;
          while (!done_) usleep(1000);
          std::lock_guard<std::mutex> lock(mutex_);
          order_.push_back(socket);
          close(socket);
        }) {}
  ~KeptHand() {
    done_ = true;
    hand_over_.Stop([](const std::string&) {});
  }

  // A socket that is as good as any. Returns it and what Add returned.
  std::pair<int, std::string> Add(const std::string& peer) {
    const int socket = open("/dev/null", O_RDONLY | O_CLOEXEC);
    std::string away = hand_over_.Add(socket, peer);
    EXPECT_TRUE(TestService::Eventually([&] { return taken_.load(); }));  // the first, at once
    return {socket, std::move(away)};
  }
  void LetGo() { done_ = true; }
  HandOver& hand_over() { return hand_over_; }
  std::vector<int> order() {
    std::lock_guard<std::mutex> lock(mutex_);
    return order_;
  }

 private:
  std::atomic<bool> taken_{false};
  std::atomic<bool> done_{false};
  std::mutex mutex_;
  std::vector<int> order_;
  HandOver hand_over_;
};

TEST(HandOver, AddressesTakeTurns) {
  KeptHand kept;
  const int first = kept.Add("10.0.0.1:1").first;
  const int second = kept.Add("10.0.0.1:2").first;
  const int third = kept.Add("10.0.0.1:3").first;
  const int other = kept.Add("10.0.0.2:1").first;

  kept.LetGo();

  EXPECT_TRUE(TestService::Eventually([&] { return kept.order().size() == 4; }));
  EXPECT_THAT(kept.order(), ::testing::ElementsAre(first, second, other, third));
}

TEST(HandOver, IsFullWhileManyOfManyAddressesWait) {
  KeptHand kept;
  for (size_t i = 0; i <= HandOver::kMostWaiting + 1; ++i) {
    EXPECT_FALSE(kept.hand_over().IsFull());
    EXPECT_EQ(kept.Add(absl::StrCat("10.0.", i % 20, ".1:", i)).second, "");
  }
  EXPECT_TRUE(kept.hand_over().IsFull());

  kept.LetGo();

  EXPECT_TRUE(TestService::Eventually([&] { return !kept.hand_over().IsFull(); }));
}

TEST(HandOver, TurnsTheLastAwayOfTheAddressThatHasMost) {
  KeptHand kept;
  kept.Add("10.0.0.1:0");
  EXPECT_EQ(kept.hand_over().TurnAway(), "");  // the one in hand is not to be had
  kept.Add("10.0.0.2:1");
  for (size_t i = 1; i < HandOver::kMostWaiting; ++i) {
    EXPECT_EQ(kept.Add(absl::StrCat("10.0.0.1:", i)).second, "");
  }

  EXPECT_EQ(kept.Add("10.0.0.1:9999").second, "10.0.0.1:9999");
  EXPECT_EQ(kept.Add("10.0.0.2:2").second, absl::StrCat("10.0.0.1:", HandOver::kMostWaiting - 1));
  EXPECT_EQ(kept.hand_over().TurnAway(), absl::StrCat("10.0.0.1:", HandOver::kMostWaiting - 2));
  EXPECT_FALSE(kept.hand_over().IsFull());
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
  ASSERT_TRUE(TestService::Eventually([&] { return taken.load(); }));
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

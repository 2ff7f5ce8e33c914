#include "server/jobs/admission.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::StatusIs;

constexpr char kRetryInfo[] = "type.googleapis.com/google.rpc.RetryInfo";

class AdmissionTest : public ::testing::Test {
 protected:
  std::function<void(Refusal)> Count() {
    return [this](Refusal refusal) { refusals_.push_back(RefusalName(refusal)); };
  }

  std::vector<std::string> refusals_;
};

TEST_F(AdmissionTest, FullQueueRefusesWithADelay) {
  Admission admission({.max_queued_points = 100}, Count());
  auto first = admission.Admit("a", 60);
  ASSERT_OK(first);

  const auto refused = admission.Admit("b", 60);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("60 of 100")));
  EXPECT_TRUE(refused.status().GetPayload(kRetryInfo).has_value());
  EXPECT_THAT(refusals_, ElementsAre("queue"));
  EXPECT_EQ(admission.queued_points(), 60);

  (*first)->Remove(30, 0, 0.001);
  EXPECT_OK(admission.Admit("b", 60));
}

TEST_F(AdmissionTest, EmptyQueueTakesAJobOfAnySize) {
  Admission admission({.max_queued_points = 100}, Count());

  EXPECT_OK(admission.Admit("a", 1000));
}

TEST_F(AdmissionTest, PlacesAreLimitedAndFreedWithTheTicket) {
  Admission admission({.max_jobs = 2, .max_jobs_per_caller = 2}, Count());
  auto first = admission.Admit("a", 1);
  auto second = admission.Admit("b", 1);

  EXPECT_THAT(admission.Admit("c", 1),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("all 2 places")));
  second->reset();
  EXPECT_OK(admission.Admit("c", 1));
  EXPECT_THAT(refusals_, ElementsAre("jobs"));
}

TEST_F(AdmissionTest, TheLastQuarterIsForCallersWhoHaveNone) {
  int asked = 0;
  Admission admission({.max_jobs = 8}, Count(), [&asked] { ++asked; });
  std::vector<std::unique_ptr<Admission::Ticket>> held;
  for (int i = 0; i < 6; ++i) held.push_back(*admission.Admit(i % 2 == 0 ? "a" : "b", 1));

  const auto refused = admission.Admit("a", 1);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("have none")));
  EXPECT_TRUE(refused.status().GetPayload(kRetryInfo).has_value());
  held.push_back(*admission.Admit("c", 1));
  EXPECT_FALSE(admission.Admit("c", 1).ok());
  held.push_back(*admission.Admit("d", 1));
  EXPECT_EQ(asked, 0);

  // Somebody who has none finds no place: an idle job is to give way.
  EXPECT_THAT(admission.Admit("e", 1),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("all 8 places")));
  EXPECT_EQ(asked, 1);
}

TEST_F(AdmissionTest, CallersHaveLimitsOfTheirOwn) {
  Admission admission({.max_jobs = 10, .max_jobs_per_caller = 1}, Count());
  auto first = admission.Admit("a", 1);

  const auto refused = admission.Admit("a", 1);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("this caller")));
  EXPECT_TRUE(refused.status().GetPayload(kRetryInfo).has_value());
  EXPECT_OK(admission.Admit("b", 1));
  EXPECT_THAT(refusals_, ElementsAre("caller_jobs"));
}

TEST_F(AdmissionTest, DrainingRefusesAsUnavailable) {
  Admission admission({}, Count());
  auto first = admission.Admit("a", 1);
  admission.StartDraining();

  EXPECT_THAT(admission.Admit("a", 1),
              StatusIs(absl::StatusCode::kUnavailable, HasSubstr("shutting down")));
  EXPECT_EQ(admission.jobs(), 1);
  EXPECT_THAT(refusals_, ElementsAre("draining"));
}

TEST_F(AdmissionTest, StreamsAreHeldBackWhileTheQueueIsFull) {
  Admission admission({.max_queued_points = 100}, Count());
  auto batch = admission.Admit("a", 90);
  auto stream = admission.Admit("b", 0);
  EXPECT_TRUE((*stream)->MayBringMore());

  (*stream)->Add(20);
  EXPECT_FALSE((*stream)->MayBringMore());
  (*batch)->Remove(50, 0, 0.001);
  EXPECT_TRUE((*stream)->MayBringMore());
}

TEST_F(AdmissionTest, NoCallerFillsTheWholeQueue) {
  Admission admission({.max_queued_points = 1000, .max_queued_points_per_caller = 100}, Count());
  auto first = admission.Admit("a", 60);

  EXPECT_THAT(admission.Admit("a", 60),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("this caller's share")));
  EXPECT_OK(admission.Admit("b", 60));
  EXPECT_THAT(refusals_, ElementsAre("caller_queue"));

  (*first)->Add(40);
  EXPECT_FALSE((*first)->MayBringMore());
}

// Solves a point in a millisecond of a worker.
void SolveSome(Admission& admission) {
  auto ticket = admission.Admit("before", 1000);
  (*ticket)->Remove(1000, 0, 1.0);
}

TEST_F(AdmissionTest, WhoWouldTakeFarLongerThanAloneIsRefusedWithADelay) {
  Admission admission({.max_wait = absl::Milliseconds(250), .max_slowdown = 10, .workers = 2},
                      Count());
  SolveSome(admission);
  std::vector<std::unique_ptr<Admission::Ticket>> tickets;
  // Each is 0.5 s alone, on two workers; the tenth one takes 5 s.
  for (int i = 0; i < 10; ++i) {
    auto ticket = admission.Admit("a", 1000);
    ASSERT_OK(ticket) << i;
    tickets.push_back(*std::move(ticket));
  }

  const auto refused = admission.Admit("a", 1000);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted,
                                HasSubstr("would take about 5.5s, alone 500ms")));
  EXPECT_TRUE(refused.status().GetPayload(kRetryInfo).has_value());
  EXPECT_THAT(refusals_, ElementsAre("wait"));

  tickets.pop_back();
  EXPECT_OK(admission.Admit("a", 1000));
}

TEST_F(AdmissionTest, SmallJobsAreLetInBesideLargeOnes) {
  Admission admission({.max_slowdown = 10}, Count());
  SolveSome(admission);
  std::vector<std::unique_ptr<Admission::Ticket>> tickets;
  for (int i = 0; i < 4; ++i) tickets.push_back(*admission.Admit("a", 500'000));

  // Turn by turn it is done when the others have had as much: 5 times its own time.
  EXPECT_OK(admission.Admit("a", 100));
  EXPECT_OK(admission.Admit("b", 100));
}

TEST_F(AdmissionTest, ManyJobsOfOneCallerCountAsOneForAnother) {
  Admission admission({.max_slowdown = 10}, Count());
  SolveSome(admission);
  std::vector<std::unique_ptr<Admission::Ticket>> tickets;
  for (int i = 0; i < 10; ++i) tickets.push_back(*admission.Admit("a", 10'000));

  EXPECT_FALSE(admission.Admit("a", 10'000).ok());
  EXPECT_OK(admission.Admit("b", 10'000));
}

TEST_F(AdmissionTest, JobsWhoseCallersStallAreNoLoadForOthers) {
  Admission admission(
      {.max_queued_points = 30'000, .max_wait = absl::Milliseconds(1), .max_slowdown = 1}, Count());
  SolveSome(admission);
  auto stalled = *admission.Admit("a", 29'000);
  EXPECT_THAT(admission.Admit("b", 2'000),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("queue")));
  EXPECT_THAT(admission.Admit("b", 500),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("busy")));

  stalled->WatchWork([] { return false; });

  EXPECT_OK(admission.Admit("b", 2'000));
}

TEST_F(AdmissionTest, TheTimeOfAJobDependsOnItsStrategy) {
  Admission admission({.max_wait = absl::Milliseconds(1), .max_slowdown = 1.5}, Count());
  const auto solve = [&admission](const std::string& strategy, double seconds) {
    auto ticket = *admission.Admit("before", 0);
    EXPECT_OK(ticket->SetStrategy(strategy));
    ticket->Add(1000);
    ticket->Remove(1000, 0, seconds);
  };
  solve("quick", 0.001);
  solve("slow", 10.0);
  auto other = *admission.Admit("a", 0);
  EXPECT_OK(other->SetStrategy("quick"));
  other->Add(1000);

  // Beside a millisecond of another's work: nothing for ten seconds, much for another millisecond.
  auto job = *admission.Admit("b", 0);
  EXPECT_OK(job->Resize(1000));
  EXPECT_OK(job->SetStrategy("slow"));
  EXPECT_THAT(job->SetStrategy("quick"),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("alone 1ms")));
}

TEST_F(AdmissionTest, MemoryIsLimitedForAllAndForEachCaller) {
  Admission admission({.max_bytes = 1000, .max_bytes_per_caller = 600}, Count());
  auto first = *admission.Admit("a", 0);
  auto second = *admission.Admit("a", 0);
  auto other = *admission.Admit("b", 0);

  EXPECT_OK(first->Hold(500));
  const absl::Status refused = second->Hold(200);
  EXPECT_THAT(refused, StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("caller's")));
  EXPECT_TRUE(refused.GetPayload(kRetryInfo).has_value());
  EXPECT_OK(other->Hold(400));
  EXPECT_THAT(other->Hold(150),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("server's")));
  EXPECT_THAT(refusals_, ElementsAre("caller_memory", "memory"));
  EXPECT_EQ(admission.held_bytes(), 900);
  // What can never fit is not to be tried again.
  const auto never = [](const absl::Status& status) {
    return !status.GetPayload(kRetryInfo).has_value() &&
           status.message().find("try again") == std::string::npos;
  };
  EXPECT_TRUE(never(second->Hold(5000)));
  EXPECT_FALSE(never(second->Hold(550)));
  EXPECT_TRUE(never(second->Hold(550, 100))) << "beside the bytes of the message itself";

  // A layer is solved, then the job ends.
  first->Add(10);
  first->Remove(5, 150, 0.1);
  EXPECT_EQ(admission.held_bytes(), 750);
  first.reset();
  other->LetGo(400);
  EXPECT_EQ(admission.held_bytes(), 0);
}

// Layers of few points may hold much: nodes and pairs. Solving the others frees nothing of that.
TEST_F(AdmissionTest, MemoryIsFreedByWhatEachLayerHeld) {
  Admission admission({}, Count());
  auto job = *admission.Admit("a", 0);
  EXPECT_OK(job->Hold(1000));
  job->Add(101);

  job->Remove(100, 10, 0.1);
  EXPECT_EQ(admission.held_bytes(), 990);

  job->Remove(1, 990, 0.1);
  EXPECT_EQ(admission.held_bytes(), 0);
}

// Answers wait for readers who are slow, or read nothing.
TEST_F(AdmissionTest, AnswersTakeMemoryUntilTheyAreWritten) {
  Admission admission({.max_bytes = 1000, .max_bytes_per_caller = 600}, Count());
  auto slow = *admission.Admit("a", 0);
  auto next = *admission.Admit("a", 0);
  EXPECT_OK(slow->Hold(300));
  slow->Remove(1, 300, 0.1);

  slow->KeepAnswer(700);  // whether there is room or not

  EXPECT_EQ(admission.held_bytes(), 700);
  EXPECT_THAT(next->Hold(100),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("caller's")));
  slow->LetGoAnswer(500);
  EXPECT_OK(next->Hold(100));
  slow.reset();
  EXPECT_EQ(admission.held_bytes(), 100) << "what was never written goes with the job";
}

TEST_F(AdmissionTest, NoJobIsLetInWhileMemoryIsShort) {
  Admission admission({}, Count());
  admission.SetMemoryShort(true);
  EXPECT_THAT(admission.Admit("a", 1),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("memory")));
  EXPECT_THAT(refusals_, ElementsAre("memory"));

  admission.SetMemoryShort(false);
  EXPECT_OK(admission.Admit("a", 1));
}

TEST_F(AdmissionTest, WhatTakesLittleTimeIsLetInHoweverManyTimesAsLongItTakes) {
  Admission admission({.max_wait = absl::Milliseconds(250), .max_slowdown = 10}, Count());
  SolveSome(admission);
  std::vector<std::unique_ptr<Admission::Ticket>> tickets;
  for (int i = 0; i < 50; ++i) {
    auto ticket = admission.Admit("a", 5);
    ASSERT_OK(ticket) << i;
    tickets.push_back(*std::move(ticket));
  }

  EXPECT_FALSE(admission.Admit("a", 5).ok());
}

TEST_F(AdmissionTest, AJobIsCheckedAgainWhenItsSizeIsKnown) {
  Admission admission({.max_queued_points = 100}, Count());
  auto first = *admission.Admit("a", 1);
  auto second = *admission.Admit("b", 1);

  EXPECT_OK(first->Resize(90));
  EXPECT_THAT(second->Resize(20),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("the queue is full: 90")));
  EXPECT_THAT(refusals_, ElementsAre("queue"));
  EXPECT_OK(first->Resize(10));
  EXPECT_OK(second->Resize(20));
  EXPECT_EQ(admission.queued_points(), 30);
}

TEST_F(AdmissionTest, NothingIsLeftBehindByManyThreads) {
  Admission admission({.max_jobs = 3, .max_queued_points = 100}, [](Refusal) {});
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; ++t) {
    threads.emplace_back([&admission, t] {
      for (int i = 0; i < 300; ++i) {
        auto ticket = admission.Admit(std::to_string(t % 2), 40);
        if (!ticket.ok()) continue;
        (*ticket)->Add(5);
        (*ticket)->Remove(20, 0, 0.001);
      }
    });
  }
  for (std::thread& thread : threads) thread.join();

  EXPECT_EQ(admission.jobs(), 0);
  EXPECT_EQ(admission.queued_points(), 0);
}

// A clock that stands.
class StoppedClock : public TimeSource {
 public:
  Budget::Clock::time_point Now() const override { return now; }
  Budget::Clock::time_point now{};
};

TEST_F(AdmissionTest, RefusesAJobWhoseDeadlineIsTooEarlyEvenForGreedy) {
  StoppedClock clock;
  Admission admission(
      {}, Count(), [] {}, &clock);
  const auto in = [&](int ms) { return clock.now + std::chrono::milliseconds(ms); };
  auto running = *admission.Admit("a", 1000);
  EXPECT_OK(admission.Admit("a", 1000, in(10)));

  (*admission.Admit("a", 1000))->NoteLag(0.150);
  const auto refused = admission.Admit("a", 1000, in(100));

  EXPECT_THAT(refused,
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("deadline is too early")));
  EXPECT_TRUE(refused.status().GetPayload(kRetryInfo).has_value());
  EXPECT_THAT(refusals_, ElementsAre("deadline"));
  EXPECT_OK(admission.Admit("a", 1000, in(200)));
  EXPECT_OK(admission.Admit("a", 1000));
  // The way back to one caller is nothing to another.
  EXPECT_OK(admission.Admit("b", 1000, in(10)));
  // A lag is soon forgotten.
  clock.now += std::chrono::seconds(5);
  EXPECT_OK(admission.Admit("a", 1000, in(100)));
}

TEST_F(AdmissionTest, CountsTheTimeOfGreedyForTheWholeJob) {
  StoppedClock clock;
  Admission admission(
      {}, Count(), [] {}, &clock);
  auto running = *admission.Admit("a", 1);
  const auto deadline = clock.now + std::chrono::milliseconds(100);

  EXPECT_OK(admission.Admit("a", 100'000, deadline));
  EXPECT_FALSE(admission.Admit("a", 1'000'000, deadline).ok());
  auto batch = *admission.Admit("a", 0, deadline);
  EXPECT_FALSE(batch->Resize(1'000'000).ok());
}

// At 0.5 us a point on two workers.
TEST_F(AdmissionTest, CountsTheTimeOfGreedyForWhatIsDueBefore) {
  StoppedClock clock;
  Admission admission(
      {.workers = 2}, Count(), [] {}, &clock);
  const auto in = [&](int ms) { return clock.now + std::chrono::milliseconds(ms); };
  auto first = *admission.Admit("a", 200'000, in(100));
  auto later = *admission.Admit("a", 1'000'000, in(5000));
  auto whenever = *admission.Admit("a", 1'000'000);

  EXPECT_OK(admission.Admit("a", 90'000, in(100)));
  EXPECT_FALSE(admission.Admit("a", 110'000, in(100)).ok());
  EXPECT_OK(admission.Admit("a", 150'000, in(99)));

  // Other callers have as much of the time as this one, and no more.
  auto mine = *admission.Admit("b", 1);
  EXPECT_OK(admission.Admit("b", 130'000, in(100)));
  EXPECT_FALSE(admission.Admit("b", 140'000, in(100)).ok());

  EXPECT_EQ(later->PointsDueBefore(), 100'000);
  first->Remove(150'000, 0, 0.1);
  EXPECT_EQ(later->PointsDueBefore(), 25'000);
  EXPECT_OK(admission.Admit("b", 140'000, in(100)));
  EXPECT_EQ(first->PointsDueBefore(), 0);
  EXPECT_EQ(whenever->PointsDueBefore(), 0);
}

TEST_F(AdmissionTest, WhatTheClockCutsShortMayTakeAsLongAsItIsGiven) {
  StoppedClock clock;
  Admission admission(
      {.max_wait = absl::Milliseconds(250), .max_slowdown = 3}, Count(), [] {}, &clock);
  const auto in = [&](int ms) { return clock.now + std::chrono::milliseconds(ms); };
  const auto solve = [&](bool cut_short) {
    for (int i = 0; i < 10'000; ++i)
      (*admission.Admit("before", 0))->Remove(100, 0, 0.1, cut_short);
  };
  std::vector<std::unique_ptr<Admission::Ticket>> running;
  for (int i = 0; i < 10; ++i) running.push_back(*admission.Admit("a", 100, in(500)));

  solve(/*cut_short=*/false);
  EXPECT_THAT(admission.Admit("a", 100, in(500)),
              StatusIs(absl::StatusCode::kResourceExhausted, HasSubstr("busy")));
  solve(/*cut_short=*/true);
  EXPECT_OK(admission.Admit("a", 100, in(500)));
  EXPECT_FALSE(admission.Admit("a", 100, in(300)).ok());
  EXPECT_FALSE(admission.Admit("a", 100).ok());
}

}  // namespace
}  // namespace traverse

#include "server/net/connections.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "server/net/socket_info.h"
#include "tests/server/net/raw_port.h"
#include "tests/server/support/service_fixture.h"
#include "tests/support/status_matchers.h"

namespace traverse {
namespace {

using testing::Caller;
using testing::Port;
using testing::Reader;
using testing::TestService;

TEST(ConnectionsTest, AStrangerWhoSendsMuchIsCut) {
  Port port({.stranger_bytes = 1 << 20});
  const Caller loud(port.connections().port());
  const Caller quiet(port.connections().port());

  quiet.Send(1000);
  loud.Send(4 << 20);

  EXPECT_TRUE(TestService::Eventually([&] { return loud.IsCut(); }));
  EXPECT_FALSE(quiet.IsCut());
  EXPECT_EQ(port.connections().cut(), 1u);
}

TEST(ConnectionsTest, WhoeverTakesConnectionsInMayBeKeptByThem) {
  Port port({.stranger_bytes = 1 << 20}, Reader::kTaker);
  const Caller quiet(port.connections().port());
  quiet.Send(1000);
  const Caller loud(port.connections().port());

  loud.Send(4 << 20);

  EXPECT_TRUE(TestService::Eventually([&] { return loud.IsCut(); }));
  EXPECT_FALSE(quiet.IsCut());
  EXPECT_EQ(port.connections().open(), 1);
  port.connections().StopListening();  // comes to an end though `quiet` does not
  EXPECT_TRUE(TestService::Eventually([&] { return quiet.IsCut(); }));
}

TEST(ConnectionsTest, WhatIsDeliveredIsNotHeldAgainstACaller) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 1 << 20, .quiet_bytes = 1 << 20});
  const Caller caller(port.connections().port());

  for (int i = 0; i < 20; ++i) {
    caller.Send(500'000);
    ASSERT_TRUE(
        TestService::Eventually([&] { return port.connections().pending_bytes() > 200'000; }));
    port.connections().OnMessage(caller.peer(), 500'000);
  }

  EXPECT_FALSE(caller.IsCut());
}

// The table may be looked at between a call's headers and its bytes, however long a busy machine
// lets that take. Then only a part of what the call may send stays allowed, hence the room here.
TEST(ConnectionsTest, WhatCallsSentBeforeTheyWereRefusedIsNotHeldAgainstTheirCaller) {
  Port port({.stranger_bytes = 1 << 20, .quiet_bytes = 1 << 20});
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));

  for (int round = 0; round < 5; ++round) {
    for (int i = 0; i < 15; ++i) port.connections().OnAuthorized(caller.peer());
    if (round % 2 == 1) std::this_thread::sleep_for(std::chrono::milliseconds(150));
    caller.Send(15 * 65'535);
    std::this_thread::sleep_for(std::chrono::milliseconds(150));
  }

  EXPECT_FALSE(caller.IsCut());
}

TEST(ConnectionsTest, CallsThatSendNothingAreNoLicenceToSendMuchLater) {
  Port port({.stranger_bytes = 1 << 20});
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));

  for (int i = 0; i < 1000; ++i) port.connections().OnAuthorized(caller.peer());
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  caller.Send(2 << 20);

  EXPECT_TRUE(TestService::Eventually([&] { return caller.IsCut(); }));
}

TEST(ConnectionsTest, AJobWhoseMessageIsTooLongIsEndedFirst) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 2 << 20});
  port.MayEndJobs();
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));
  port.connections().OnJob(caller.peer());

  caller.Send(2'500'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(port.told().empty());
  caller.Send(1'500'000);

  EXPECT_TRUE(TestService::Eventually([&] { return !port.told().empty(); }));
  EXPECT_EQ(port.told()[0], PeerKey(caller.peer()));
  EXPECT_FALSE(caller.IsCut());
}

TEST(ConnectionsTest, AJobThatCannotBeEndedIsCut) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 1 << 20});
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));
  port.connections().OnJob(caller.peer());

  caller.Send(4 << 20);

  EXPECT_TRUE(TestService::Eventually([&] { return caller.IsCut(); }));
  EXPECT_EQ(port.told().size(), 1u);
}

// Of calls to health, or to nothing, only their bytes are seen.
TEST(ConnectionsTest, BytesThatNoCallExplainsAreAFloodAfterAMoment) {
  Port port({.quiet_bytes = 100'000});
  const Caller flood(port.connections().port());
  const Caller caller(port.connections().port());
  const Caller ended(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 3; }));

  port.connections().OnJobDone(ended.peer(), port.connections().OnJob(ended.peer()), false);
  for (const Caller* each : {&flood, &caller, &ended}) each->Send(300'000);
  std::this_thread::sleep_for(std::chrono::milliseconds(120));
  EXPECT_FALSE(flood.IsCut());
  for (int i = 0; i < 5; ++i) port.connections().OnAuthorized(caller.peer());

  EXPECT_TRUE(TestService::Eventually([&] { return flood.IsCut(); }));
  EXPECT_FALSE(caller.IsCut());
  EXPECT_FALSE(ended.IsCut());
}

TEST(ConnectionsTest, WhoHasMostConnectionsMakesRoomForOthers) {
  Port port({.max_connections = 4});
  std::vector<std::unique_ptr<Caller>> many;
  for (int i = 0; i < 4; ++i) {
    many.push_back(std::make_unique<Caller>(port.connections().port()));
    ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == i + 1; }));
  }

  const Caller one_more(port.connections().port());
  EXPECT_TRUE(TestService::Eventually([&] { return one_more.IsCut(); }));
  const Caller other(port.connections().port(), "127.0.0.2");

  EXPECT_TRUE(TestService::Eventually([&] { return many[0]->IsCut(); }));
  EXPECT_FALSE(many[1]->IsCut());
  EXPECT_FALSE(other.IsCut());
}

TEST(ConnectionsTest, FewFilesLeaveFewerConnections) {
  Port port({.files_part = 0.25});
  rlimit usual{};
  ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &usual), 0);
  const rlimit few{80, usual.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &few), 0);
  std::vector<std::unique_ptr<Caller>> idle;
  for (int i = 0; i < 10; ++i) idle.push_back(std::make_unique<Caller>(port.connections().port()));

  // A quarter of 60, two each.
  EXPECT_TRUE(
      TestService::Eventually([&] { return port.connections().cut() == 0 && idle[9]->IsCut(); }));
  EXPECT_EQ(port.connections().open(), 7);
  EXPECT_EQ(setrlimit(RLIMIT_NOFILE, &usual), 0);
  const Caller other(port.connections().port());
  EXPECT_TRUE(TestService::Eventually([&] { return port.connections().open() == 8; }));
}

// As HTTP/2 lets it: each call is reset before the next one is opened.
TEST(ConnectionsTest, MoreCallsThanStreamsAreAFlood) {
  Port port({.max_calls = 10});
  const Caller calm(port.connections().port());
  const Caller flood(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 2; }));

  for (int i = 0; i < 100; ++i) {
    port.connections().OnCall(calm.peer());
    port.connections().OnCallDone(calm.peer());
  }
  for (int i = 0; i < 11; ++i) port.connections().OnCall(flood.peer());

  EXPECT_TRUE(TestService::Eventually([&] { return flood.IsCut(); }));
  EXPECT_FALSE(calm.IsCut());
}

TEST(ConnectionsTest, TheAddressOfAFloodIsTurnedAwayForAWhile) {
  Port port({.max_calls = 10});
  // Those who went before are in the table until it is looked at.
  const auto others_are_gone = [&] { return port.connections().open() == 0; };
  const auto is_let_in = [&](const char* source) {
    if (!TestService::Eventually(others_are_gone)) return false;
    const Caller caller(port.connections().port(), source);
    return TestService::Eventually([&] { return port.connections().open() == 1; });
  };
  const auto is_turned_away = [&](const char* source) {
    const Caller caller(port.connections().port(), source);
    return TestService::Eventually([&] { return caller.IsCut(); });
  };
  const auto make_flood = [&] {
    ASSERT_TRUE(TestService::Eventually(others_are_gone));
    const Caller flood(port.connections().port());
    ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));
    for (int i = 0; i < 11; ++i) port.connections().OnCall(flood.peer());
    ASSERT_TRUE(TestService::Eventually([&] { return flood.IsCut(); }));
  };

  make_flood();
  EXPECT_TRUE(is_turned_away("127.0.0.1"));
  EXPECT_TRUE(is_let_in("127.0.0.2"));
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  EXPECT_TRUE(is_let_in("127.0.0.1"));

  make_flood();
  std::this_thread::sleep_for(std::chrono::milliseconds(1050));
  EXPECT_TRUE(is_turned_away("127.0.0.1"));  // longer than the first time
}

// Of a message that was cancelled nothing more comes, and gRPC has let go of what had come.
TEST(ConnectionsTest, MessagesThatWereCancelledAreNotHeldAgainstTheirCaller) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 4 << 20});
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));

  for (int i = 0; i < 10; ++i) {
    const double before = port.connections().OnJob(caller.peer());
    caller.Send(3 << 20);
    ASSERT_TRUE(
        TestService::Eventually([&] { return port.connections().pending_bytes() > 5 << 19; }));
    port.connections().OnJobDone(caller.peer(), before, /*all_came=*/false);
  }

  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  EXPECT_FALSE(caller.IsCut());
  EXPECT_TRUE(port.told().empty());
}

TEST(ConnectionsTest, TheEndOfOneJobForgivesOnlyItsShareOfWhatIsPending) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 16 << 20});
  const Caller caller(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));
  port.connections().OnJob(caller.peer());

  const double before = port.connections().OnJob(caller.peer());
  caller.Send(8 << 20);
  ASSERT_TRUE(
      TestService::Eventually([&] { return port.connections().pending_bytes() > 7 << 20; }));
  port.connections().OnJobDone(caller.peer(), before, /*all_came=*/false);

  EXPECT_NEAR(static_cast<double>(port.connections().pending_bytes()), 4 << 20, 1 << 20);
}

// Of two addresses the one with most loses a job, and not the one whose message is merely large.
TEST(ConnectionsTest, OneAddressDoesNotHoardUnfinishedMessages) {
  Port port({.stranger_bytes = 1 << 20, .job_bytes = 8 << 20, .all_bytes = 12 << 20});
  port.MayEndJobs();
  std::vector<std::unique_ptr<Caller>> hoarders;
  for (int i = 0; i < 3; ++i) {
    hoarders.push_back(std::make_unique<Caller>(port.connections().port(), "127.0.0.2"));
  }
  const Caller large(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 4; }));
  port.connections().OnJob(large.peer());
  for (const auto& each : hoarders) port.connections().OnJob(each->peer());

  large.Send(6 << 20);
  hoarders[0]->Send(5 << 20);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_TRUE(port.told().empty());
  hoarders[1]->Send(4 << 20);

  EXPECT_TRUE(TestService::Eventually([&] { return !port.told().empty(); }));
  EXPECT_EQ(port.told()[0], PeerKey(hoarders[0]->peer()));
  EXPECT_FALSE(large.IsCut());
}

TEST(ConnectionsTest, WhereMemoryIsShortTheLargestIsCut) {
  Port port({.stranger_bytes = 10 << 20});
  const Caller small(port.connections().port());
  const Caller large(port.connections().port());
  small.Send(100'000);
  large.Send(2 << 20);
  ASSERT_TRUE(
      TestService::Eventually([&] { return port.connections().pending_bytes() > 2 << 20; }));

  EXPECT_TRUE(port.connections().CutLargest());

  EXPECT_TRUE(TestService::Eventually([&] { return large.IsCut(); }));
  EXPECT_FALSE(small.IsCut());
}

TEST(ConnectionsTest, IdleOnesMakeRoomForNewOnes) {
  Port port({.max_connections = 3});
  const Caller working(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 1; }));
  port.connections().OnJob(working.peer());
  const Caller idle(port.connections().port());
  const Caller other(port.connections().port());
  ASSERT_TRUE(TestService::Eventually([&] { return port.connections().open() == 3; }));

  const Caller too_early(port.connections().port());
  EXPECT_TRUE(TestService::Eventually([&] { return too_early.IsCut(); }));
  std::this_thread::sleep_for(std::chrono::milliseconds(1100));
  other.Send(10);
  std::this_thread::sleep_for(std::chrono::milliseconds(250));
  const Caller next(port.connections().port());

  EXPECT_TRUE(TestService::Eventually([&] { return idle.IsCut(); }));
  EXPECT_FALSE(next.IsCut());
  EXPECT_FALSE(working.IsCut());
  EXPECT_FALSE(other.IsCut());
}

TEST(ConnectionsTest, AddressesAreToldAsGrpcWritesThem) {
  EXPECT_EQ(PeerKey("ipv4:10.0.0.7:41234"), "10.0.0.7:41234");
  EXPECT_EQ(PeerKey("ipv6:%5B::1%5D:41234"), "::1:41234");
  EXPECT_EQ(PeerKey("ipv6:[::1]:41234"), "::1:41234");
}

TEST(ConnectionsTest, TheBusiestAddressIsTurnedAwayWhereCallsWait) {
  Port port({});
  Connections& connections = port.connections();
  const Caller busy(connections.port());
  const Caller also_busy(connections.port());
  const Caller other(connections.port(), "127.0.0.2");
  ASSERT_TRUE(TestService::Eventually([&] { return connections.open() == 3; }));
  EXPECT_FALSE(connections.TurnAwayBusiest());
  for (int i = 0; i < 20'000; ++i) {  // with jobs
    connections.OnCall(other.peer());
    connections.OnJobDone(other.peer(), connections.OnJob(other.peer()), /*all_came=*/true);
    connections.OnCallDone(other.peer());
  }
  EXPECT_FALSE(connections.TurnAwayBusiest());
  for (int i = 0; i < 12'000; ++i) {
    const std::string& peer = (i % 10 == 0 ? other : i % 10 < 5 ? busy : also_busy).peer();
    connections.OnCall(peer);
    connections.OnCallDone(peer);
  }

  EXPECT_TRUE(connections.TurnAwayBusiest());

  EXPECT_TRUE(TestService::Eventually([&] { return busy.IsCut() && also_busy.IsCut(); }));
  EXPECT_FALSE(other.IsCut());
  const Caller again(connections.port());
  EXPECT_TRUE(TestService::Eventually([&] { return again.IsCut(); }));
  EXPECT_FALSE(connections.TurnAwayBusiest());
}

// Nor are calls jobs that are begun and bring nothing.
TEST(ConnectionsTest, JobsThatBringNothingAreWorkForNothing) {
  Port port({});
  Connections& connections = port.connections();
  const Caller caller(connections.port());
  ASSERT_TRUE(TestService::Eventually([&] { return connections.open() == 1; }));
  for (int i = 0; i < 12'000; ++i) {
    connections.OnCall(caller.peer());
    connections.OnJobDone(caller.peer(), connections.OnJob(caller.peer()), /*all_came=*/false);
    connections.OnCallDone(caller.peer());
  }

  EXPECT_TRUE(connections.TurnAwayBusiest());
}

}  // namespace
}  // namespace traverse

#include "server/jobs/fair_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace traverse {
namespace {

struct Named : FairOrder::Member {
  explicit Named(char name, double cost) : name(name), cost(cost) {}
  char name;
  double cost;  // seconds of one turn
};

// Serves `turns` turns, after each of which the member waits again. Returns the names in turn.
std::string Serve(FairOrder& order, int turns) {
  std::string names;
  for (int turn = 0; turn < turns; ++turn) {
    auto& next = static_cast<Named&>(order.TakeNext());
    names += next.name;
    order.Charge(next, next.cost);
    order.Wait(next);
  }
  return names;
}

void Come(FairOrder& order, Named& member) {
  order.Enter(member);
  order.Wait(member);
}

TEST(FairOrder, EqualsTakeTurns) {
  FairOrder order;
  Named a('a', 1), b('b', 1), c('c', 1);
  for (Named* member : {&a, &b, &c}) Come(order, *member);

  EXPECT_EQ(Serve(order, 6), "abcabc");
}

TEST(FairOrder, TimeIsSharedNotTurns) {
  FairOrder order;
  Named slow('s', 4), quick('q', 1);
  Come(order, slow);
  Come(order, quick);

  EXPECT_EQ(Serve(order, 10), "sqqqqsqqqq");
}

TEST(FairOrder, WhoIsTakenBeforeItsTurnMovesNobodysEntrance) {
  FairOrder order;
  Named ahead('a', 1), behind('b', 1);
  Come(order, ahead);
  Come(order, behind);
  order.Charge(ahead, 100);
  const auto is_ahead = [&](const FairOrder::Member& member) { return &member == &ahead; };
  order.Wait(*order.TakeFirst(is_ahead));
  Named fresh('f', FairOrder::kHeadStart / 4);
  Come(order, fresh);

  EXPECT_EQ(Serve(order, 3), "bff");
}

TEST(FairOrder, WhoComesNewIsServedFirstForItsHeadStart) {
  FairOrder order;
  Named a('a', FairOrder::kHeadStart / 10), b('b', FairOrder::kHeadStart / 10);
  Come(order, a);
  Come(order, b);
  Serve(order, 100);
  Named fresh('f', FairOrder::kHeadStart / 4);
  Come(order, fresh);

  EXPECT_EQ(Serve(order, 5).substr(0, 4), "ffff");
}

TEST(FairOrder, WhoWasAwayIsOwedNothing) {
  FairOrder order;
  Named a('a', 1), b('b', 1);
  Come(order, a);
  Come(order, b);
  Serve(order, 2);
  Named& away = static_cast<Named&>(order.TakeNext());
  order.Leave(away);
  Serve(order, 1000);
  Come(order, away);

  const std::string names = Serve(order, 20);
  EXPECT_LE(std::count(names.begin(), names.end(), away.name), 11) << names;
}

TEST(FairOrder, AnyNumberOfNewOnesHoldsNobodyUpForGood) {
  FairOrder order;
  Named old('o', 0.001);
  Come(order, old);
  Serve(order, 1000);
  int served_old = 0;
  for (int i = 0; i < 1000; ++i) {
    // There is always a new one that waits.
    Named fresh('f', 0.001);
    Come(order, fresh);
    for (bool done = false; !done;) {
      auto& next = static_cast<Named&>(order.TakeNext());
      order.Charge(next, next.cost);
      done = &next == &fresh;
      if (done) {
        order.Leave(next);
      } else {
        ++served_old;
        order.Wait(next);
      }
    }
  }

  EXPECT_GT(served_old, 300);
}

TEST(FairOrder, ChargingOneThatWaitsMovesIt) {
  FairOrder order;
  Named a('a', 1), b('b', 1);
  Come(order, a);
  Come(order, b);
  order.Charge(a, 5);

  EXPECT_EQ(Serve(order, 3), "bbb");
}

TEST(FairOrder, WhoWithdrawsHasNoTurn) {
  FairOrder order;
  Named a('a', 1), b('b', 1);
  Come(order, a);
  Come(order, b);

  order.Withdraw(a);

  EXPECT_EQ(Serve(order, 3), "bbb");
  order.Withdraw(b);
  EXPECT_TRUE(order.empty());
  order.Wait(a);
  EXPECT_EQ(Serve(order, 1), "a");
}

}  // namespace
}  // namespace traverse

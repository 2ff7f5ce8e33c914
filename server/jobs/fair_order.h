// Whose turn it is, by the time that each was served.
//
// Start-time fair queueing (Goyal, Vin, Cheng 1996): each member has a clock that runs while it is
// served, and the one whose clock is furthest behind is next; among equals, the one that waits
// longest. A member that comes, or comes back, begins a head start behind the others: what is
// quickly done is done before what goes on for long. To serve a member within its head start takes
// time from those that come later, its fair part of it: one after the other they cannot hold up for
// good those that were there.
//
//   FairOrder order;
//   FairOrder::Member a, b;
//   order.Enter(a); order.Wait(a);        // likewise b
//   FairOrder::Member& next = order.TakeNext();
//   ... serve it ...
//   order.Charge(next, seconds);
//   order.Leave(next);                    // or Wait again
//
// O(log n) a turn. Not thread-safe.

#ifndef TRAVERSE_SERVER_JOBS_FAIR_ORDER_H_
#define TRAVERSE_SERVER_JOBS_FAIR_ORDER_H_

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <limits>
#include <set>
#include <tuple>

namespace traverse {

class FairOrder {
 public:
  // What a member is served before those that were there, in seconds.
  static constexpr double kHeadStart = 0.01;

  // Derived from by what takes turns. Left alone by it.
  class Member {
   public:
    bool waits() const { return waits_; }

   private:
    friend class FairOrder;
    double clock_ = -std::numeric_limits<double>::infinity();
    double head_start_ = 0;  // what is left of it
    uint64_t turn_ = 0;
    bool waits_ = false;
  };

  // `member` has something to do, after it had nothing.
  void Enter(Member& member) {
    member.clock_ = std::max(member.clock_, now_ - kHeadStart);
    member.head_start_ = std::max(0.0, now_ - member.clock_);
    ++members_;
  }

  // `member` has nothing to do any more. REQUIRES: it does not wait.
  void Leave([[maybe_unused]] Member& member) {
    assert(!member.waits_ && members_ > 0);
    --members_;
  }

  // `member` waits for its turn. REQUIRES: it does not wait; Enter was called before.
  void Wait(Member& member) {
    assert(!member.waits_ && members_ > 0);
    member.turn_ = ++turns_;
    member.waits_ = true;
    waiting_.insert(KeyOf(member));
  }

  bool empty() const { return waiting_.empty(); }

  // Whose turn it is; it then waits no longer. REQUIRES: a member waits.
  Member& TakeNext() {
    assert(!empty());
    Member& next = *std::get<Member*>(*waiting_.begin());
    waiting_.erase(waiting_.begin());
    next.waits_ = false;
    now_ = std::max(now_, next.clock_);
    return next;
  }

  // `member` does not wait any more, without a turn. REQUIRES: it waits.
  void Withdraw(Member& member) {
    assert(member.waits_);
    waiting_.erase(KeyOf(member));
    member.waits_ = false;
  }

  // `member` was served for `seconds`. REQUIRES: it has not left.
  void Charge(Member& member, double seconds) {
    assert(members_ > 0);
    if (member.waits_) waiting_.erase(KeyOf(member));
    now_ += std::min(seconds, member.head_start_) / members_;
    member.head_start_ = std::max(0.0, member.head_start_ - seconds);
    member.clock_ += seconds;
    if (member.waits_) waiting_.insert(KeyOf(member));
  }

 private:
  using Key = std::tuple<double, uint64_t, Member*>;

  static Key KeyOf(Member& member) { return {member.clock_, member.turn_, &member}; }

  double now_ = 0;   // the clock of whoever was served last, but never back
  int members_ = 0;  // that have something to do
  uint64_t turns_ = 0;
  std::set<Key> waiting_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_FAIR_ORDER_H_

// Whose turn it is, by how long each member has been served.
//
// Start-time fair queueing (Goyal, Vin, Cheng 1996): each member has a clock that runs while it is
// served. The next is the one whose clock is furthest behind; among equals, the one that waits
// longest. A member that enters, or returns, begins a head start behind the others, so that quick
// work is done before long work. Serving a member within its head start takes time from those that
// come later, and only its fair share: one after the other, newcomers cannot hold up for good those
// that were there before.
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
  // How long a new member is served before those that were there, in seconds.
  static constexpr double kHeadStart = 0.01;

  // Base class of whatever takes turns, which must not touch its members.
  class Member {
   public:
    bool waits() const { return waits_; }

   private:
    friend class FairOrder;
    double clock_ = -std::numeric_limits<double>::infinity();
    double head_start_ = 0;  // the rest of it
    uint64_t turn_ = 0;
    bool waits_ = false;
  };

  // `member` has work again after it had none.
  void Enter(Member& member) {
    member.clock_ = std::max(member.clock_, now_ - kHeadStart);
    member.head_start_ = std::max(0.0, now_ - member.clock_);
    ++members_;
  }

  // `member` has no more work. REQUIRES: it does not wait.
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

  // Returns the member whose turn it is, which then no longer waits. REQUIRES: a member waits.
  Member& TakeNext() {
    assert(!empty());
    return *TakeFirst([](const Member&) { return true; });
  }

  // Takes the first member in their order for which may(member) is true; null if there is none.
  template <typename May>
  Member* TakeFirst(May may) {
    const auto first = std::find_if(waiting_.begin(), waiting_.end(),
                                    [&](const Key& key) { return may(*std::get<Member*>(key)); });
    if (first == waiting_.end()) return nullptr;
    // Of the member furthest behind: one that is taken before its turn moves nobody's entrance.
    now_ = std::max(now_, std::get<double>(*waiting_.begin()));
    Member& next = *std::get<Member*>(*first);
    waiting_.erase(first);
    next.waits_ = false;
    return &next;
  }

  // `member` stops waiting without having had a turn. REQUIRES: it waits.
  void Withdraw(Member& member) {
    assert(member.waits_);
    waiting_.erase(KeyOf(member));
    member.waits_ = false;
  }

  // Notes that `member` was served for `seconds`. REQUIRES: it has not left.
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

  double now_ = 0;   // the clock of who was furthest behind last; never runs back
  int members_ = 0;  // number of members with work
  uint64_t turns_ = 0;
  std::set<Key> waiting_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_JOBS_FAIR_ORDER_H_

// Remembers floods from addresses, and the work that addresses cause.

#ifndef TRAVERSE_SERVER_NET_OFFENDERS_H_
#define TRAVERSE_SERVER_NET_OFFENDERS_H_

#include <chrono>
#include <map>
#include <string>

namespace traverse {

// Not thread-safe.
class Offenders {
 public:
  using Clock = std::chrono::steady_clock;

  // Notes a flood from `address`. It is banned if `ban_at_once`, or if there was one before: for a
  // second, twice as long each other time, up to 32 s. After two minutes without one all is
  // forgotten.
  void NoteFlood(const std::string& address, bool ban_at_once, Clock::time_point now);
  bool IsBanned(const std::string& address, Clock::time_point now) const;

  // Notes work caused by `address`, counted in calls. Less than 0: takes back work noted before,
  // which led to a job after all. Halves every second.
  void NoteWork(const std::string& address, double calls, Clock::time_point now);

  // The address that made more than half of all recent work, if that was more than kMuchWork;
  // otherwise empty. Its work is then forgotten. A scheduler that sends half as much again as the
  // service can do stays below, even on a machine that is busy with other work.
  static constexpr double kMuchWork = 6000;
  std::string TakeBusiest(Clock::time_point now);

  // Frees records that no longer matter.
  void Tidy(Clock::time_point now);

 private:
  struct Address {
    double work = 0;
    Clock::time_point worked;
    bool noted = false;  // a flood
    int bans = 0;
    Clock::time_point last_flood;
    Clock::time_point banned_until;
  };

  Address& At(const std::string& address);
  static double WorkOf(const Address& address, Clock::time_point now);

  std::map<std::string, Address> addresses_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_OFFENDERS_H_

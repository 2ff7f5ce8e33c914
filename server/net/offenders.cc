#include "server/net/offenders.h"

#include <algorithm>
#include <cmath>

namespace traverse {
namespace {

constexpr auto kFirstBan = std::chrono::seconds(1);
constexpr int kMostDoublings = 5;
constexpr auto kForgotten = std::chrono::minutes(2);
constexpr size_t kMostAddresses = 10'000;

}  // namespace

Offenders::Address& Offenders::At(const std::string& address) {
  if (addresses_.size() >= kMostAddresses) addresses_.clear();
  return addresses_[address];
}

void Offenders::NoteFlood(const std::string& address, bool ban_at_once, Clock::time_point now) {
  Address& offender = At(address);
  offender.last_flood = now;
  if (ban_at_once || offender.noted) {
    offender.banned_until = now + kFirstBan * (1 << std::min(offender.bans++, kMostDoublings));
  }
  offender.noted = true;
}

bool Offenders::IsBanned(const std::string& address, Clock::time_point now) const {
  const auto found = addresses_.find(address);
  return found != addresses_.end() && now < found->second.banned_until;
}

double Offenders::WorkOf(const Address& address, Clock::time_point now) {
  if (address.work == 0) return 0;
  return address.work * std::exp2(-std::chrono::duration<double>(now - address.worked).count());
}

void Offenders::NoteWork(const std::string& address, double calls, Clock::time_point now) {
  Address& worker = At(address);
  worker.work = std::max(0.0, WorkOf(worker, now) + calls);
  worker.worked = now;
}

std::string Offenders::TakeBusiest(Clock::time_point now) {
  double sum = 0;
  double most = 0;
  auto busiest = addresses_.end();
  for (auto it = addresses_.begin(); it != addresses_.end(); ++it) {
    const double work = WorkOf(it->second, now);
    sum += work;
    if (work <= most) continue;
    most = work;
    busiest = it;
  }
  if (most <= kMuchWork || 2 * most <= sum) return "";
  busiest->second.work = 0;
  return busiest->first;
}

void Offenders::Tidy(Clock::time_point now) {
  for (auto it = addresses_.begin(); it != addresses_.end();) {
    Address& address = it->second;
    const bool is_idle = WorkOf(address, now) < 1;
    const bool is_good = !address.noted || now - address.last_flood > kForgotten;
    it = is_idle && is_good ? addresses_.erase(it) : std::next(it);
  }
}

}  // namespace traverse

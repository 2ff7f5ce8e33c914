// Which connection gives way to a new one when there are as many as there may be.

#ifndef TRAVERSE_SERVER_NET_GIVE_WAY_H_
#define TRAVERSE_SERVER_NET_GIVE_WAY_H_

#include <chrono>
#include <map>
#include <string>

namespace traverse {

// Takes all open connections, one after the other, and chooses the one that has been idle for
// longest; if none has been so for a second, then of the address that has most of them, if that has
// more than the address for which room is made. Not thread-safe.
template <typename Id>
class GiveWay {
 public:
  using Clock = std::chrono::steady_clock;

  // `since`: when it last said something. One that is busy gives way to nobody.
  void Offer(Id id, const std::string& address, Clock::time_point since, bool busy) {
    Address& own = addresses_[address];
    ++own.connections;
    if (!busy && (!own.oldest || since < own.since)) own = {own.connections, true, id, since};
  }

  // Sets `id`. Returns false if none gives way to one of `address`.
  bool Choose(const std::string& address, Clock::time_point now, Id& id) const {
    const Address* oldest = nullptr;
    const Address* most = nullptr;
    for (const auto& [name, other] : addresses_) {
      if (most == nullptr || other.connections > most->connections) most = &other;
      if (other.oldest && (oldest == nullptr || other.since < oldest->since)) oldest = &other;
    }
    if (oldest == nullptr) return false;
    const auto own = addresses_.find(address);
    const int own_connections = own == addresses_.end() ? 0 : own->second.connections;
    const bool idle = now - oldest->since >= std::chrono::seconds(1);
    if (!idle && (!most->oldest || most->connections <= own_connections + 1)) return false;
    id = idle ? oldest->id : most->id;
    return true;
  }

 private:
  struct Address {
    int connections = 0;
    bool oldest = false;  // of those that are not busy; there is one
    Id id{};
    Clock::time_point since;
  };

  std::map<std::string, Address> addresses_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_GIVE_WAY_H_

// Hands new connections to gRPC, in threads of its own.
//
// gRPC makes the thread that hands it a connection work for it: if bytes have arrived already, the
// thread reads and parses them, and continues while more arrive. So a caller who never stops
// sending holds the thread. Therefore neither the accepting nor the watching thread hands over any,
// and several threads do. Addresses take turns: one that opens thousands of connections only delays
// itself.

#ifndef TRAVERSE_SERVER_NET_HAND_OVER_H_
#define TRAVERSE_SERVER_NET_HAND_OVER_H_

#include <functional>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/mutex.h"
#include "server/net/turns.h"

namespace traverse {

// Thread-safe.
class HandOver {
 public:
  // Takes over a socket. Each of the threads ("hands") calls it with its number, from
  // 0.
  using Take = std::function<void(int socket, int hand)>;

  HandOver(int hands, Take take);

  // REQUIRES: Stop was called.
  ~HandOver();

  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;

  // Returns at once. `peer` is ADDRESS:PORT, its name for others. If more than kMostWaiting then
  // wait, and more than kMostOfAddress of one address, turns away the last of these: closes it and
  // returns it, so that the caller can forget it. Otherwise returns nothing.
  static constexpr size_t kMostWaiting = 512;
  static constexpr size_t kMostOfAddress = 64;
  std::string Add(int socket, const std::string& peer);

  // Turns away the last one of the address with most waiting ones, as Add does.
  std::string TurnAway();

  // Whether so many of many addresses wait that new ones are better left in the kernel's
  // queue.
  bool IsFull() const;

  // Closes the waiting sockets, calls `cut` for each peer whose socket is being handed over, and
  // waits until that is done. REQUIRES: Add is not called any more.
  void Stop(const std::function<void(const std::string& peer)>& cut);

 private:
  struct NewConnection {
    int socket = -1;
    std::string peer;
  };

  void Run(int hand);
  std::string TurnAwayLast() TRAVERSE_REQUIRES(mutex_);

  const Take take_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  Turns<NewConnection> waiting_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<std::string> in_hand_ TRAVERSE_GUARDED_BY(mutex_);  // [hand] a peer, or empty
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_HAND_OVER_H_

// Hands new connections to gRPC, in threads of its own.
//
// gRPC lets whoever gives it a connection do work for it: where bytes have come already, the thread
// reads and parses them, and goes on as long as more come. A caller who never stops sending keeps
// it. So neither the thread that accepts connections nor the one that watches them gives any away,
// and there are several that do. Addresses take turns: whoever opens connections by the thousand
// waits for himself.

#ifndef TRAVERSE_SERVER_NET_HAND_OVER_H_
#define TRAVERSE_SERVER_NET_HAND_OVER_H_

#include <deque>
#include <functional>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/mutex.h"

namespace traverse {

// Thread-safe.
class HandOver {
 public:
  // Takes a socket, which is given away. Each of the threads, or hands, calls it with its number,
  // from 0.
  using Take = std::function<void(int socket, int hand)>;

  HandOver(int hands, Take take);

  // REQUIRES: Stop was called.
  ~HandOver();

  HandOver(const HandOver&) = delete;
  HandOver& operator=(const HandOver&) = delete;

  // Returns at once. `peer` is ADDRESS:PORT, by which others call it. If more than kMostWaiting
  // wait then, and more than kMostOfAddress of one address, the last of these is turned away: it is
  // closed, and returned for the caller to forget it. Else returns nothing.
  static constexpr size_t kMostWaiting = 512;
  static constexpr size_t kMostOfAddress = 64;
  std::string Add(int socket, const std::string& peer);

  // Turns the last one away of the address of which most wait, as Add does.
  std::string TurnAway();

  // Whether so many wait, of many addresses, that new ones are better left where the kernel keeps
  // them.
  bool IsFull() const;

  // Closes the sockets that wait, calls `cut` for each peer whose socket is being taken, and waits
  // until that is done. REQUIRES: Add is not called any more.
  void Stop(const std::function<void(const std::string& peer)>& cut);

 private:
  struct NewConnection {
    int socket = -1;
    std::string peer;
  };

  using Waiting = std::map<std::string, std::deque<NewConnection>>;

  void Run(int hand);
  NewConnection TakeNext() TRAVERSE_REQUIRES(mutex_);
  Waiting::iterator Longest() TRAVERSE_REQUIRES(mutex_);
  std::string TurnAwayOf(Waiting::iterator address) TRAVERSE_REQUIRES(mutex_);

  const Take take_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  Waiting waiting_ TRAVERSE_GUARDED_BY(mutex_);  // by address; none is empty
  std::deque<std::string> turns_
      TRAVERSE_GUARDED_BY(mutex_);                // its addresses, whose turn it is first
  size_t count_ TRAVERSE_GUARDED_BY(mutex_) = 0;  // of those that wait
  std::vector<std::string> in_hand_ TRAVERSE_GUARDED_BY(mutex_);  // [hand] a peer, or empty
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_HAND_OVER_H_

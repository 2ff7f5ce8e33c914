// Hands new connections to gRPC, in threads of its own.
//
// gRPC lets whoever gives it a connection do work for it: where bytes have come already, the thread
// reads and parses them, and goes on as long as more come. A caller who never stops sending keeps
// it. So neither the thread that accepts connections nor the one that watches them gives any away,
// and there are several that do.

#ifndef TRAVERSE_SERVER_NET_HAND_OVER_H_
#define TRAVERSE_SERVER_NET_HAND_OVER_H_

#include <deque>
#include <functional>
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

  // Returns at once. `peer` is what Stop calls it.
  void Add(int socket, const std::string& peer);

  // Whether so many wait that new ones are better left where the kernel keeps them.
  static constexpr size_t kMostWaiting = 64;
  bool IsFull() const;

  // Closes the sockets that wait, calls `cut` for each peer whose socket is being taken, and waits
  // until that is done. REQUIRES: Add is not called any more.
  void Stop(const std::function<void(const std::string& peer)>& cut);

 private:
  struct NewConnection {
    int socket = -1;
    std::string peer;
  };

  void Run(int hand);

  const Take take_;
  mutable Mutex mutex_;
  ConditionVariable changed_;
  std::deque<NewConnection> waiting_ TRAVERSE_GUARDED_BY(mutex_);
  std::vector<std::string> in_hand_ TRAVERSE_GUARDED_BY(mutex_);  // [hand] a peer, or empty
  bool stopping_ TRAVERSE_GUARDED_BY(mutex_) = false;
  std::vector<std::thread> threads_;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_HAND_OVER_H_

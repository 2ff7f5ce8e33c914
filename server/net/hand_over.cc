#include "server/net/hand_over.h"

#include <unistd.h>

#include <cassert>
#include <utility>

namespace traverse {

HandOver::HandOver(int hands, Take take)
    : take_(std::move(take)), in_hand_(static_cast<size_t>(hands)) {
  for (int hand = 0; hand < hands; ++hand) threads_.emplace_back([this, hand] { Run(hand); });
}

HandOver::~HandOver() { assert(threads_.empty()); }

void HandOver::Add(int socket, const std::string& peer) {
  {
    MutexLock lock(mutex_);
    assert(!stopping_);
    waiting_.push_back({socket, peer});
  }
  changed_.NotifyOne();
}

bool HandOver::IsFull() const {
  MutexLock lock(mutex_);
  return waiting_.size() >= kMostWaiting;
}

void HandOver::Run(int hand) {
  MutexLock lock(mutex_);
  std::string& peer = in_hand_[static_cast<size_t>(hand)];
  while (true) {
    while (waiting_.empty() && !stopping_) changed_.Wait(mutex_);
    if (stopping_) return;
    const int socket = waiting_.front().socket;
    peer = std::move(waiting_.front().peer);
    waiting_.pop_front();
    lock.Unlock();
    take_(socket, hand);
    lock.Lock();
    peer.clear();
  }
}

void HandOver::Stop(const std::function<void(const std::string& peer)>& cut) {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    for (const NewConnection& it : waiting_) close(it.socket);
    waiting_.clear();
    for (const std::string& peer : in_hand_) {
      if (!peer.empty()) cut(peer);
    }
  }
  changed_.NotifyAll();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace traverse

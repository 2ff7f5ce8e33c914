#include "server/net/hand_over.h"

#include <unistd.h>

#include <cassert>
#include <utility>

#include "server/net/socket_info.h"

namespace traverse {

HandOver::HandOver(int hands, Take take)
    : take_(std::move(take)), in_hand_(static_cast<size_t>(hands)) {
  for (int hand = 0; hand < hands; ++hand) threads_.emplace_back([this, hand] { Run(hand); });
}

HandOver::~HandOver() { assert(threads_.empty()); }

std::string HandOver::Add(int socket, const std::string& peer) {
  std::string away;
  {
    MutexLock lock(mutex_);
    assert(!stopping_);
    waiting_.Add(AddressOf(peer), {socket, peer});
    if (waiting_.size() > kMostWaiting && waiting_.most() > kMostOfAddress) away = TurnAwayLast();
  }
  changed_.NotifyOne();
  return away;
}

std::string HandOver::TurnAway() {
  MutexLock lock(mutex_);
  return waiting_.empty() ? "" : TurnAwayLast();
}

bool HandOver::IsFull() const {
  MutexLock lock(mutex_);
  return waiting_.size() > kMostWaiting;
}

std::string HandOver::TurnAwayLast() {
  const NewConnection last = waiting_.TakeLastOfMost();
  close(last.socket);
  return last.peer;
}

void HandOver::Run(int hand) {
  MutexLock lock(mutex_);
  std::string& peer = in_hand_[static_cast<size_t>(hand)];
  while (true) {
    while (waiting_.empty() && !stopping_) changed_.Wait(mutex_);
    if (stopping_) return;
    NewConnection next = waiting_.TakeNext();
    peer = std::move(next.peer);
    lock.Unlock();
    take_(next.socket, hand);
    lock.Lock();
    peer.clear();
  }
}

void HandOver::Stop(const std::function<void(const std::string& peer)>& cut) {
  {
    MutexLock lock(mutex_);
    stopping_ = true;
    while (!waiting_.empty()) close(waiting_.TakeNext().socket);
    for (const std::string& peer : in_hand_) {
      if (!peer.empty()) cut(peer);
    }
  }
  changed_.NotifyAll();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace traverse

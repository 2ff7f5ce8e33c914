#include "server/net/hand_over.h"

#include <unistd.h>

#include <algorithm>
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
    const auto [address, is_new] = waiting_.try_emplace(AddressOf(peer));
    if (is_new) turns_.push_back(address->first);
    address->second.push_back({socket, peer});
    ++count_;
    if (count_ > kMostWaiting) {
      const auto longest = Longest();
      if (longest->second.size() > kMostOfAddress) away = TurnAwayOf(longest);
    }
  }
  changed_.NotifyOne();
  return away;
}

std::string HandOver::TurnAway() {
  MutexLock lock(mutex_);
  return waiting_.empty() ? "" : TurnAwayOf(Longest());
}

bool HandOver::IsFull() const {
  MutexLock lock(mutex_);
  return count_ > kMostWaiting;
}

HandOver::Waiting::iterator HandOver::Longest() {
  return std::max_element(waiting_.begin(), waiting_.end(), [](const auto& a, const auto& b) {
    return a.second.size() < b.second.size();
  });
}

std::string HandOver::TurnAwayOf(Waiting::iterator address) {
  const NewConnection last = std::move(address->second.back());
  address->second.pop_back();
  --count_;
  if (address->second.empty()) {
    turns_.erase(std::find(turns_.begin(), turns_.end(), address->first));
    waiting_.erase(address);
  }
  close(last.socket);
  return last.peer;
}

// The address goes to the end of the turns, if more of it wait.
HandOver::NewConnection HandOver::TakeNext() {
  const auto address = waiting_.find(turns_.front());
  turns_.pop_front();
  NewConnection next = std::move(address->second.front());
  address->second.pop_front();
  --count_;
  if (address->second.empty()) {
    waiting_.erase(address);
  } else {
    turns_.push_back(address->first);
  }
  return next;
}

void HandOver::Run(int hand) {
  MutexLock lock(mutex_);
  std::string& peer = in_hand_[static_cast<size_t>(hand)];
  while (true) {
    while (waiting_.empty() && !stopping_) changed_.Wait(mutex_);
    if (stopping_) return;
    NewConnection next = TakeNext();
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
    for (const auto& [address, connections] : waiting_) {
      for (const NewConnection& it : connections) close(it.socket);
    }
    waiting_.clear();
    turns_.clear();
    count_ = 0;
    for (const std::string& peer : in_hand_) {
      if (!peer.empty()) cut(peer);
    }
  }
  changed_.NotifyAll();
  for (std::thread& thread : threads_) thread.join();
  threads_.clear();
}

}  // namespace traverse

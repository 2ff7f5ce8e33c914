// What waits, in turns by the address it comes from: one that brings thousands of things only
// delays itself.

#ifndef TRAVERSE_SERVER_NET_TURNS_H_
#define TRAVERSE_SERVER_NET_TURNS_H_

#include <algorithm>
#include <cassert>
#include <cstddef>
#include <deque>
#include <map>
#include <string>
#include <utility>

namespace traverse {

// Not thread-safe.
template <typename T>
class Turns {
 public:
  // `thing` of `address` waits.
  void Add(const std::string& address, T thing) {
    const auto [of_address, is_new] = waiting_.try_emplace(address);
    if (is_new) turns_.push_back(address);
    of_address->second.push_back(std::move(thing));
    ++size_;
  }

  bool empty() const { return size_ == 0; }
  size_t size() const { return size_; }

  size_t of(const std::string& address) const {
    const auto found = waiting_.find(address);
    return found == waiting_.end() ? 0 : found->second.size();
  }

  // Of the address that has most.
  size_t most() const { return empty() ? 0 : Longest(waiting_)->second.size(); }

  // Takes the first one of the address whose turn it is, which goes to the end of the turns if more
  // of it wait. REQUIRES: one waits.
  T TakeNext() {
    assert(!empty());
    const auto address = waiting_.find(turns_.front());
    turns_.pop_front();
    T next = std::move(address->second.front());
    address->second.pop_front();
    --size_;
    if (address->second.empty()) {
      waiting_.erase(address);
    } else {
      turns_.push_back(address->first);
    }
    return next;
  }

  // Takes the last one of the address that has most. REQUIRES: one waits.
  T TakeLastOfMost() {
    assert(!empty());
    const auto address = Longest(waiting_);
    T last = std::move(address->second.back());
    address->second.pop_back();
    --size_;
    if (address->second.empty()) {
      turns_.erase(std::find(turns_.begin(), turns_.end(), address->first));
      waiting_.erase(address);
    }
    return last;
  }

 private:
  template <typename Waiting>
  static auto Longest(Waiting& waiting) {
    return std::max_element(waiting.begin(), waiting.end(), [](const auto& a, const auto& b) {
      return a.second.size() < b.second.size();
    });
  }

  std::map<std::string, std::deque<T>> waiting_;  // by address; none is empty
  std::deque<std::string> turns_;                 // its addresses, in the order of their turns
  size_t size_ = 0;
};

}  // namespace traverse

#endif  // TRAVERSE_SERVER_NET_TURNS_H_

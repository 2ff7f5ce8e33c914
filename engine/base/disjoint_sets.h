// Sets of numbers that grow together (union-find).

#ifndef TRAVERSE_ENGINE_BASE_DISJOINT_SETS_H_
#define TRAVERSE_ENGINE_BASE_DISJOINT_SETS_H_

#include <cassert>
#include <cstddef>
#include <numeric>
#include <vector>

namespace traverse {

class DisjointSets {
 public:
  // Creates the sets {0}, {1}, ... {count - 1}.
  explicit DisjointSets(int count = 0) { Reset(count); }
  void Reset(int count) {
    parent_.resize(static_cast<size_t>(count));
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  // Joins the sets of two members. Returns whether they were separate. REQUIRES: both are members.
  bool Join(int a, int b) {
    a = Find(a);
    b = Find(b);
    Parent(a) = b;
    return a != b;
  }

  // REQUIRES: both are members.
  bool AreJoined(int a, int b) { return Find(a) == Find(b); }

  // [member] the number of its set; sets are numbered from 0, in order of their first members.
  std::vector<int> Numbered() {
    std::vector<int> number(parent_.size(), -1);  // [root]
    std::vector<int> set_of(parent_.size());
    int next = 0;
    for (size_t member = 0; member < parent_.size(); ++member) {
      int& of_root = number[static_cast<size_t>(Find(static_cast<int>(member)))];
      if (of_root < 0) of_root = next++;
      set_of[member] = of_root;
    }
    return set_of;
  }

 private:
  int& Parent(int member) {
    assert(member >= 0 && static_cast<size_t>(member) < parent_.size());
    return parent_[static_cast<size_t>(member)];
  }

  int Find(int member) {
    while (Parent(member) != member) member = Parent(member) = Parent(Parent(member));
    return member;
  }

  std::vector<int> parent_;
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_BASE_DISJOINT_SETS_H_

// One cell of a dynamic programme over walks: costs by a walk's memory and state.

#ifndef TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_ROWS_H_
#define TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_ROWS_H_

#include <algorithm>
#include <cstddef>
#include <vector>

#include "absl/container/flat_hash_map.h"
#include "engine/proof/min_plus.h"
#include "engine/proof/walks/memory_set.h"

namespace traverse {

// Rows for different memories, each with one cost per state.
template <int kWords>
class MemoryRows {
 public:
  using Memory = MemorySet<kWords>;

  int size() const { return static_cast<int>(memories_.size()); }
  bool empty() const { return memories_.empty(); }
  int states() const { return states_; }
  const Memory& memory(int row) const { return memories_[static_cast<size_t>(row)]; }
  double* costs(int row) { return costs_.data() + Offset(row); }
  const double* costs(int row) const { return costs_.data() + Offset(row); }

  void Clear(int states) {
    states_ = states;
    memories_.clear();
    costs_.clear();
  }

  // Adds a row of unreached costs.
  void Add(const Memory& memory) {
    memories_.push_back(memory);
    costs_.resize(Offset(size()), kUnreached);
  }

  // Keeps only the rows with a cost that is reached.
  void DropUnreached() {
    int kept = 0;
    for (int row = 0; row < size(); ++row) {
      const double* begin = costs(row);
      if (std::all_of(begin, begin + states_, [](double cost) { return cost == kUnreached; })) {
        continue;
      }
      if (kept != row) {
        memories_[static_cast<size_t>(kept)] = memory(row);
        std::copy(begin, begin + states_, costs(kept));
      }
      ++kept;
    }
    memories_.resize(static_cast<size_t>(kept));
    costs_.resize(Offset(kept));
  }

 private:
  size_t Offset(int row) const { return static_cast<size_t>(row) * static_cast<size_t>(states_); }

  int states_ = 0;
  std::vector<Memory> memories_;
  std::vector<double> costs_;  // [row * states_ + state]
};

// Makes rows, or finds them if they exist. Keeps its memory from one cell to the next.
template <int kWords>
class MemoryRowsBuilder {
 public:
  using Memory = MemorySet<kWords>;

  void Clear(int states) {
    rows_.Clear(states);
    index_.clear();
  }

  // The costs of `memory`, unreached if it is new. The pointer is valid until the next call.
  double* CostsOf(const Memory& memory) {
    if (rows_.size() < kScanned) {
      for (int row = 0; row < rows_.size(); ++row) {
        if (rows_.memory(row) == memory) return rows_.costs(row);
      }
    } else {
      if (index_.empty()) {
        for (int row = 0; row < rows_.size(); ++row) index_.emplace(rows_.memory(row), row);
      }
      const auto [entry, added] = index_.try_emplace(memory, rows_.size());
      if (!added) return rows_.costs(entry->second);
    }
    rows_.Add(memory);
    return rows_.costs(rows_.size() - 1);
  }

  MemoryRows<kWords>& rows() { return rows_; }

 private:
  static constexpr int kScanned = 16;  // hashing pays off above this

  MemoryRows<kWords> rows_;
  absl::flat_hash_map<Memory, int> index_;  // of all rows, once there are kScanned
};

}  // namespace traverse

#endif  // TRAVERSE_ENGINE_PROOF_WALKS_MEMORY_ROWS_H_

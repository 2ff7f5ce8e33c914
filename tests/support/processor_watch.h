// How long something takes, told by processor time: a busy machine makes no test fail.

#ifndef TRAVERSE_TESTS_SUPPORT_PROCESSOR_WATCH_H_
#define TRAVERSE_TESTS_SUPPORT_PROCESSOR_WATCH_H_

#include <ctime>

namespace traverse::testing {

// Counts what all threads of the process use from its construction on.
class ProcessorWatch {
 public:
  double Seconds() const {
    return static_cast<double>(std::clock() - begin_) / static_cast<double>(CLOCKS_PER_SEC);
  }

 private:
  const std::clock_t begin_ = std::clock();
};

}  // namespace traverse::testing

#endif  // TRAVERSE_TESTS_SUPPORT_PROCESSOR_WATCH_H_

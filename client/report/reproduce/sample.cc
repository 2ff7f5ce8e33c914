#include "client/report/reproduce/sample.h"

#include <cassert>
#include <cmath>
#include <iterator>

namespace traverse::report {
namespace {

// Student's t for 95 % by degrees of freedom, from 1 on.
constexpr double kStudent[] = {12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306,
                               2.262,  2.228, 2.201, 2.179, 2.160, 2.145, 2.131, 2.120,
                               2.110,  2.101, 2.093, 2.086, 2.080, 2.074, 2.069, 2.064,
                               2.060,  2.056, 2.052, 2.048, 2.045, 2.042};
constexpr double kTolerance = 0.10;

}  // namespace

Sample SampleOf(const std::vector<double>& values) {
  Sample sample;
  sample.size = static_cast<int>(values.size());
  if (values.empty()) return sample;
  for (const double value : values) sample.mean += value / static_cast<double>(values.size());
  double squares = 0;
  for (const double value : values) squares += (value - sample.mean) * (value - sample.mean);
  if (values.size() > 1) sample.deviation = std::sqrt(squares / (sample.size - 1));
  return sample;
}

double StudentT(int freedom) {
  assert(freedom >= 1);
  const auto index = static_cast<size_t>(freedom - 1);
  return index < std::size(kStudent) ? kStudent[index] : 1.96;
}

double SamplesNeeded(const Sample& sample) {
  if (sample.size < 2 || sample.mean == 0) return 0;
  const double root = 2 * StudentT(sample.size - 1) * sample.deviation / (kTolerance * sample.mean);
  return root * root;
}

}  // namespace traverse::report

// Statistics of samples of runs: mean, spread, and the number of runs needed.

#ifndef TRAVERSE_CLIENT_REPORT_REPRODUCE_SAMPLE_H_
#define TRAVERSE_CLIENT_REPORT_REPRODUCE_SAMPLE_H_

#include <vector>

namespace traverse::report {

// Mean and standard deviation of the sample.
struct Sample {
  int size = 0;
  double mean = 0;
  double deviation = 0;
};
Sample SampleOf(const std::vector<double>& values);

// Student's t for 95 %, two-sided; that of the normal distribution beyond 30 degrees of freedom.
// REQUIRES: freedom >= 1.
double StudentT(int freedom);

// Equation 3.2: the samples needed for a tolerance of k = 10 % at 95 %, (2 t S / (k mean))^2, with
// Student's t for the sample's size less one. 0 for fewer than two values.
double SamplesNeeded(const Sample& sample);

}  // namespace traverse::report

#endif  // TRAVERSE_CLIENT_REPORT_REPRODUCE_SAMPLE_H_

// Shows a job's progress on standard error: a bar on a terminal, otherwise occasional lines.

#ifndef TRAVERSE_CLIENT_CLI_PROGRESS_H_
#define TRAVERSE_CLIENT_CLI_PROGRESS_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/time/time.h"
#include "client/optimize_file/optimize_file.h"
#include "traverse/v1/route_optimizer_service.pb.h"

namespace traverse::cli {

class Progress {
 public:
  enum class Style { kNone, kBar, kLines };

  // The style that suits standard error.
  static Style StyleFor(bool quiet);

  // Starts showing the search of a job; `label` stands before the progress.
  Progress(Style style, std::string label, SearchWork work);

  // Removes the bar.
  ~Progress();

  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  // Counts one more layer, done now or after `elapsed`. Shows it at most ten times a second, as
  // lines every few seconds.
  void Take(const v1::LayerResult& layer);
  void Take(const v1::LayerResult& layer, absl::Duration elapsed);

  // The text to show after `elapsed`: `ni2opt  [####----] 50/100 layers, travel 31.2 % shorter, 5 s
  // left`. The bar appears only with kBar, and fits into `width` columns.
  std::string Text(absl::Duration elapsed, int width) const;

 private:
  std::optional<double> SecondsLeft(double elapsed_seconds) const;

  const Style style_;
  const std::string label_;
  const SearchWork work_;
  const absl::Time began_;
  absl::Duration shown_;  // after what time, last
  uint64_t done_ = 0;
  double done_work_ = 0;
  double first_seconds_ = 0;  // until the first layer was done
  double first_work_ = 0;
  double given_mm_ = 0;
  double travel_mm_ = 0;
  bool bar_drawn_ = false;
};

}  // namespace traverse::cli

#endif  // TRAVERSE_CLIENT_CLI_PROGRESS_H_

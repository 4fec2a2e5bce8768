#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace pcl_fft_ground::cli {

/// Tells on a terminal which stage of the work is under way, and takes the time of each. Silent in a pipe.
class Progress {
 public:
  /// \param quiet whether to stay silent on a terminal, too
  explicit Progress(bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Ends the stage before and begins one.
  /// \param name short name, as in the report
  /// \param text what is being done, for the terminal
  void begin(const std::string& name, const std::string& text);

  /// Tells how far the stage is, and about how long it will take. \param share that is done, 0 to 1
  void advance(double share);

  /// Ends the last stage and wipes the line.
  void end();

  /// Seconds of each stage, in order.
  const std::vector<std::pair<std::string, double>>& seconds() const { return seconds_; }

 private:
  using Clock = std::chrono::steady_clock;
  bool visible_;
  std::string stage_, text_;
  Clock::time_point begun_, shown_;
  std::vector<std::pair<std::string, double>> seconds_;
};

}  // namespace pcl_fft_ground::cli

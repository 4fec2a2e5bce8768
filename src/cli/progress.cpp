#include "progress.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <iostream>

#include "printable.h"

namespace pcl_fft_ground::cli {

Progress::Progress(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  end();
}

void Progress::begin(const std::string& name, const std::string& text) {
  end();
  stage_ = name;
  text_ = printable(text);
  begun_ = shown_ = Clock::now();
  if (visible_) std::cerr << "\r\033[K" << text_ << " ..." << std::flush;
}

void Progress::advance(double share) {
  constexpr double SHOW_EVERY = 0.5;  // [s]
  const Clock::time_point now = Clock::now();
  if (!visible_ || std::chrono::duration<double>(now - shown_).count() < SHOW_EVERY) return;
  shown_ = now;
  const double left =
      std::chrono::duration<double>(now - begun_).count() * (1 - share) / std::max(share, 1e-9);
  std::cerr << "\r\033[K" << text_ << " ... " << std::lround(100 * share) << " %";
  if (share > 0.02 && left < 100 * 3600)
    std::cerr << ", " << (left < 100 ? std::lround(left) : std::lround(left / 60))
              << (left < 100 ? " s" : " min") << " left";
  std::cerr << std::flush;
}

void Progress::end() {
  if (stage_.empty()) return;
  seconds_.emplace_back(stage_, std::chrono::duration<double>(Clock::now() - begun_).count());
  stage_.clear();
  if (visible_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace pcl_fft_ground::cli

#include "progress.h"

#include <unistd.h>

#include <iostream>

namespace pcl_fft_ground::cli {

Progress::Progress(bool quiet) : visible_(!quiet && isatty(STDERR_FILENO) != 0) {}

Progress::~Progress() {
  end();
}

void Progress::begin(const std::string& name, const std::string& text) {
  end();
  stage_ = name;
  begun_ = Clock::now();
  if (visible_) std::cerr << "\r\033[K" << text << " ..." << std::flush;
}

void Progress::end() {
  if (stage_.empty()) return;
  seconds_.emplace_back(stage_, std::chrono::duration<double>(Clock::now() - begun_).count());
  stage_.clear();
  if (visible_) std::cerr << "\r\033[K" << std::flush;
}

}  // namespace pcl_fft_ground::cli

#pragma once

#include <string>

#include "command_fixture.h"
#include "commands/commands.h"

namespace pcl_fft_ground::cli {

/// Settings that suit the scans of the tests.
inline const Words SETTINGS{"--cell-size", "0.04", "--max-object-size", "0.6", "--max-iterations", "50"};

/// Labelled scans, and the command run on them.
class EvaluateFixture : public CommandFixture {
 protected:
  /// `evaluate` with settings that suit the scans.
  static Printed evaluate(Words words, const Words& more = {}) {
    words.insert(words.end(), SETTINGS.begin(), SETTINGS.end());
    words.insert(words.end(), more.begin(), more.end());
    return run(runEvaluate, words);
  }

  std::string makeLabelledScan() const { return makeCloud("box.pcd", boxScan()); }

  /// A scan of pipes, some of its points not to be scored.
  std::string simulatePipes(const Words& more = {}) const {
    Words words{"pipes", "-o", pathOf("pipes.pcd"), "--points", "5000"};
    words.insert(words.end(), more.begin(), more.end());
    run(runSimulate, words);
    return pathOf("pipes.pcd");
  }
};

}  // namespace pcl_fft_ground::cli

#pragma once

#include <fstream>
#include <string>

#include "survey_trials.h"

/// A table of trials, a line for each.
class TrialFile {
 public:
  /// \param path of the CSV file to write; none if empty
  /// \throws std::runtime_error naming the file, where it cannot be written
  explicit TrialFile(const std::string& path);

  /// \param row name of the row of the benchmark that the trial belongs to
  void add(const std::string& row, const Trial& trial, const TrialOutcome& outcome);

 private:
  std::ofstream file_;
};

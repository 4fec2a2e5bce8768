#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "commands/survey/survey_alignment.h"

namespace pcl_fft_ground::cli {

/** \brief pairs.csv in the folder of the results: what has been done of a survey, so that it can be gone on
 * with.
 *
 * Beside it stands parameters.json. Where that is equal to the parameters of the new run, sub-maps included,
 * the results of the earlier one count; otherwise both start anew.
 */
class SurveyRecord {
 public:
  /// Reads what an earlier run with the same parameters has left.
  /// \throws WorkError naming the file that cannot be read or written
  SurveyRecord(const std::string& directory, const nlohmann::ordered_json& parameters,
               const std::vector<std::string>& names);

  /// The result of a task, if there is one.
  const PairResult* find(const PairTask& task) const;

  /// Adds a result and writes the table. \throws WorkError naming the file
  void add(const PairResult& result);

  const std::vector<PairResult>& results() const { return results_; }

 private:
  std::string path_;
  std::vector<std::string> names_;
  std::vector<PairResult> results_;
};

}  // namespace pcl_fft_ground::cli

#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/survey/survey.h"

namespace pcl_fft_ground::cli {

/// The content of pairs.csv: a line per result, sub-maps by their names.
std::string asCsv(const std::vector<core::PairResult>& results, const std::vector<std::string>& names);

/** Reads what asCsv() wrote; an empty file holds no results.
 *
 * \throws WorkError naming the file, if it cannot be read or is no such table
 */
std::vector<core::PairResult> readPairs(const std::string& path, const std::vector<std::string>& names);

/** \brief pairs.csv in the folder of the results: what has been done of a survey, so that it can be gone on
 * with.
 *
 * Beside it stands parameters.json. Where that is equal to the parameters of the new run, sub-maps and the
 * version of the program included, the results of the earlier one count; otherwise both start anew.
 */
class SurveyRecord {
 public:
  /// Reads what an earlier run with the same parameters has left.
  /// \throws WorkError naming the file that cannot be read or written
  SurveyRecord(const std::string& directory, const nlohmann::ordered_json& parameters,
               const std::vector<std::string>& names);

  /// The result of a method on a pair, if there is one.
  const core::PairResult* find(const std::string& method, const core::SubmapPair& pair) const;

  /// Adds a result and writes the table. \throws WorkError naming the file
  void add(const core::PairResult& result);

  const std::vector<core::PairResult>& results() const { return results_; }

 private:
  std::string path_;
  std::vector<std::string> names_;
  std::vector<core::PairResult> results_;
};

}  // namespace pcl_fft_ground::cli

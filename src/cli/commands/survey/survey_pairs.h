#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <tuple>
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

/// One of several runs that share the pairs of a survey among them.
struct Shard {
  std::size_t number = 1, count = 1;  ///< number from 1 to count
};

/** \brief What has been done of a survey, so that it can be gone on with: pairs.csv in the folder of the
 * results, which is written once all is done, and until then a journal, to which each result is added.
 *
 * Beside them stands parameters.json. Where that is equal to the parameters of the new run, sub-maps and the
 * version of the program included, the results of earlier runs count, those of shards, too; otherwise all
 * start anew. Of a journal that was cut off within a line that line does not count.
 */
class SurveyRecord {
 public:
  /// Reads what earlier runs with the same parameters have left.
  /// \throws WorkError naming the file that cannot be read or written
  SurveyRecord(const std::string& directory, const nlohmann::ordered_json& parameters,
               const std::vector<std::string>& names, const std::optional<Shard>& shard);

  /// The result of a method on a pair, if there is one; it stays where it is.
  const core::PairResult* find(const std::string& method, const core::SubmapPair& pair) const;

  /// Adds a result to the journal. \throws WorkError naming the file
  void add(const core::PairResult& result);

  /// Writes pairs.csv, these results first, and removes the journals. \throws WorkError naming the file
  void finish(const std::vector<core::PairResult>& first);

 private:
  using Key = std::tuple<std::string, std::size_t, std::size_t>;
  static Key keyOf(const core::PairResult& result);
  std::vector<std::string> journals() const;
  void take(const std::vector<core::PairResult>& results);

  std::string directory_, journal_;
  std::vector<std::string> names_;
  std::map<Key, core::PairResult> results_;
};

}  // namespace pcl_fft_ground::cli

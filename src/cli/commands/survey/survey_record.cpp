#include "commands/survey/survey_record.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include "commands/segment/segment_report.h"
#include "io/output_file.h"

namespace pcl_fft_ground::cli {
namespace {

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

SurveyRecord::SurveyRecord(const std::string& directory, const nlohmann::ordered_json& parameters,
                           const std::vector<std::string>& names)
    : path_(directory + "/pairs.csv"), names_(names) {
  const std::string parameters_path = directory + "/parameters.json";
  const std::string wanted = asText(parameters);
  std::error_code ignored;
  if (std::filesystem::exists(path_, ignored) && contentOf(parameters_path) == wanted) {
    results_ = readPairs(path_, names_);
    return;
  }
  std::filesystem::remove(path_, ignored);
  writeText(parameters_path, wanted);
}

const PairResult* SurveyRecord::find(const PairTask& task) const {
  const auto found = std::find_if(results_.begin(), results_.end(), [&](const PairResult& result) {
    return result.method == task.method && result.reference == task.pair.reference &&
           result.moving == task.pair.moving;
  });
  return found == results_.end() ? nullptr : &*found;
}

void SurveyRecord::add(const PairResult& result) {
  results_.push_back(result);
  writeText(path_, asCsv(results_, names_));
}

}  // namespace pcl_fft_ground::cli

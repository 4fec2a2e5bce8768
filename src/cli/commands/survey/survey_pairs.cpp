#include "commands/survey/survey_pairs.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iomanip>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "errors.h"
#include "io/output_file.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using core::PairResult;

constexpr const char* HEADER =
    "method,kind,reference,moving,status,matches,score,overlap,nx_before,nx_after,delta_nx,overlap_crispness_"
    "before,"
    "overlap_crispness_after,translation_error,rotation_error,seconds,x,y,z,qx,qy,qz,qw,cxx,cxy,cxz,cxa,cxb,"
    "cxc,cyy,"
    "cyz,cya,cyb,cyc,czz,cza,czb,czc,caa,cab,cac,cbb,cbc,ccc,refusal";
const std::array<const char*, 2> KINDS{"chain", "other"};
const std::array<const char*, 4> STATUSES{"aligned", "refused", "unprocessed", "not-run"};

std::ostream& operator<<(std::ostream& out, const std::optional<double>& value) {
  return value ? out << *value : out;
}

std::string asLine(const PairResult& r, const std::vector<std::string>& names) {
  std::ostringstream line;
  line << std::setprecision(12) << r.method << ',' << KINDS.at(static_cast<std::size_t>(r.kind)) << ','
       << names[r.reference] << ',' << names[r.moving] << ','
       << STATUSES.at(static_cast<std::size_t>(r.status)) << ',' << r.matches << ',' << r.score << ','
       << r.overlap << ',' << r.nx_before << ',' << r.nx_after << ',' << r.crispnessChange() << ','
       << r.crispness_before << ',' << r.crispness_after << ',' << r.translation_error << ','
       << r.rotation_error << ',' << r.seconds;
  const Eigen::Quaterniond q(r.reference_from_moving.linear());
  for (int i = 0; i < 3; ++i) line << ',' << r.reference_from_moving.translation()[i];
  for (int i = 0; i < 4; ++i) line << ',' << q.coeffs()[i];
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) line << ',' << r.covariance(i, j);
  line << ',' << std::quoted(r.refusal, '"', '"') << '\n';
  return line.str();
}

/// Takes the fields of a line one after the other.
class FieldReader {
 public:
  explicit FieldReader(const std::string& line) : line_(line) {}

  std::string word() {
    std::string field;
    std::getline(line_, field, ',');
    return field;
  }
  double number() { return std::stod(word()); }
  std::size_t count() { return static_cast<std::size_t>(std::stoull(word())); }
  std::optional<double> optionalNumber() {
    const std::string field = word();
    return field.empty() ? std::nullopt : std::optional<double>(std::stod(field));
  }
  /// The place of a word in a list. \throws std::invalid_argument if it is not there
  template <typename List>
  std::size_t oneOf(const List& list) {
    const auto found = std::find(list.begin(), list.end(), word());
    if (found == list.end()) throw std::invalid_argument("unknown word");
    return static_cast<std::size_t>(found - list.begin());
  }
  std::string quotedRest() {
    std::string field;
    line_ >> std::quoted(field, '"', '"');
    return field;
  }

 private:
  std::istringstream line_;
};

void readTransform(FieldReader& fields, PairResult& r) {
  Eigen::Vector3d translation;
  Eigen::Quaterniond rotation;
  for (int i = 0; i < 3; ++i) translation[i] = fields.number();
  for (int i = 0; i < 4; ++i) rotation.coeffs()[i] = fields.number();
  r.reference_from_moving = Eigen::Translation3d(translation) * rotation.normalized();
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) r.covariance(i, j) = r.covariance(j, i) = fields.number();
}

PairResult parseLine(const std::string& line, const std::vector<std::string>& names) {
  FieldReader fields(line);
  PairResult r;
  r.method = fields.word();
  r.kind = static_cast<core::PairKind>(fields.oneOf(KINDS));
  r.reference = fields.oneOf(names);
  r.moving = fields.oneOf(names);
  r.status = static_cast<core::PairStatus>(fields.oneOf(STATUSES));
  r.matches = fields.count();
  r.score = fields.number();
  r.overlap = fields.number();
  r.nx_before = fields.count();
  r.nx_after = fields.count();
  fields.word();  // delta Nx follows from the two
  r.crispness_before = fields.optionalNumber();
  r.crispness_after = fields.optionalNumber();
  r.translation_error = fields.optionalNumber();
  r.rotation_error = fields.optionalNumber();
  r.seconds = fields.number();
  readTransform(fields, r);
  r.refusal = fields.quotedRest();
  return r;
}

std::string contentOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string asCsv(const std::vector<PairResult>& results, const std::vector<std::string>& names) {
  std::string csv = std::string(HEADER) + "\n";
  for (const PairResult& result : results) csv += asLine(result, names);
  return csv;
}

std::vector<PairResult> readPairs(const std::string& path, const std::vector<std::string>& names) {
  std::ifstream file(path);
  std::string line;
  if (!file) throw WorkError(path + ": cannot be read");
  if (!std::getline(file, line)) return {};
  if (line != HEADER) throw WorkError(path + ": is no table of pairs; delete it to start anew");
  std::vector<PairResult> results;
  try {
    while (std::getline(file, line)) results.push_back(parseLine(line, names));
  } catch (const std::logic_error&) {  // of the conversions: a word that is no number or not in a list
    throw WorkError(path + ": '" + line.substr(0, 40) +
                    "...' is no line of a table of pairs; delete the file to start anew");
  }
  return results;
}

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

const PairResult* SurveyRecord::find(const std::string& method, const core::SubmapPair& pair) const {
  const auto found = std::find_if(results_.begin(), results_.end(), [&](const PairResult& result) {
    return result.method == method && result.reference == pair.reference && result.moving == pair.moving;
  });
  return found == results_.end() ? nullptr : &*found;
}

void SurveyRecord::add(const PairResult& result) {
  results_.push_back(result);
  writeText(path_, asCsv(results_, names_));
}

}  // namespace pcl_fft_ground::cli

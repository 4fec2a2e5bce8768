#include "commands/survey/survey_pairs.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
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
constexpr const char* JOURNAL = ".journal";
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

std::string wholeLinesOf(const std::string& path) {
  const std::string content = contentOf(path);
  return content.substr(0, content.rfind('\n') + 1);  // nothing where there is no end of a line
}

/// \param path named in errors
std::vector<PairResult> parseTable(std::istream& table, const std::string& path,
                                   const std::vector<std::string>& names) {
  std::string line;
  if (!std::getline(table, line)) return {};
  if (line != HEADER) throw WorkError(path + ": is no table of pairs; delete it to start anew");
  std::vector<PairResult> results;
  try {
    while (std::getline(table, line)) results.push_back(parseLine(line, names));
  } catch (const std::logic_error&) {  // of the conversions: a word that is no number or not in a list
    throw WorkError(path + ": '" + line.substr(0, 40) +
                    "...' is no line of a table of pairs; delete the file to start anew");
  }
  return results;
}

}  // namespace

std::string asCsv(const std::vector<PairResult>& results, const std::vector<std::string>& names) {
  std::string csv = std::string(HEADER) + "\n";
  for (const PairResult& result : results) csv += asLine(result, names);
  return csv;
}

std::vector<PairResult> readPairs(const std::string& path, const std::vector<std::string>& names) {
  std::ifstream file(path);
  if (!file) throw WorkError(path + ": cannot be read");
  return parseTable(file, path, names);
}

SurveyRecord::SurveyRecord(const std::string& directory, const nlohmann::ordered_json& parameters,
                           const std::vector<std::string>& names, const std::optional<Shard>& shard)
    : directory_(directory),
      journal_(directory + (shard ? "/pairs." + std::to_string(shard->number) + "-of-" +
                                        std::to_string(shard->count) + JOURNAL
                                  : std::string("/pairs") + JOURNAL)),
      names_(names) {
  const std::string table = directory + "/pairs.csv", parameters_path = directory + "/parameters.json";
  const std::string wanted = asText(parameters);
  std::error_code ignored;
  const bool is_known = std::filesystem::exists(parameters_path, ignored);
  if (is_known && contentOf(parameters_path) == wanted) {
    if (std::filesystem::exists(table, ignored)) take(readPairs(table, names_));
    for (const std::string& path : journals()) {
      std::istringstream lines(wholeLinesOf(path));
      take(parseTable(lines, path, names_));
      if (path == journal_) writeText(journal_, lines.str());  // without what was cut off
    }
    return;
  }
  std::filesystem::remove(table, ignored);
  // Where there are no parameters yet another shard may have begun a moment ago.
  if (is_known)
    for (const std::string& path : journals()) std::filesystem::remove(path, ignored);
  writeText(parameters_path, wanted);
}

SurveyRecord::Key SurveyRecord::keyOf(const PairResult& result) {
  return {result.method, result.reference, result.moving};
}

std::vector<std::string> SurveyRecord::journals() const {
  std::vector<std::string> paths;
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(directory_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.rfind("pairs", 0) == 0 && entry.path().extension() == JOURNAL)
      paths.push_back(directory_ + "/" + name);
  }
  std::sort(paths.begin(), paths.end());
  return paths;
}

void SurveyRecord::take(const std::vector<PairResult>& results) {
  for (const PairResult& result : results) results_.emplace(keyOf(result), result);
}

const PairResult* SurveyRecord::find(const std::string& method, const core::SubmapPair& pair) const {
  const auto found = results_.find({method, pair.reference, pair.moving});
  return found == results_.end() ? nullptr : &found->second;
}

void SurveyRecord::add(const PairResult& result) {
  std::error_code ignored;
  const bool is_new = !std::filesystem::exists(journal_, ignored);
  errno = 0;
  std::ofstream journal(journal_, std::ios::binary | std::ios::app);
  if (is_new) journal << HEADER << '\n';
  const std::string line = asLine(result, names_);
  journal << line;
  journal.close();
  if (!journal)
    throw WorkError("cannot write '" + journal_ +
                    "': " + (errno != 0 ? std::strerror(errno) : "writing failed"));
  // As a run that goes on from here, or is made again, will read it: what follows is the same bits then.
  results_.emplace(keyOf(result), parseLine(line.substr(0, line.size() - 1), names_));
}

void SurveyRecord::finish(const std::vector<PairResult>& first) {
  std::vector<PairResult> all = first;
  std::map<Key, PairResult> others = results_;
  for (const PairResult& result : first) others.erase(keyOf(result));
  for (const auto& [key, result] : others) all.push_back(result);  // of other methods
  writeText(directory_ + "/pairs.csv", asCsv(all, names_));
  std::error_code ignored;
  for (const std::string& path : journals()) std::filesystem::remove(path, ignored);
}

}  // namespace pcl_fft_ground::cli

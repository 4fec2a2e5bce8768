#include "command_line.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <typeinfo>

#include "errors.h"
#include "io/scanner.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;

bool isOptionName(const std::string& word) {
  return word.size() > 2 && word.compare(0, 2, "--") == 0 && word.find('=') == std::string::npos;
}

/// "-1", "-.5", "-inf", "-nan": the parser would take these for options.
bool isNegativeNumber(const std::string& word) {
  if (word.size() < 2 || word[0] != '-') return false;
  return std::isdigit(static_cast<unsigned char>(word[1])) != 0 || word[1] == '.' || word == "-inf" ||
         word == "-nan";
}

/// The error of a value that is no number, saying what is allowed.
UsageError invalidValue(const std::string& command, const po::options_description& options,
                        const po::validation_error& error) {
  const std::string option = error.get_option_name();
  const po::option_description* const description = options.find_nothrow(option.substr(2), false);
  const auto* const value = description == nullptr
                                ? nullptr
                                : dynamic_cast<const po::typed_value_base*>(description->semantic().get());
  const bool is_real = value != nullptr && value->value_type() == typeid(double);
  return UsageError(command + ": " + error.what() + ": allowed is a " +
                    (is_real ? "number" : "whole number"));
}

/// True for options that take three words.
bool takesThree(const std::string& word) {
  return word == "--up-direction" || word == "--sensor";
}

/// Whether so many of the words, from the first on, are there and are numbers.
bool areNumbers(const std::vector<std::string>& words, std::size_t first, std::size_t count) {
  if (first + count > words.size()) return false;
  const auto begin = words.begin() + static_cast<std::ptrdiff_t>(first);
  return std::all_of(begin, begin + static_cast<std::ptrdiff_t>(count),
                     [](const std::string& word) { return parseNumber<double>(word).has_value(); });
}

/// Ties negative numbers, and the three values of a direction or a place, to the option before them.
std::vector<std::string> tieValues(const std::string& command, const std::vector<std::string>& arguments) {
  std::vector<std::string> tied;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string& word = arguments[i];
    if (takesThree(word)) {
      if (i + 3 >= arguments.size())
        throw UsageError(command + ": " + word + ": allowed are three numbers, X Y Z");
      tied.push_back(word + "=" + arguments[i + 1] + " " + arguments[i + 2] + " " + arguments[i + 3]);
      i += 3;
      if (word == "--sensor" && areNumbers(arguments, i + 1, 3)) {  // that of a second scan
        tied.back() += " " + arguments[i + 1] + " " + arguments[i + 2] + " " + arguments[i + 3];
        i += 3;
      }
    } else if (isOptionName(word) && i + 1 < arguments.size() && isNegativeNumber(arguments[i + 1])) {
      tied.push_back(word + "=" + arguments[++i]);
    } else {
      tied.push_back(word);
    }
  }
  return tied;
}

}  // namespace

po::variables_map parseArguments(const std::string& command, const std::vector<std::string>& arguments,
                                 const po::options_description& options,
                                 const po::positional_options_description& positional) {
  constexpr int STYLE = po::command_line_style::unix_style & ~po::command_line_style::allow_guessing;
  try {
    po::variables_map values;
    po::store(po::command_line_parser(tieValues(command, arguments))
                  .options(options)
                  .positional(positional)
                  .style(STYLE)
                  .run(),
              values);
    po::notify(values);
    return values;
  } catch (const po::invalid_option_value& error) {
    throw invalidValue(command, options, error);
  } catch (const po::too_many_positional_options_error&) {
    throw UsageError(command + ": too many words without an option; a name with blanks needs quotes");
  } catch (const po::error& error) {
    throw UsageError(command + ": " + error.what());
  }
}

void addThreadsOption(po::options_description& options) {
  options.add_options()(
      "threads", po::value<int>()->default_value(0)->value_name("N"),
      "threads that share the work, 0 to 1024; 0: one for each core. The results do not depend on it");
}

unsigned threadsOf(const po::variables_map& values) {
  constexpr int MOST = 1024;
  const int threads = values["threads"].as<int>();
  if (threads < 0 || threads > MOST)
    throw UsageError("--threads " + std::to_string(threads) + ": allowed are 0 to " + std::to_string(MOST));
  return static_cast<unsigned>(threads);
}

void addReportOption(po::options_description& options) {
  options.add_options()(
      "report", po::value<std::string>()->value_name("FILE"),
      "write a page of HTML, too, which needs nothing else: a view in three dimensions that can be "
      "turned, pictures, tables, parameters and warnings");
}

std::string reportPath(const po::variables_map& values, const std::string& output) {
  if (values.count("report") == 0) return "";
  namespace fs = std::filesystem;
  const auto path = values["report"].as<std::string>();
  if (fs::path(path).filename().empty())
    throw UsageError("--report " + path + ": allowed is the name of a file");
  // With a slash at the end, whether there was one or not.
  const auto folderOf = [](const fs::path& folder) { return fs::absolute(folder / ".").lexically_normal(); };
  const fs::path folder = folderOf(fs::path(path).parent_path());
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored) && (output.empty() || folder != folderOf(output)))
    throw WorkError("cannot write '" + path + "': its folder does not exist");
  return path;
}

}  // namespace pcl_fft_ground::cli

#pragma once

#include <boost/program_options.hpp>
#include <string>
#include <vector>

#include "pcl_fft_ground/core/scan/threads.h"

namespace pcl_fft_ground::cli {

/// Columns of a help text, and of the explanations in it.
constexpr unsigned HELP_WIDTH = 110;
constexpr unsigned HELP_TEXT_WIDTH = 60;

/** Parses the words behind a command in the manner that all commands share.
 *
 * `--name value` and `--name=value`, negative numbers too; `--up-direction X Y Z` and `--sensor X Y Z` take
 * three words and yields one, "X Y Z". Names are written out in full.
 *
 * \param command name of the command, for the messages
 * \param positional the options that take the words without a name
 * \throws UsageError for anything else
 */
boost::program_options::variables_map parseArguments(
    const std::string& command, const std::vector<std::string>& arguments,
    const boost::program_options::options_description& options,
    const boost::program_options::positional_options_description& positional);

/// Adds --threads N, the number of threads that share the work.
void addThreadsOption(boost::program_options::options_description& options);

/// The number that --threads gives. \throws UsageError beyond 0 to 1024
unsigned threadsOf(const boost::program_options::variables_map& values);

/// Adds --report FILE.
void addReportOption(boost::program_options::options_description& options);

/** The file that --report names; empty without it.
 * \param output directory for the results, which may not be there yet; empty where there is none
 * \throws UsageError if it names no file, WorkError if its folder is not there
 */
std::string reportPath(const boost::program_options::variables_map& values, const std::string& output);

}  // namespace pcl_fft_ground::cli

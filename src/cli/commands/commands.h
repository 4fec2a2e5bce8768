#pragma once

#include <string>
#include <vector>

/** The commands of the program, a function each.
 *
 * Every one takes the words that follow its name on the command line and throws UsageError for unknown
 * options and values out of range, and WorkError where a file, its points or an output make the work fail.
 */
namespace pcl_fft_ground::cli {

/// `segment CLOUD -o DIR ...`: splits a cloud into ground, objects and segments.
void runSegment(const std::vector<std::string>& arguments);

/// `evaluate CLOUD... ...`: compares methods on labelled clouds.
void runEvaluate(const std::vector<std::string>& arguments);

/// `simulate wreck|pipes|reef -o FILE ...`: writes one labelled scan; `simulate survey ...`: a survey.
void runSimulate(const std::vector<std::string>& arguments);

/// `align REFERENCE MOVING -o DIR ...`: aligns two overlapping scans by their segments.
void runAlign(const std::vector<std::string>& arguments);

/// `survey FOLDER... -o DIR ...`: aligns the sub-maps of surveys: Table II and global alignment.
void runSurvey(const std::vector<std::string>& arguments);

}  // namespace pcl_fft_ground::cli

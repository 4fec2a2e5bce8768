#pragma once

#include <functional>
#include <string>
#include <vector>

#include "commands/align/alignment_options.h"
#include "commands/survey/survey_folder.h"
#include "commands/survey/survey_pair.h"
#include "commands/survey/survey_scans.h"
#include "pcl_fft_ground/core/survey/pairing.h"

namespace pcl_fft_ground::cli {

/// A pair that is to be aligned by one method.
struct PairTask {
  std::string method;
  PairKind kind;
  core::SubmapPair pair;
};

/** What there is to do: the pairs of the chain by every method, then all other pairs that overlap by one.
 * \param methods names of methods, DENSE_ICP among them or not
 * \param mapping the method of the global alignment */
std::vector<PairTask> planPairs(const SurveyFolder& survey, const std::vector<std::string>& methods,
                                const std::string& mapping);

/** Aligns one pair from where navigation has it, and measures what came of it.
 * \throws WorkError naming the file of a sub-map that cannot be used */
PairResult alignPair(const PairTask& task, const SurveyFolder& survey, SurveyScans& scans,
                     const AlignmentSettings& settings);

}  // namespace pcl_fft_ground::cli

#pragma once

#include <boost/program_options.hpp>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string>

#include "methods/segmentation.h"
#include "progress.h"

namespace pcl_fft_ground::cli {

/// Parts of report.json.
nlohmann::ordered_json describeUp(const UpDirection& up);
nlohmann::ordered_json describeScores(const std::optional<core::Confusion>& confusion);
nlohmann::ordered_json describeElevation(const core::GridGeometry& cells, double empty_share);
nlohmann::ordered_json describeSpectrum(const core::Spectrum& spectrum, const core::Cutoff& cutoff,
                                        const std::vector<core::SpectrumPeak>& peaks);
nlohmann::ordered_json describeSeconds(const Progress& progress);

/// The content of report.json. Numbers that do not exist (a rate without objects) are null.
nlohmann::ordered_json makeReport(const std::string& input, const Cloud& cloud, const Segmenter& segmenter,
                                  const Segmentation& segmentation, nlohmann::ordered_json parameters,
                                  const std::vector<std::string>& warnings, const Progress& progress);

/// The page of HTML that shows the results, those in `directory` and those of the report.
std::string segmentPage(const std::string& directory, const Cloud& cloud, const Segmentation& segmentation,
                        const nlohmann::ordered_json& report);

/// The few lines that a person wants to read of a report.
void printSummary(std::ostream& out, const nlohmann::ordered_json& report);

}  // namespace pcl_fft_ground::cli

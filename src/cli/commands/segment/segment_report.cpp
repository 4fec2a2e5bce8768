#include "commands/segment/segment_report.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

#include "pcl_fft_ground/version.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t PEAKS_IN_REPORT = 100;  // the nearest to DC; the rest is of no use to anyone there

ordered_json describeCounts(const Cloud& cloud, const Segmenter& segmenter,
                            const Segmentation& segmentation) {
  const std::size_t ground = segmentation.ground.indices.size(),
                    objects = segmentation.objects.indices.size();
  std::size_t clustered = 0;
  for (const pcl::PointIndices& cluster : segmentation.clusters) clustered += cluster.indices.size();
  return {{"points", cloud.points->size()},
          {"ground", ground},
          {"objects", objects},
          {"neither", cloud.points->size() - ground - objects},
          {"far", segmenter.filter->getFarPoints().size()},
          {"segments", segmentation.clusters.size()},
          {"points_in_segments", clustered}};
}

ordered_json describePeak(const core::SpectrumPeak& peak) {
  return {{"k", peak.k}, {"l", peak.l}, {"frequency", peak.radius}, {"magnitude", peak.magnitude}};
}

const char* nameOf(core::CutoffSource source) {
  switch (source) {
    case core::CutoffSource::PEAK:
      return "peak";
    case core::CutoffSource::FALLBACK:
      return "largest object, as no peak qualified";
    case core::CutoffSource::FINEST_WAVELENGTH:
      return "finest wavelength";
    case core::CutoffSource::GIVEN:
      break;
  }
  return "option";
}

}  // namespace

ordered_json describeSpectrum(const core::Spectrum& spectrum, const core::Cutoff& cutoff,
                              const std::vector<core::SpectrumPeak>& peaks) {
  ordered_json nearest = ordered_json::array();
  for (std::size_t n = 0; n < std::min(peaks.size(), PEAKS_IN_REPORT); ++n)
    nearest.push_back(describePeak(peaks[n]));
  return {{"rows", spectrum.rows},
          {"cols", spectrum.cols()},
          {"cutoff_frequency", cutoff.frequency},
          {"object_size", cutoff.object_size},
          {"cutoff_from", nameOf(cutoff.source)},
          {"peak", cutoff.peak ? describePeak(*cutoff.peak) : ordered_json()},
          {"peak_count", peaks.size()},
          {"peaks", nearest}};
}

namespace {

/// What the robust estimator found out about the ground.
ordered_json describeGround(const FFTGroundSegmentation<Point>* fft) {
  if (fft == nullptr || fft->getEstimator() != Estimator::ROBUST) return nullptr;
  const core::Mask& supported = fft->getGroundSurface().supported;
  return {{"finest_wavelength", fft->getFinestWavelength()},
          {"height_tolerance", fft->getHeightTolerance()},
          {"spread", fft->getGroundSpread()},
          {"supported_share", supported.cast<double>().mean()},
          {"points_below", fft->getPointsBelowGround()}};
}

const char* nameOf(SideSource source) {
  switch (source) {
    case SideSource::GIVEN:
      return "given";
    case SideSource::OBJECTS:
      return "objects";
    case SideSource::SENSOR:
      return "sensor";
    case SideSource::PRIOR:
      break;
  }
  return "prior";
}

}  // namespace

ordered_json describeUp(const UpDirection& up) {
  return {{"axis", {up.axis.x(), up.axis.y(), up.axis.z()}},
          {"side_from", nameOf(up.side_from)},
          {"axis_confidence", up.axis_confidence},
          {"side_confidence", up.side_confidence},
          {"reasons", up.reasons}};
}

ordered_json describeElevation(const core::GridGeometry& cells, double empty_share) {
  return {{"rows", cells.rows},
          {"cols", cells.cols},
          {"cell_size", cells.cell_size},
          {"lower_corner", {cells.origin.x(), cells.origin.y()}},
          {"empty_cell_share", empty_share}};
}

ordered_json describeSeconds(const Progress& progress) {
  ordered_json seconds;
  for (const auto& [stage, time] : progress.seconds()) seconds[stage] = time;
  return seconds;
}

ordered_json describeScores(const std::optional<core::Confusion>& confusion) {
  if (!confusion) return nullptr;
  return {{"tp", confusion->true_positives},
          {"fp", confusion->false_positives},
          {"tn", confusion->true_negatives},
          {"fn", confusion->false_negatives},
          {"tpr", confusion->truePositiveRate()},
          {"tnr", confusion->trueNegativeRate()},
          {"f1", confusion->f1()}};
}

namespace {

void printShare(std::ostream& out, const ordered_json& counts, const char* name) {
  const auto points = counts["points"].get<double>(), part = counts[name].get<double>();
  out << std::left << std::setw(11) << name << std::right << std::setw(10) << counts[name].get<std::size_t>()
      << "  " << std::fixed << std::setprecision(1) << std::setw(5) << 100 * part / points << " %";
}

}  // namespace

ordered_json makeReport(const std::string& input, const Cloud& cloud, const Segmenter& segmenter,
                        const Segmentation& segmentation, ordered_json parameters,
                        const std::vector<std::string>& warnings, const Progress& progress) {
  const FFTGroundSegmentation<Point>* const fft = segmenter.fft;
  return {{"version", PCL_FFT_GROUND_VERSION},
          {"input", input},
          {"method", segmenter.method},
          {"parameters", std::move(parameters)},
          {"up", describeUp(segmenter.filter->getUp())},
          {"frame_from_input", asRows(segmenter.filter->getFrame().matrix())},
          {"origin", {cloud.origin.x(), cloud.origin.y(), cloud.origin.z()}},
          {"counts", describeCounts(cloud, segmenter, segmentation)},
          {"elevation",
           describeElevation(segmentation.elevation.geometry, segmentation.elevation.emptyCellShare())},
          {"ground", describeGround(segmenter.fft)},
          {"spectrum", fft == nullptr
                           ? ordered_json()
                           : describeSpectrum(fft->getSpectrum(), fft->getCutoff(), fft->getSpectrumPeaks())},
          {"scores", describeScores(segmentation.confusion)},
          {"warnings", warnings},
          {"seconds", describeSeconds(progress)}};
}

void printSummary(std::ostream& out, const ordered_json& report) {
  const ordered_json& counts = report["counts"];
  printShare(out, counts, "ground");
  out << '\n';
  printShare(out, counts, "objects");
  out << "  in " << counts["segments"] << " segments\n";
  if (counts["neither"] != 0) {
    printShare(out, counts, "neither");
    out << '\n';
  }
  const ordered_json &elevation = report["elevation"], &ground = report["ground"],
                     &spectrum = report["spectrum"];
  out << std::setprecision(4) << std::defaultfloat << "grid        " << elevation["rows"] << " x "
      << elevation["cols"] << " cells of " << elevation["cell_size"].get<double>() << " m, "
      << 100 * elevation["empty_cell_share"].get<double>() << " % of them empty\n"
      << std::setprecision(4);
  if (!ground.is_null())
    out << "surface     wavelengths from " << ground["finest_wavelength"].get<double>()
        << " m, ground points spread by " << ground["spread"].get<double>() << " m, objects from "
        << ground["height_tolerance"].get<double>() << " m above\n";
  else if (!spectrum.is_null())
    out << "cut-off     f_c = " << spectrum["cutoff_frequency"].get<double>()
        << ", m_c = " << spectrum["object_size"].get<double>() << " m, from "
        << spectrum["cutoff_from"].get<std::string>() << '\n';
  if (report["scores"].is_null()) return;
  const auto is_known = [&](const char* name) {
    const ordered_json& score = report["scores"][name];
    return score.is_number() && std::isfinite(score.get<double>());
  };
  std::ostringstream scores;
  for (const char* name : {"tpr", "tnr", "f1"})
    if (is_known(name) && (is_known("tpr") || std::string(name) == "tnr"))  // F1 of no objects says nothing
      scores << "  " << name << ' ' << std::setprecision(4) << report["scores"][name].get<double>();
  if (!scores.str().empty()) out << "scores    " << scores.str() << "  against the labels of the input\n";
}

}  // namespace pcl_fft_ground::cli

// The methods that work in the frequency domain: fft-lowpass, as published, and fft, the robust one.

#include "command_line.h"
#include "methods/method.h"
#include "pcl_fft_ground/fft_ground_segmentation.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using nlohmann::ordered_json;

constexpr std::array<std::pair<const char*, Estimator>, 2> ESTIMATORS{
    {{"robust", Estimator::ROBUST}, {"low-pass", Estimator::LOW_PASS}}};
constexpr std::array<std::pair<const char*, CellStatistic>, 2> CELL_STATISTICS{
    {{"lowest", CellStatistic::LOWEST}, {"mean", CellStatistic::MEAN}}};

void setUpLowPass(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "cutoff-frequency", [&](double v) { fft.setCutoffFrequency(v); },
      [&] { return fft.getCutoffFrequency(); });
  parameters.setCount(
      "peak-window", [&](unsigned v) { fft.setPeakWindow(v); }, [&] { return fft.getPeakWindow(); });
  parameters.set<double>(
      "peak-threshold", [&](double v) { fft.setPeakThreshold(v); }, [&] { return fft.getPeakThreshold(); });
  parameters.set<bool>(
      "exact-grid",
      [&](bool exact) {
        if (exact) fft.setGridLengths(core::GridLengths::EXACT);
      },
      [&] { return fft.getGridLengths() == core::GridLengths::EXACT; });
}

void setUpRobustFit(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "max-slope", [&](double v) { fft.setMaximumSlope(v); }, [&] { return fft.getMaximumSlope(); });
  parameters.set<double>(
      "finest-wavelength", [&](double v) { fft.setFinestWavelength(v); },
      [&] { return fft.getFinestWavelength(); });
  parameters.set<std::string>(
      "cell-statistic",
      [&](const auto& v) { fft.setCellStatistic(valueNamed("cell-statistic", v, CELL_STATISTICS)); },
      [&] { return nameOf(fft.getCellStatistic(), CELL_STATISTICS); });
}

/// \param fft its estimator is the final one
void setUp(FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
  parameters.set<double>(
      "cell-size", [&](double v) { fft.setCellSize(v); }, [&] { return fft.getCellSize(); });
  parameters.set<double>(
      "max-object-size", [&](double v) { fft.setMaximumObjectSize(v); },
      [&] { return fft.getMaximumObjectSize(); });
  parameters.set<double>(
      "relative-max-object-size", [&](double v) { fft.setRelativeMaximumObjectSize(v); },
      [&] { return fft.getRelativeMaximumObjectSize(); });
  parameters.setCount(
      "filter-order", [&](unsigned v) { fft.setFilterOrder(v); }, [&] { return fft.getFilterOrder(); });
  parameters.set<double>(
      "passband-ripple", [&](double v) { fft.setPassbandRipple(v); },
      [&] { return fft.getPassbandRipple(); });
  // What is of the other estimator only is checked all the same.
  ordered_json not_in_force;
  ParameterSetter others = parameters.notingIn(not_in_force);
  const bool low_pass = fft.getEstimator() == Estimator::LOW_PASS;
  setUpLowPass(fft, low_pass ? parameters : others);
  setUpRobustFit(fft, low_pass ? others : parameters);
}

/// \param choose sets the estimator, which decides about defaults
template <typename Choose>
Segmenter make(const po::variables_map& values, const Choose& choose) {
  const FFTGroundSegmentation<Point>::Ptr fft(new FFTGroundSegmentation<Point>);
  ordered_json chosen;
  ParameterSetter choosing(values, chosen);
  choose(*fft, choosing);
  Segmenter segmenter = segmenterWith(fft, values, setUp);
  chosen.update(segmenter.parameters);
  segmenter.parameters = chosen;
  segmenter.fft = fft.get();
  return segmenter;
}

}  // namespace

Segmenter makeLowPass(const po::variables_map& values) {
  return make(values, [](FFTGroundSegmentation<Point>& fft, ParameterSetter&) {
    fft.setEstimator(Estimator::LOW_PASS);
  });
}

Segmenter makeRobust(const po::variables_map& values) {
  return make(values, [](FFTGroundSegmentation<Point>& fft, ParameterSetter& parameters) {
    parameters.set<std::string>(
        "estimator", [&](const auto& v) { fft.setEstimator(valueNamed("estimator", v, ESTIMATORS)); },
        [&] { return nameOf(fft.getEstimator(), ESTIMATORS); });
  });
}

void addFrequencyOptions(po::options_description& options) {
  const auto number = [] { return po::value<double>(); };
  const auto count = [] { return po::value<long long>()->value_name("N"); };
  po::options_description fft("Frequency domain (fft, fft-lowpass)", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add_fft = fft.add_options();
  add_fft("relative-max-object-size", number()->value_name("SHARE"),
          "--max-object-size as a share of the scan's smaller horizontal extent, in (0, 1] (0.5)");
  add_fft("filter-order", count(), "order of the low-pass, 1 to 100 (2)");
  add_fft("passband-ripple", number()->value_name("DB"),
          "attenuation at the cut-off [dB], above 0 up to 100 (3)");

  po::options_description robust("Robust estimator (fft)", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add_robust = robust.add_options();
  add_robust("estimator", po::value<std::string>()->value_name("NAME"),
             "robust: the surface is fitted to ground cells only; low-pass: as published, which is what "
             "fft-lowpass does (robust)");
  add_robust("max-slope", number()->value_name("RATIO"),
             "steepest ground, rise over run, for land that breaks at banks and terraces; 0: none (0)");
  add_robust("finest-wavelength", number()->value_name("M"),
             "shortest wavelength of the ground [m], above 0 (chosen from the data)");
  add_robust("cell-statistic", po::value<std::string>()->value_name("NAME"),
             "height of a cell until its ground points are known: lowest or mean (lowest)");

  po::options_description low_pass("Published low-pass (fft-lowpass)", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add_low_pass = low_pass.add_options();
  add_low_pass(
      "cutoff-frequency", number()->value_name("RATIO"),
      "cut-off as a ratio of the Nyquist range, up to 1.414, in place of the automatic one; 0: automatic "
      "(0)");
  add_low_pass("peak-window", po::value<long long>()->value_name("K"),
               "a peak of the spectrum is the largest of (2 K + 1) x (2 K + 1) bins, 1 to 1000 (1)");
  add_low_pass("peak-threshold", number()->value_name("C"),
               "by how much a peak exceeds the other bins, at least 0 (0)");
  add_low_pass("exact-grid", po::bool_switch(),
               "leave the grid's axes as they are, not lengthened to fast lengths");
  options.add(fft).add(robust).add(low_pass);
}

}  // namespace pcl_fft_ground::cli

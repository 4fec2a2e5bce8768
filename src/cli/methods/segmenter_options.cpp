#include "command_line.h"
#include "methods/segmenter.h"

namespace pcl_fft_ground::cli {

namespace po = boost::program_options;

po::options_description segmenterOptions() {
  const auto number = [] { return po::value<double>(); };
  const auto count = [] { return po::value<long long>()->value_name("N"); };
  po::options_description common("Segmentation", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add = common.add_options();
  add("cell-size", number()->value_name("M"),
      "side of an elevation cell [m], above 0 (0.02; fft: chosen from the data)");
  add("max-object-size", number()->value_name("M"),
      "size of the largest object [m], above 0: anything larger is ground");
  add("height-tolerance", number()->value_name("M"),
      "height above the ground up to which a point is ground [m] (0; graph-cut: 0.02; fft: chosen from the "
      "data)");
  add("up-direction", po::value<std::string>()->value_name("X Y Z"),
      "direction of positive elevation (0 0 1)");
  add("up-estimation", po::value<std::string>()->value_name("NAME"),
      "principal-axis: the direction in which the points vary least, turned towards --up-direction; given: "
      "--up-direction itself; auto: the principal axis where it can be trusted (fft and graph-cut: "
      "auto; fft-lowpass: principal-axis; naive, planar and grid: given)");
  add("yaw", po::value<std::string>()->value_name("NAME"),
      "how the grid is turned about up: min-area-rectangle, principal-axes or none (min-area-rectangle; "
      "naive, planar and grid: none)");

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

  po::options_description others("Other methods", HELP_WIDTH, HELP_TEXT_WIDTH);
  auto add_other = others.add_options();
  add_other("distance-threshold", number()->value_name("M"),
            "planar: distance up to which a point lies on the plane [m], above 0 (0.02)");
  add_other("max-iterations", count(), "planar: most planes to try, at least 1 (1000)");
  add_other("probability", number()->value_name("P"),
            "planar: probability of having tried a sample without outliers, in (0, 1) (0.99)");
  add_other("optimize-coefficients", po::value<std::string>()->value_name("ON|OFF"),
            "planar: on fits the plane to all of its inliers in the end (on)");
  add_other("plane-seed", count(), "planar: seed of the samples (1)");
  add_other("voxel-height", number()->value_name("M"), "grid: vertical size of a voxel [m], above 0 (0.02)");
  add_other(
      "object-height", number()->value_name("M"),
      "graph-cut: height above the lower surface where ground and object are equally likely [m] (0.05)");
  add_other("step-height", number()->value_name("M"),
            "graph-cut: height step between cells that makes a border likely [m] (0.02)");
  add_other("smoothness", number()->value_name("S"), "graph-cut: cost of a border, at least 0 (0.5)");
  return common.add(fft).add(robust).add(low_pass).add(others);
}

}  // namespace pcl_fft_ground::cli

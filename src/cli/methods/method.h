#pragma once

#include <boost/program_options.hpp>

#include "methods/parameter_setter.h"
#include "methods/segmenter.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground::cli {

/// How the segmentation makes use of the height tolerance above the ground.
enum class Tolerance {
  NONE,  ///< as published: none unless it is set
  OWN,   ///< the method has one of its own, or chooses it
};

/** A way of telling ground from objects: an entry of the registry.
 *
 * To add a method: write its options and its maker in a file of this folder, declare them below, and add a
 * line to the registry in segmenter.cpp. Help texts, lists and checks of all commands follow.
 */
struct Method {
  const char* name;  ///< as spelled on the command line
  const char* note;  ///< what to tell the two of a kind apart by, for help texts; may be empty
  Tolerance tolerance;
  Purpose purpose;
  void (*add_options)(
      boost::program_options::options_description& options);               ///< those of its own; may be null
  Segmenter (*make)(const boost::program_options::variables_map& values);  ///< all but name and cell size
};

/// What every method can be set to; notes the values.
void setUpCommon(GroundSegmentation<Point>& filter, ParameterSetter& parameters);

/// Parameters with those that were chosen from the data: {"value", "from": "data", "reason"}.
nlohmann::ordered_json withChoices(nlohmann::ordered_json parameters,
                                   const std::vector<core::RobustChoice>& choices);

/// What fits a plane to the ground can be set to.
void setUpPlanar(PlanarGroundSegmentation<Point>& planar, ParameterSetter& parameters);

/// A segmenter whose filter is set up by the common options and those of its kind.
/// \param set_up called with the filter and a ParameterSetter
template <typename Filter, typename SetUp>
Segmenter segmenterWith(const pcl::shared_ptr<Filter>& filter,
                        const boost::program_options::variables_map& values, const SetUp& set_up) {
  Segmenter segmenter;
  segmenter.filter = filter;
  ParameterSetter parameters(values, segmenter.parameters);
  setUpCommon(*filter, parameters);
  set_up(*filter, parameters);
  return segmenter;
}

Segmenter makeNaive(const boost::program_options::variables_map& values);
Segmenter makePlanar(const boost::program_options::variables_map& values);
Segmenter makeGrid(const boost::program_options::variables_map& values);
Segmenter makeGraphCut(const boost::program_options::variables_map& values);
void addOtherOptions(boost::program_options::options_description& options);

Segmenter makeLowPass(const boost::program_options::variables_map& values);
Segmenter makeRobust(const boost::program_options::variables_map& values);
void addFrequencyOptions(boost::program_options::options_description& options);

Segmenter makePclPmf(const boost::program_options::variables_map& values);
Segmenter makePclApproximatePmf(const boost::program_options::variables_map& values);
Segmenter makePclMlesacPlane(const boost::program_options::variables_map& values);
void addPclOptions(boost::program_options::options_description& options);

}  // namespace pcl_fft_ground::cli

#pragma once

#include <pcl/point_types.h>

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "pcl_fft_ground/fft_ground_segmentation.h"
#include "pcl_fft_ground/graph_cut_ground_segmentation.h"
#include "pcl_fft_ground/grid_ground_segmentation.h"
#include "pcl_fft_ground/naive_ground_segmentation.h"
#include "pcl_fft_ground/planar_ground_segmentation.h"

namespace pcl_fft_ground::test {

/// A segmenter with its settings, of which the lengths are multiples of a unit.
template <typename PointT>
struct Method {
  std::string name;
  std::function<std::unique_ptr<GroundSegmentation<PointT>>(double unit)> make;
};

/// A method whose settings `set` makes, given the segmenter and the unit.
template <typename SegmenterT, typename Setter, typename PointT>
void addMethod(std::vector<Method<PointT>>& methods, const std::string& name, Setter set) {
  methods.push_back({name, [set](double unit) -> std::unique_ptr<GroundSegmentation<PointT>> {
                       auto segmenter = std::make_unique<SegmenterT>();
                       set(*segmenter, unit);
                       return segmenter;
                     }});
}

/** All estimators and siblings. A unit of 1 suits scans of some metres with objects of up to one metre.
 * Each length that has a default in metres is set.
 */
template <typename PointT>
std::vector<Method<PointT>> everyMethod() {
  using Fft = FFTGroundSegmentation<PointT>;
  std::vector<Method<PointT>> methods;
  addMethod<Fft>(methods, "robust", [](Fft& f, double) { f.setRelativeMaximumObjectSize(0.25); });
  addMethod<Fft>(methods, "robust with the largest object",
                 [](Fft& f, double unit) { f.setMaximumObjectSize(unit); });
  addMethod<Fft>(methods, "robust with all lengths", [](Fft& f, double unit) {
    f.setMaximumObjectSize(unit);
    f.setCellSize(0.1 * unit);
    f.setFinestWavelength(0.5 * unit);
    f.setHeightTolerance(0.04 * unit);
  });
  addMethod<Fft>(methods, "robust with a slope", [](Fft& f, double unit) {
    f.setMaximumObjectSize(unit);
    f.setMaximumSlope(0.3);
  });
  addMethod<Fft>(methods, "low-pass", [](Fft& f, double unit) {
    f.setEstimator(Estimator::LOW_PASS);
    f.setCellSize(0.1 * unit);
  });
  addMethod<GraphCutGroundSegmentation<PointT>>(methods, "graph cut",
                                                [](GraphCutGroundSegmentation<PointT>& f, double unit) {
                                                  f.setCellSize(0.1 * unit);
                                                  f.setMaximumObjectSize(unit);
                                                  f.setObjectHeight(0.05 * unit);
                                                  f.setStepHeight(0.02 * unit);
                                                  f.setHeightTolerance(0.02 * unit);
                                                });
  addMethod<GridGroundSegmentation<PointT>>(methods, "grid",
                                            [](GridGroundSegmentation<PointT>& f, double unit) {
                                              f.setCellSize(0.1 * unit);
                                              f.setVoxelHeight(0.1 * unit);
                                            });
  addMethod<NaiveGroundSegmentation<PointT>>(methods, "naive",
                                             [](NaiveGroundSegmentation<PointT>&, double) {});
  addMethod<PlanarGroundSegmentation<PointT>>(methods, "planar",
                                              [](PlanarGroundSegmentation<PointT>& f, double unit) {
                                                f.setDistanceThreshold(0.02 * unit);
                                                f.setMaxIterations(200);
                                              });
  return methods;
}

}  // namespace pcl_fft_ground::test

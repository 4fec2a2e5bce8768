#pragma once

#include "pcl_fft_ground/core/ground/graph_cut_ground.h"
#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground {

/** The comparison that the paper leaves to future work: the cells of the elevation grid are labelled by
 * minimum cut. core::estimateGraphCutGround() says what is minimised. A point is an object if it lies above
 * the ground cells, or above the nearest of them, by more than the height tolerance (0.02 m by default).
 */
template <typename PointT>
class GraphCutGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<GraphCutGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const GraphCutGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit GraphCutGroundSegmentation(bool extract_removed_indices = false);

  /// Side of an elevation cell [m], finite and above 0. Default 0.02.
  void setCellSize(double cell_size);
  double getCellSize() const { return parameters_.cell_size; }

  /// Size of the largest object [m], finite and above 0: within it some ground is seen. Default 1.
  void setMaximumObjectSize(double size);
  double getMaximumObjectSize() const { return parameters_.max_object_size; }

  /// Height above the lower surface where ground and object are equally likely [m], finite and above 0.
  /// Default 0.05.
  void setObjectHeight(double height);
  double getObjectHeight() const { return parameters_.object_height; }

  /// Height step between neighbouring cells that makes a border likely [m], finite and above 0. Default 0.02.
  void setStepHeight(double height);
  double getStepHeight() const { return parameters_.step_height; }

  /// Cost of a border between two cells of equal height, finite, at least 0. Default 0.5.
  void setSmoothness(double smoothness);
  double getSmoothness() const { return parameters_.smoothness; }

  /// Elevation of the ground cells; object cells take the nearest one's.
  const core::GroundSurface& getGroundSurface() const override { return ground_.surface; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

 private:
  core::GraphCutParameters parameters_;
  core::GraphCutGround ground_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/graph_cut_ground_segmentation.hpp>
#endif

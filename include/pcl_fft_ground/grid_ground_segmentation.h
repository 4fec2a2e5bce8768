#pragma once

#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground {

/** The paper's third benchmark (Sec. V-B3): the scan is voxelised, and ground is what lies in the bottom
 * voxel of each column. Voxels are counted from the lowest point. Works in the input's own frame: up is GIVEN
 * unless set otherwise.
 */
template <typename PointT>
class GridGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<GridGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const GridGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit GridGroundSegmentation(bool extract_removed_indices = false);

  /// Horizontal size of a voxel [m], finite and above 0. Default 0.02.
  void setCellSize(double cell_size);
  double getCellSize() const { return cell_size_; }

  /// Vertical size of a voxel [m], finite and above 0. Default 0.02.
  void setVoxelHeight(double voxel_height);
  double getVoxelHeight() const { return voxel_height_; }

  /// Top of the bottom voxel of each column.
  const core::GroundSurface& getGroundSurface() const override { return surface_; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

 private:
  double cell_size_ = 0.02;
  double voxel_height_ = 0.02;
  core::GroundSurface surface_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/grid_ground_segmentation.hpp>
#endif

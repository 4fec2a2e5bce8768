#pragma once

#include "pcl_fft_ground/ground_segmentation.h"

namespace pcl_fft_ground {

/** The paper's first benchmark (Sec. V-B1): ground is what lies at or below the mean height along up.
 * Works in the input's own frame: up is GIVEN unless set otherwise.
 */
template <typename PointT>
class NaiveGroundSegmentation : public GroundSegmentation<PointT> {
 public:
  using Ptr = pcl::shared_ptr<NaiveGroundSegmentation<PointT>>;
  using ConstPtr = pcl::shared_ptr<const NaiveGroundSegmentation<PointT>>;

  /// \param extract_removed_indices whether getRemovedIndices() is filled
  explicit NaiveGroundSegmentation(bool extract_removed_indices = false);

  /// The level plane at the mean height.
  const core::GroundSurface& getGroundSurface() const override { return surface_; }

 protected:
  core::Labels labelPoints(const core::Points& points, const Eigen::Isometry3d& frame_from_input) override;

 private:
  core::GroundSurface surface_;
};

}  // namespace pcl_fft_ground

#ifdef PCL_NO_PRECOMPILE
#include <pcl_fft_ground/impl/naive_ground_segmentation.hpp>
#endif

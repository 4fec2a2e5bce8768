#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/segment_icp.hpp"

PCL_INSTANTIATE(SegmentICP,
                (pcl::PointXYZ)(pcl::PointXYZI)(pcl::PointXYZRGB)(pcl::PointXYZRGBA)(pcl::PointNormal))

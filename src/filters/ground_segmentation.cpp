#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/ground_segmentation.hpp"

PCL_INSTANTIATE(GroundSegmentation, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE_GroundSegmentation(pcl::PCLPointCloud2)

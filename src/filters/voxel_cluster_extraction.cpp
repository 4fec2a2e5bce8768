#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/voxel_cluster_extraction.hpp"

PCL_INSTANTIATE(VoxelClusterExtraction, PCL_XYZ_POINT_TYPES)

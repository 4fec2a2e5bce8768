#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/object_cluster_extraction.hpp"
#include "pcl_fft_ground/impl/voxel_cluster_extraction.hpp"

PCL_INSTANTIATE(ClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(ObjectClusterExtraction, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE(VoxelClusterExtraction, PCL_XYZ_POINT_TYPES)

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/object_cluster_extraction.hpp"

PCL_INSTANTIATE(ObjectClusterExtraction, PCL_XYZ_POINT_TYPES)

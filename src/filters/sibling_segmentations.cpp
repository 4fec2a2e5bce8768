#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/graph_cut_ground_segmentation.hpp"
#include "pcl_fft_ground/impl/grid_ground_segmentation.hpp"
#include "pcl_fft_ground/impl/naive_ground_segmentation.hpp"
#include "pcl_fft_ground/impl/planar_ground_segmentation.hpp"

PCL_INSTANTIATE(ExternGroundSegmentation, PCL_XYZ_POINT_TYPES)
PCL_INSTANTIATE_ExternGroundSegmentation(pcl::PCLPointCloud2)
    PCL_INSTANTIATE(GraphCutGroundSegmentation, PCL_XYZ_POINT_TYPES)
        PCL_INSTANTIATE_GraphCutGroundSegmentation(pcl::PCLPointCloud2)
            PCL_INSTANTIATE(GridGroundSegmentation, PCL_XYZ_POINT_TYPES)
                PCL_INSTANTIATE_GridGroundSegmentation(pcl::PCLPointCloud2)
                    PCL_INSTANTIATE(NaiveGroundSegmentation, PCL_XYZ_POINT_TYPES)
                        PCL_INSTANTIATE_NaiveGroundSegmentation(pcl::PCLPointCloud2)
                            PCL_INSTANTIATE(PlanarGroundSegmentation, PCL_XYZ_POINT_TYPES)
                                PCL_INSTANTIATE_PlanarGroundSegmentation(pcl::PCLPointCloud2)

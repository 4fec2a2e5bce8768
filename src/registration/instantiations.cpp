// The classes of the component for the point types that most clouds have.

#include <pcl/point_types.h>
#include <pcl/impl/instantiate.hpp>

#include "pcl_fft_ground/impl/relief_alignment.hpp"
#include "pcl_fft_ground/impl/scan_describer.hpp"
#include "pcl_fft_ground/impl/segment_icp.hpp"
#include "pcl_fft_ground/impl/survey_alignment.hpp"

#define PCL_FFT_GROUND_REGISTERED_POINTS \
  (pcl::PointXYZ)(pcl::PointXYZI)(pcl::PointXYZRGB)(pcl::PointXYZRGBA)(pcl::PointNormal)

PCL_INSTANTIATE(ReliefAlignment, PCL_FFT_GROUND_REGISTERED_POINTS)
PCL_INSTANTIATE(ScanDescriber, PCL_FFT_GROUND_REGISTERED_POINTS)
PCL_INSTANTIATE(SegmentICP, PCL_FFT_GROUND_REGISTERED_POINTS)
PCL_INSTANTIATE(SurveyAlignment, PCL_FFT_GROUND_REGISTERED_POINTS)

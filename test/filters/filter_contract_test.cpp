// The contract on point types that the library is compiled for.

#include <pcl/point_types.h>

#include "contract_suite.h"

namespace pcl_fft_ground::test {

using CompiledSubjects =
    testing::Types<Subject<FFTGroundSegmentation, pcl::PointXYZ>, Subject<LowPassSegmentation, pcl::PointXYZ>,
                   Subject<FFTGroundSegmentation, pcl::PointXYZI>,
                   Subject<FFTGroundSegmentation, pcl::PointXYZRGBNormal>>;
INSTANTIATE_TYPED_TEST_SUITE_P(Compiled, FilterContract, CompiledSubjects);

}  // namespace pcl_fft_ground::test

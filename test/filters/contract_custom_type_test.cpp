// The contract on a point type of the user's own, instantiated by including the bodies of the classes.

#include "pcl_fft_ground/impl/fft_ground_segmentation.hpp"

#include "contract_suite.h"
#include "custom_point.h"

namespace pcl_fft_ground::test {

using CustomSubjects = testing::Types<Subject<FFTGroundSegmentation, SonarPoint>>;
INSTANTIATE_TYPED_TEST_SUITE_P(ImplIncluded, FilterContract, CustomSubjects);

}  // namespace pcl_fft_ground::test

// The contract on a point type of the user's own, instantiated the way PCL's own headers offer.

#define PCL_NO_PRECOMPILE

#include "contract_suite.h"
#include "custom_point.h"

namespace pcl_fft_ground::test {

using CustomSubjects = testing::Types<Subject<FFTGroundSegmentation, SonarPoint>>;
INSTANTIATE_TYPED_TEST_SUITE_P(NoPrecompile, FilterContract, CustomSubjects);

}  // namespace pcl_fft_ground::test

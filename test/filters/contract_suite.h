#pragma once

// The whole contract. A source file instantiates it with INSTANTIATE_TYPED_TEST_SUITE_P for its Subjects.

#include "contract_cloud.h"
#include "contract_degenerate.h"
#include "contract_indices.h"
#include "contract_input.h"
#include "contract_interface.h"

namespace pcl_fft_ground::test {

REGISTER_TYPED_TEST_SUITE_P(
    FilterContract, Line01WithoutInputNothingHappens, Line02EmptyCloudGivesEmptyResults,
    Line03MutableIndicesAreAliasedOthersCopied, Line04ImplicitIndicesFollowTheCloudExplicitOnesPersist,
    Line05EmptyIndexListGivesAnEmptyResult, Line06InvalidIndexIsAnErrorWithAnEmptyResult,
    Line07InputIsNeverModified, Line08OldContentIsDiscardedOrderAndMultiplicityKept,
    Line09ResultAndRemovedTogetherAreTheInputIndices, Line10NanInOtherFieldsIsIrrelevant,
    Line10NonFinitePointsAreAlwaysRemoved, Line11ModesAreDisjointAndTogetherAllFinitePoints,
    Line12RemovedIndicesAreEmptyByDefault, Line13RemovedIndicesLeaveTheHeaderAlone,
    Line14EveryRunMakesAFreshRemovedList, Line15OutputMayBeTheInputIndices, Line16BothOverloadsAgree,
    Line17RepeatedCallsAreIdenticalAndSettersActOnTheNext, Line18AsManyPointsAsTheInputInAnotherOrder,
    Line18CompleteResultKeepsWidthAndHeight, Line18ResultIsOneRowUnlessComplete,
    Line19FieldsHeaderAndSensorPoseAreCopied, Line20DensityIsThatOfTheInput,
    Line21KeepOrganizedReplacesRemovedCoordinatesOnly, Line22KeepOrganizedDensity,
    Line23KeepOrganizedIsQuietAndLeavesTheRemovedFlagAlone, Line23KeepOrganizedTouchesListedPointsOnly,
    Line24WorksInPlace, Line25UsableThroughTheBasePointers, Line26SettersReadBackAndRejectInvalidValues,
    Line27IndicesHavePclsType, Line28And32LabelsAreThoseOfPointXYZ, Line28CopiedFilterIsIndependent,
    Line28PointOrderDoesNotMatter, Line28TwoObjectsInTwoThreadsAreIndependent,
    Line29NothingOnStandardOutputErrorsOnStandardError, Line30AllNan, Line30CellLargerThanTheCloud,
    Line30CollinearPoints, Line30CoordinatesBeyondTheDetailOfFloat, Line30CoordinatesOf100Kilometres,
    Line30IdenticalPoints, Line30LargestFiniteCoordinates, Line30OneCell,
    Line30OneFarOutlierIsReportedAndChangesNothingElse, Line30OnePoint, Line31ResultCanBeClusteredByPcl,
    Line33SegmentGivesBothClasses);

}  // namespace pcl_fft_ground::test

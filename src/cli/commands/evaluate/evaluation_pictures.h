#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <string>
#include <vector>

#include "commands/evaluate/cloud_evaluation.h"
#include "report/html_page.h"

namespace pcl_fft_ground::cli {

/// A name for the picture of each cloud: that of its file with the ending `.png`, followed by _2, _3, ...
/// where it is taken.
std::vector<std::string> pictureNames(const std::vector<std::string>& clouds);

/** One page with the truth and what each method made of it, side by side, seen from above.
 *
 * A cell has the colour of what most of its points are: objects and ground that were found, ground called
 * object, objects that were missed, and points that are not scored. Axes are in metres, in the frame of the
 * file (less the origin that was subtracted).
 * \param up direction of positive elevation
 * \param evaluations of this cloud; one of a method that failed shows the reason
 * \throws WorkError naming the file if it cannot be written
 */
void drawEvaluations(const std::filesystem::path& path, const LabelledCloud& cloud, const Eigen::Vector3d& up,
                     const std::vector<Evaluation>& evaluations);

/// The points of a cloud by what became of them, up being +z: the layers of a view. None if the method
/// failed.
std::vector<ViewLayer> evaluationLayers(const LabelledCloud& cloud, const Eigen::Vector3d& up,
                                        const Evaluation& evaluation);

}  // namespace pcl_fft_ground::cli

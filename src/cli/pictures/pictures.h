#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "pictures/axes.h"
#include "pictures/raster.h"

/// The pictures that the command writes. Grids have x along rows and y along columns; in the pictures y
/// points up and x and y have one scale. Grids finer than the picture are reduced first, so that any size can
/// be drawn. Every function writes exactly the given PNG file and throws WorkError, naming it, where that
/// fails; grids that should have equal sizes but do not are std::invalid_argument. Empty grids and such
/// without a known value give a picture that says so.
namespace pcl_fft_ground::cli {

/// A grid of heights or the like in metres.
struct GridImage {
  Eigen::ArrayXXd values;                            ///< NaN where nothing is known
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();  ///< lower corner of cell (0, 0) [m]
  double cell_size = 1.0;                            ///< [m], > 0
  std::string frame = "the level frame";             ///< whose x and y axes these are
};

/// The spectrum of an elevation grid before and after the low-pass.
struct SpectrumImage {
  Eigen::ArrayXXd before;    ///< magnitudes of the full W x H plane, DC at (0, 0)
  Eigen::ArrayXXd after;     ///< the same size
  double cutoff = 1.0;       ///< f_c, ratio of Nyquist, (0, sqrt 2]
  double object_size = 0.0;  ///< m_c [m]
  double cell_size = 1.0;    ///< [m], > 0
  /// The bin that gave the cut-off, if one did; negative frequencies as -k or as W - k (H - k).
  std::optional<Eigen::Vector2i> peak;
};

/// How many points of a scan have which label.
struct LabelCounts {
  long long ground = 0;
  long long objects = 0;
  long long neither = 0;
};

/// elevation.png and ground.png: colour by height with gentle relief shading. `label` is the title of the
/// colour bar, e.g. "height [m]". Without `range` (low < high, same unit) the colours span robustRange();
/// values beyond take the end's colour, and the bar's ends are then marked. Give both pictures one range to
/// compare them.
void drawHeights(const std::filesystem::path& path, const std::string& title, const GridImage& image,
                 const std::string& label, const std::optional<ValueRange>& range = std::nullopt);

/// What there is in a cell of labels.png.
enum class CellClass {
  GROUND,
  OBJECT,
  ABOVE_GROUND  ///< an object so high above ground which is seen that it should not hide it
};

/// labels.png: ground grey, objects blue as in the paper's Fig. 3, pale where they are high above the ground,
/// cells without points white. `classes` has the size of `shade`, the elevation that gives the relief: -1 no
/// points, else a CellClass. The legend gives `counts`.
void drawLabels(const std::filesystem::path& path, const std::string& title, const GridImage& shade,
                const Eigen::ArrayXXi& classes, const LabelCounts& counts);

/// segments.png: each segment in a colour of its own, the largest ones numbered. `segments` has the size of
/// `shade`: -1 no points, 0 no segment, k from 1 to `count` segment k, count + k the same, pale, as it is
/// high above ground which is seen. The legend gives `count`, the number of segments.
void drawSegments(const std::filesystem::path& path, const std::string& title, const GridImage& shade,
                  const Eigen::ArrayXXi& segments, int count);

/// spectrum.png, after the paper's Fig. 4: magnitudes in dB relative to the largest bin of `before` other
/// than DC, shifted so that DC is in the middle, before and after; the cut-off as an ellipse (a circle, both
/// axes being ratios of Nyquist) and the chosen peak as a magenta star; below them the mean power per ring
/// against frequency. A small cut-off is enlarged in a corner.
void drawSpectrum(const std::filesystem::path& path, const SpectrumImage& image);

/// What to leave room for beside a map.
enum class MapKey { COLOUR_BAR, LEGEND };

/// Where the map of a grid of this size and place lies on its page, its axes in metres. Sides shorter than 4
/// pixels at the common scale are drawn that wide.
Plot mapPlot(const GridImage& image, MapKey key);

enum class SpectrumPanel { BEFORE, AFTER, PROFILE };

/// Where a panel of drawSpectrum() lies; axes are ratios of Nyquist and, up the profile, dB.
Plot spectrumPlot(const SpectrumImage& image, SpectrumPanel panel);

}  // namespace pcl_fft_ground::cli

#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "pictures/axes.h"
#include "pictures/canvas.h"
#include "pictures/pictures.h"

namespace pcl_fft_ground::cli {

/// The page of a map: the plot, where its key (a colour bar or a legend) goes, and the size of the page
/// [pixels].
struct MapPage {
  Plot plot;
  Rectangle key;
  int width = 0;
  int height = 0;
  std::string frame;  ///< whose x and y axes the plot has
};

/// The page for a grid. The longest side of every map has one length, or more where its cells would be too
/// small to be seen; low maps have a lying colour bar below them, the others an upright one on the right. An
/// empty grid is laid out as a single cell.
MapPage layOutMap(const GridImage& image, MapKey key);

/// The page with the map's pixels, its axes in metres and its title; the key is yet to be drawn.
Canvas startMap(const MapPage& page, const std::string& title, const Pixels& map);

/// A map of classes in the light of the relief (see hillShade()), of equal size; classes below 0 are white.
Pixels shadedClasses(const Eigen::ArrayXXi& classes, const Eigen::ArrayXXd& light,
                     const std::function<Colour(int)>& colour_of);

/// A remark in the middle of a plot that has nothing to show.
void writeInMiddle(Canvas& canvas, const Plot& plot, const std::string& text);

struct LegendEntry {
  Colour colour;
  std::string text;
};

/// Coloured squares with their meaning in one row, in the middle of the page, `top` pixels down; shrunk where
/// the row is wider than the page.
void drawLegend(Canvas& canvas, double top, const std::vector<LegendEntry>& entries);

}  // namespace pcl_fft_ground::cli

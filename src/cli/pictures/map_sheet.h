#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "pictures/canvas.h"
#include "pictures/map_page.h"
#include "pictures/top_view.h"

namespace pcl_fft_ground::cli {

/// A page with several maps of one scan side by side, each with axes in metres, a name and a remark.
class MapSheet {
 public:
  /// \param view outlives the sheet
  /// \param maps how many there will be, at least 1
  /// \throws WorkError where there is no memory for the page
  MapSheet(const std::string& title, const TopView& view, int maps);

  /// Draws the next map. \param classes what to show in each cell, see TopView; -1 is white
  /// \param legend colour of each class
  void drawMap(const std::string& name, const std::string& remark, const Eigen::ArrayXXi& classes,
               const std::vector<LegendEntry>& legend);

  /// Leaves the next map empty, with a word in it that says why.
  void leaveEmpty(const std::string& name, const std::string& remark, const std::string& word);

  /// Draws the legend of all maps below them and writes the page.
  /// \throws WorkError naming the file
  void write(const std::filesystem::path& path, const std::vector<LegendEntry>& legend);

 private:
  /// How the maps are laid out on the page.
  struct Layout {
    Eigen::Vector2d map;  ///< size of a map [pixels]
    int columns;
    int rows;

    Eigen::Vector2d place() const;  ///< size of a map with its axes and texts [pixels]
    Eigen::Vector2d page() const;
    Rectangle area(int n) const;
  };

  static Layout layOut(const GridImage& image, int maps);
  Plot beginMap(const std::string& name, const std::string& remark);
  void drawAxes(const Plot& plot);

  const TopView& view_;
  Eigen::ArrayXXd light_;
  Layout layout_;
  Canvas canvas_;
  int drawn_ = 0;
};

}  // namespace pcl_fft_ground::cli

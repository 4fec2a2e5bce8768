#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace pcl_fft_ground::cli {

/// Points of the 3-D view that are shown or hidden together.
struct ViewLayer {
  std::string name;
  std::string colour;                   ///< "#rrggbb"
  std::vector<Eigen::Vector3f> points;  ///< [m], z up; such that are not finite are left out
  std::vector<int> groups;              ///< per point the number of its segment or sub-map, 0 none; or empty
  bool shown = true;                    ///< at first
};

/// A table; cells that are numbers stand to the right.
struct HtmlTable {
  std::string caption;
  std::vector<std::string> header;
  std::vector<std::vector<std::string>> rows;
};

/// A picture and what it shows.
struct HtmlPicture {
  std::string caption;
  std::string png;  ///< the bytes of the file
};

/// What a report shows, in this order.
struct HtmlPage {
  std::string title;
  std::vector<std::string> summary;  ///< a paragraph each
  std::vector<std::string> warnings;
  std::string view_caption;
  std::string groups = "segment";  ///< what a number of a group numbers
  std::vector<ViewLayer> layers;   ///< no view where none of them has a point
  std::vector<HtmlPicture> pictures;
  std::vector<HtmlTable> tables;
};

/// Most points that a view holds.
constexpr std::size_t MOST_VIEW_POINTS = 200000;

/// Which of `count` things are shown where no more than `most` can be: one of each of `most` equal parts of
/// the list, at a place of the part that depends on nothing but its number, so that a pattern of the list
/// leaves none in the view.
std::vector<std::size_t> thinnedIndices(std::size_t count, std::size_t most);

/// A table of records: objects of JSON with the same names, values that are no numbers or text as JSON.
HtmlTable tableOfRecords(const std::string& caption, const nlohmann::ordered_json& records);

/// A table of names and values: one row for each member of an object, with its parts after it where it is one
/// of `value`, `from` and `reason`.
HtmlTable tableOfParameters(const std::string& caption, const nlohmann::ordered_json& parameters);

/// A table of the comma-separated lines of a file of ours: its first `most` rows.
HtmlTable tableOfCsv(const std::string& caption, const std::string& csv, std::size_t most);

/** One self-contained page of HTML: nothing in it is fetched from anywhere. All text is escaped.
 *
 * Layers without points are left out. The view holds the points to a 65,535th of its largest side; the
 * thousandth part of the points that lies farthest out on either side of an axis does not decide on its box,
 * and what is beyond the box is left out.
 */
std::string htmlPage(HtmlPage page);

}  // namespace pcl_fft_ground::cli

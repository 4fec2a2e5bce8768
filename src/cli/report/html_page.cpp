#include "report/html_page.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <string_view>

#include "pcl_fft_ground/version.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

/// The page around {{TITLE}}, {{BODY}} and {{POINTS}}.
constexpr std::string_view PAGE =
#include "report/page.html"
    ;

/// Text as text: nothing in it is taken for markup.
std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      text += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return text;
}

bool isNumber(const std::string& text) {
  if (text.empty()) return true;
  std::istringstream stream(text);
  double value = 0;
  std::string rest;
  return stream >> value && !(stream >> rest && rest != "%");
}

/// A value as a reader wants it: six digits of a number, text without its quotes.
std::string shortText(const ordered_json& value) {
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "-";
  if (value.is_number_float()) {
    std::ostringstream text;
    text << std::setprecision(6) << value.get<double>();
    return text.str();
  }
  if (!value.is_array()) return value.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
  std::vector<std::string> words;
  for (const ordered_json& part : value) words.push_back(shortText(part));
  return joined(words, value.empty() || !value[0].is_array() ? " " : "; ");
}

std::string tableText(const HtmlTable& table) {
  constexpr std::size_t MANY_COLUMNS = 12;  // more do not fit on paper in letters of the usual size
  std::vector<bool> numeric(table.header.size(), true);
  for (const std::vector<std::string>& row : table.rows)
    for (std::size_t i = 0; i < numeric.size() && i < row.size(); ++i)
      numeric[i] = numeric[i] && (row[i] == "-" || isNumber(row[i]));
  const auto cell = [&](const char* tag, std::size_t i, const std::string& text) {
    const bool is_number = i < numeric.size() && numeric[i];
    return std::string("<") + tag + (is_number ? " class=\"number\">" : ">") + escaped(text) + "</" + tag +
           ">";
  };
  std::string text = std::string("<div class=\"wide") + (table.header.size() > MANY_COLUMNS ? " many" : "") +
                     "\"><table><caption>" + escaped(table.caption) + "</caption>\n<thead><tr>";
  for (std::size_t i = 0; i < table.header.size(); ++i) text += cell("th", i, table.header[i]);
  text += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i) text += cell("td", i, row[i]);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

/// The cube that the view shows.
struct ViewBox {
  Eigen::Vector3f low = Eigen::Vector3f::Zero();
  float side = 1;                                  ///< [m], > 0
  Eigen::Vector3f size = Eigen::Vector3f::Ones();  ///< of what is in it [m]
  std::array<float, 2> heights{0, 1};              ///< that take the ends of the colours, above low [m]
};

/// The value that a share of all is below, and the one that as many are above.
std::array<float, 2> quantiles(std::vector<float> values, double share) {
  const auto at = [&](std::size_t n) {
    std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(n), values.end());
    return values[n];
  };
  const std::size_t last = values.size() - 1;
  const auto below = static_cast<std::size_t>(share * static_cast<double>(last));
  return {at(below), at(last - below)};
}

ViewBox boxOf(const std::vector<ViewLayer>& layers) {
  constexpr double OUTER_SHARE = 0.001, COLOUR_SHARE = 0.02;
  constexpr float MARGIN = 0.1F;  // of the size, on each side
  ViewBox box;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    float lowest = std::numeric_limits<float>::infinity(), highest = -lowest;
    for (const ViewLayer& layer : layers)
      for (const Eigen::Vector3f& point : layer.points) {
        if (!point.allFinite()) continue;
        values.push_back(point[axis]);
        lowest = std::min(lowest, point[axis]);
        highest = std::max(highest, point[axis]);
      }
    if (values.empty()) return box;
    const auto [low, high] = quantiles(values, OUTER_SHARE);
    const float margin = MARGIN * (high - low);
    box.low[axis] = std::max(low - margin, lowest);
    box.size[axis] = std::min(high + margin, highest) - box.low[axis];
    if (axis != 2) continue;
    const auto [dark, bright] = quantiles(values, COLOUR_SHARE);
    box.heights = {dark - box.low[2], bright - box.low[2]};
  }
  box.side = std::max(box.size.maxCoeff(), std::numeric_limits<float>::min());
  return box;
}

/// Eight bytes for each point of a layer that lies in the box, as the page reads them.
std::string packedPoints(const ViewLayer& layer, const ViewBox& box) {
  constexpr float STEPS = 65535;
  constexpr int MOST_GROUPS = 65535;
  std::string bytes;
  const auto put = [&](long value) {
    bytes += static_cast<char>(value & 255);
    bytes += static_cast<char>(value >> 8 & 255);
  };
  for (std::size_t n = 0; n < layer.points.size(); ++n) {
    const Eigen::Array3f share = (layer.points[n] - box.low).array() / box.side;
    if (!(share >= 0).all() || !((layer.points[n] - box.low).array() <= box.size.array()).all()) continue;
    for (int axis = 0; axis < 3; ++axis) put(std::lround(share[axis] * STEPS));
    put(layer.groups.empty() ? 0 : std::clamp(layer.groups[n], 0, MOST_GROUPS));
  }
  return bytes;
}

ordered_json viewData(const HtmlPage& page) {
  constexpr float STEPS = 65535;
  const ViewBox box = boxOf(page.layers);
  ordered_json layers = ordered_json::array();
  std::size_t count = 0;
  for (const ViewLayer& layer : page.layers) {
    const std::string packed = packedPoints(layer, box);
    count += packed.size() / 8;
    layers.push_back({{"colour", layer.colour}, {"shown", layer.shown}, {"points", base64(packed)}});
  }
  const Eigen::Vector3f size = box.size / box.side * STEPS;
  // How far a point is from the next one, were all of them spread evenly over the plan.
  const double spacing =
      std::sqrt(size.x() * size.y() / static_cast<double>(std::max<std::size_t>(count, 1)));
  return {{"size", {size.x(), size.y(), size.z()}},
          {"span", {box.heights[0] / box.side * STEPS, box.heights[1] / box.side * STEPS}},
          {"spacing", spacing},
          {"layers", layers}};
}

std::string viewText(const HtmlPage& page) {
  std::string text = "<h2>In three dimensions</h2>\n<div class=\"tools\">";
  bool has_groups = false;
  for (std::size_t k = 0; k < page.layers.size(); ++k) {
    const ViewLayer& layer = page.layers[k];
    has_groups = has_groups || !layer.groups.empty();
    text += "<label><input type=\"checkbox\" data-layer=\"" + std::to_string(k) + "\"" +
            (layer.shown ? " checked" : "") +
            "><span class=\"swatch\" style=\"background:" + escaped(layer.colour) + "\"></span>" +
            escaped(layer.name) + "</label>";
  }
  text += "<label>colours <select id=\"colours\"><option value=\"0\">as listed</option>";
  if (has_groups) text += "<option value=\"1\">by " + escaped(page.groups) + "</option>";
  text +=
      "<option value=\"2\">by height</option></select></label>"
      "<button type=\"button\" id=\"home\">reset</button></div>\n"
      "<canvas id=\"view\" tabindex=\"0\" role=\"img\" aria-label=\"" +
      escaped(page.view_caption) +
      "\"></canvas>\n<p id=\"no-view\" hidden>This browser shows no WebGL, which the view needs.</p>\n"
      "<p class=\"faint\">" +
      escaped(page.view_caption) +
      " <span class=\"hint\">Drag to turn, wheel or two fingers to come closer, shift and drag to move; or "
      "the "
      "arrow keys, + and -.</span></p>\n";
  return text;
}

std::string bodyText(const HtmlPage& page, bool has_view) {
  std::string text = "<h1>" + escaped(page.title) + "</h1>\n";
  for (const std::string& paragraph : page.summary) text += "<p>" + escaped(paragraph) + "</p>\n";
  if (!page.warnings.empty()) {
    text += "<ul class=\"warnings\" aria-label=\"Warnings\">\n";
    for (const std::string& warning : page.warnings) text += "<li>Warning: " + escaped(warning) + "</li>\n";
    text += "</ul>\n";
  }
  if (has_view) text += viewText(page);
  if (!page.pictures.empty()) text += "<h2>Pictures</h2>\n<div class=\"pictures\">\n";
  for (const HtmlPicture& picture : page.pictures)
    text += "<figure><img alt=\"" + escaped(picture.caption) + "\" src=\"data:image/png;base64," +
            base64(picture.png) + "\"><figcaption>" + escaped(picture.caption) + "</figcaption></figure>\n";
  if (!page.pictures.empty()) text += "</div>\n";
  if (!page.tables.empty()) text += "<h2>Tables</h2>\n";
  for (const HtmlTable& table : page.tables) text += tableText(table);
  return text + "<p class=\"faint\">Made by pcl_fft_ground " + PCL_FFT_GROUND_VERSION + ".</p>";
}

}  // namespace

std::vector<std::size_t> thinnedIndices(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen(std::min(count, most));
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const auto start = [&](std::size_t part) {
      return static_cast<std::size_t>(static_cast<double>(part) * static_cast<double>(count) /
                                      static_cast<double>(chosen.size()));
    };
    std::uint64_t hash = (k + 1) * 0x9e3779b97f4a7c15U;
    hash = (hash ^ hash >> 30) * 0xbf58476d1ce4e5b9U;
    hash ^= hash >> 27;
    const std::size_t first = start(k), length = std::max<std::size_t>(start(k + 1) - first, 1);
    chosen[k] = first + static_cast<std::size_t>(hash % length);
  }
  return chosen;
}

HtmlTable tableOfRecords(const std::string& caption, const ordered_json& records) {
  HtmlTable table{caption, {}, {}};
  for (const ordered_json& record : records)
    for (const auto& [name, value] : record.items())
      if (std::find(table.header.begin(), table.header.end(), name) == table.header.end())
        table.header.push_back(name);
  for (const ordered_json& record : records) {
    std::vector<std::string> row;
    for (const std::string& name : table.header)
      row.push_back(record.contains(name) ? shortText(record[name]) : "");
    table.rows.push_back(row);
  }
  return table;
}

HtmlTable tableOfParameters(const std::string& caption, const ordered_json& parameters) {
  HtmlTable table{caption, {"name", "value", "from"}, {}};
  for (const auto& [name, parameter] : parameters.items()) {
    if (!parameter.is_object() || !parameter.contains("value")) {
      table.rows.push_back({name, shortText(parameter), ""});
      continue;
    }
    std::string from = parameter.value("from", "");
    if (parameter.contains("reason")) from += ": " + shortText(parameter["reason"]);
    table.rows.push_back({name, shortText(parameter["value"]), from});
  }
  const auto has_source = [](const std::vector<std::string>& row) { return !row[2].empty(); };
  if (std::any_of(table.rows.begin(), table.rows.end(), has_source)) return table;
  table.header.pop_back();
  for (std::vector<std::string>& row : table.rows) row.pop_back();
  return table;
}

HtmlTable tableOfCsv(const std::string& caption, const std::string& csv, std::size_t most) {
  HtmlTable table{caption, {}, {}};
  std::istringstream lines(csv);
  std::size_t count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    std::vector<std::string> cells;
    std::istringstream words(line);
    for (std::string word; std::getline(words, word, ',');) cells.push_back(word);
    cells.resize(std::max(cells.size(), table.header.size()));  // an empty one at the end
    if (count == 0)
      table.header = cells;
    else if (count <= most)
      table.rows.push_back(cells);
  }
  if (count > most + 1)
    table.caption += ": the first " + std::to_string(most) + " of " + std::to_string(count - 1);
  return table;
}

std::string htmlPage(HtmlPage page) {
  page.layers.erase(std::remove_if(page.layers.begin(), page.layers.end(),
                                   [](const ViewLayer& layer) { return layer.points.empty(); }),
                    page.layers.end());
  const bool has_view = !page.layers.empty();
  const std::string points = has_view ? viewData(page).dump() : "null";
  std::string text;
  std::string_view rest = PAGE;
  for (std::size_t at = rest.find("{{"); at != std::string_view::npos; at = rest.find("{{")) {
    const std::size_t end = rest.find("}}", at);
    const std::string_view name = rest.substr(at + 2, end - at - 2);
    text += rest.substr(0, at);
    text += name == "TITLE" ? escaped(page.title) : name == "BODY" ? bodyText(page, has_view) : points;
    rest.remove_prefix(end + 2);
  }
  text += rest;
  return text;
}

}  // namespace pcl_fft_ground::cli

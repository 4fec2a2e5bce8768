#include "report/html_page.h"

#include <gtest/gtest.h>

#include <limits>
#include <set>

namespace pcl_fft_ground::cli {
namespace {

using nlohmann::ordered_json;

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++count;
  return count;
}

/// What stands between the first `begin` and the next `end`.
std::string between(const std::string& text, const std::string& begin, const std::string& end) {
  const std::size_t from = text.find(begin) + begin.size();
  return text.substr(from, text.find(end, from) - from);
}

std::string decoded(const std::string& base64) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string bytes;
  std::uint32_t word = 0;
  int bits = 0;
  for (const char c : base64) {
    if (c == '=') break;
    word = word << 6 | static_cast<std::uint32_t>(digits.find(c));
    bits += 6;
    if (bits < 8) continue;
    bits -= 8;
    bytes += static_cast<char>(word >> bits & 255);
  }
  return bytes;
}

ordered_json viewOf(const std::string& html) {
  return ordered_json::parse(between(html, "<script type=\"application/json\" id=\"points\">", "</script>"));
}

HtmlPage pageWithBox() {
  HtmlPage page;
  page.title = "A box";
  page.layers = {
      {"ground", "#808080", {}, {}}, {"objects", "#0000ff", {}, {}}, {"nothing", "#ff0000", {}, {}}};
  for (int x = 0; x <= 20; ++x)
    for (int y = 0; y <= 10; ++y)
      page.layers[0].points.emplace_back(100.0F + static_cast<float>(x), static_cast<float>(y), 0.0F);
  for (int n = 0; n < 9; ++n) {
    page.layers[1].points.emplace_back(110.0F, 5.0F, 0.5F * static_cast<float>(n));
    page.layers[1].groups.push_back(n);
  }
  return page;
}

TEST(HtmlPage, TextStaysText) {
  HtmlPage page = pageWithBox();
  const std::string evil = "<script>alert(\"1\")</script> & {{BODY}}";
  page.title = page.view_caption = page.groups = page.layers[0].name = evil;
  page.summary = page.warnings = {evil};
  page.pictures = {{evil, "png"}};
  page.tables = {{evil, {evil}, {{evil}}}};
  const std::string html = htmlPage(page);
  EXPECT_EQ(html.find("<script>alert"), std::string::npos);
  EXPECT_EQ(countOf(html, "<script"), 2u);
  // Title twice, caption of the view twice, groups, layer, summary, warning, picture twice, three of the
  // table.
  EXPECT_EQ(countOf(html, "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt; &amp; {{BODY}}"), 13u);
}

TEST(HtmlPage, NothingIsFetched) {
  HtmlPage page = pageWithBox();
  page.pictures = {{"a picture", "\x89PNG"}};
  const std::string html = htmlPage(page);
  for (const char* const outside :
       {"http:", "https:", "src=\"//", "href=\"//", "@import", "fetch(", "XMLHttp"})
    EXPECT_EQ(html.find(outside), std::string::npos) << outside;
  EXPECT_NE(html.find("default-src 'none'"), std::string::npos);
  EXPECT_NE(html.find("src=\"data:image/png;base64,iVBORw==\""), std::string::npos);
}

TEST(HtmlPage, TheViewHoldsThePoints) {
  const HtmlPage page = pageWithBox();
  const ordered_json view = viewOf(htmlPage(page));
  ASSERT_EQ(view["layers"].size(), 2u) << "a layer without points is left out";
  for (std::size_t k = 0; k < 2; ++k) {
    const std::string bytes = decoded(view["layers"][k]["points"]);
    ASSERT_EQ(bytes.size(), 8 * page.layers[k].points.size());
    const auto number = [&](std::size_t at) {
      return static_cast<unsigned char>(bytes[at]) + 256 * static_cast<unsigned char>(bytes[at + 1]);
    };
    for (std::size_t n = 0; n < page.layers[k].points.size(); ++n) {
      // The box is 20 m wide: its corner is (100, 0, 0), a step 20 m / 65535.
      const Eigen::Vector3f share = (page.layers[k].points[n] - Eigen::Vector3f(100, 0, 0)) / 20;
      for (std::size_t axis = 0; axis < 3; ++axis)
        EXPECT_NEAR(number(8 * n + 2 * axis), 65535 * share[static_cast<int>(axis)], 0.51);
      EXPECT_EQ(number(8 * n + 6), k == 0 ? 0 : page.layers[k].groups[n]);
    }
  }
}

TEST(HtmlPage, FarPointsAndSuchThatAreNoneDoNotDecideOnTheBox) {
  HtmlPage page = pageWithBox();
  for (int n = 0; n < 2000; ++n)  // spread over the same rectangle
    page.layers[0].points.emplace_back(100.0F + static_cast<float>(n % 21), static_cast<float>(n % 11), 0.0F);
  const std::size_t count = page.layers[0].points.size();
  page.layers[0].points.emplace_back(1e7F, 0.0F, 0.0F);
  page.layers[0].points.emplace_back(110.0F, std::numeric_limits<float>::quiet_NaN(), 0.0F);
  const ordered_json view = viewOf(htmlPage(page));
  EXPECT_EQ(decoded(view["layers"][0]["points"]).size(), 8 * count);
  EXPECT_LT(view["size"][0].get<double>() / view["size"][1].get<double>(), 2.3)
      << "20 m and a margin to 10 m";
}

TEST(HtmlPage, WithoutPointsThereIsNoView) {
  HtmlPage page;
  page.title = "Nothing";
  const std::string html = htmlPage(page);
  EXPECT_EQ(html.find("<canvas"), std::string::npos);
  EXPECT_TRUE(viewOf(html).is_null());
}

TEST(HtmlPage, ThinningTakesOneOfEachPart) {
  EXPECT_TRUE(thinnedIndices(0, 10).empty());
  EXPECT_EQ(thinnedIndices(7, 10), (std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6}));
  const std::vector<std::size_t> some = thinnedIndices(1000, 100);
  ASSERT_EQ(some.size(), 100u);
  std::set<std::size_t> places;
  for (std::size_t k = 0; k < some.size(); ++k) {
    EXPECT_EQ(some[k] / 10, k);
    places.insert(some[k] % 10);
  }
  EXPECT_EQ(places.size(), 10u) << "at all places of the parts";
  EXPECT_EQ(some, thinnedIndices(1000, 100));
}

TEST(HtmlPage, TablesOfReports) {
  const ordered_json described{{"cell-size", {{"value", 0.02}, {"from", "data"}, {"reason", "why"}}},
                               {"name", "text"},
                               {"none", nullptr}};
  using Rows = std::vector<std::vector<std::string>>;
  EXPECT_EQ(tableOfParameters("p", described).rows,
            (Rows{{"cell-size", "0.02", "data: why"}, {"name", "text", ""}, {"none", "-", ""}}));
  EXPECT_EQ(tableOfParameters("p", {{"a", 1}}).rows, (Rows{{"a", "1"}})) << "without a column of nothing";
  const ordered_json rows = ordered_json::parse(R"([{"a": 1, "b": "x"}, {"a": 0.123456789, "c": [1, 2]}])");
  const HtmlTable records = tableOfRecords("r", rows);
  EXPECT_EQ(records.header, (std::vector<std::string>{"a", "b", "c"}));
  EXPECT_EQ(records.rows, (Rows{{"1", "x", ""}, {"0.123457", "", "1 2"}}));
  const HtmlTable csv = tableOfCsv("c", "a,b\n1,2\n3,\n5,6\n", 2);
  EXPECT_EQ(csv.caption, "c: the first 2 of 3");
  EXPECT_EQ(csv.rows, (Rows{{"1", "2"}, {"3", ""}}));
}

}  // namespace
}  // namespace pcl_fft_ground::cli

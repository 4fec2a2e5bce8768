#include "printable.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "command_fixture.h"
#include "report/report.h"

namespace pcl_fft_ground::cli {
namespace {

TEST(Printable, KeepsWhatCanBeRead) {
  for (const char* text :
       {"", "wreck.pcd", "C:\\scans\\a b.pcd", "Ærø.pcd", "海底.ply", "\xF0\x9F\x90\x9F.las", "'\"~"})
    EXPECT_EQ(printable(text), text);
}

TEST(Printable, EscapesWhatATerminalWouldObey) {
  EXPECT_EQ(printable("a\x1b[31mb"), "a\\x1b[31mb");
  EXPECT_EQ(printable(std::string("a\0b", 3)), "a\\x00b");
  EXPECT_EQ(printable("two\nlines\r\tand\x7f"), "two\\nlines\\r\\tand\\x7f");
  EXPECT_EQ(printable("\xC2\x9B"
                      "31m"),
            "\\u009b31m");  // CSI in one character
  EXPECT_EQ(printable("dcp.\xE2\x80\xAE"
                      "exe"),
            "dcp.\\u202eexe");  // what follows is shown from right to left
}

TEST(Printable, EscapesBytesThatAreNoUtf8) {
  EXPECT_EQ(printable("\xFF"), "\\xff");
  EXPECT_EQ(printable("a\xC3"), "a\\xc3");                           // cut off
  EXPECT_EQ(printable("\xC3("), "\\xc3(");                           // not continued
  EXPECT_EQ(printable("\xC0\xAF"), "\\xc0\\xaf");                    // longer than need be
  EXPECT_EQ(printable("\xE0\x9F\xBF"), "\\xe0\\x9f\\xbf");           // likewise
  EXPECT_EQ(printable("\xED\xA0\x80"), "\\xed\\xa0\\x80");           // half of a surrogate pair
  EXPECT_EQ(printable("\xF4\x90\x80\x80"), "\\xf4\\x90\\x80\\x80");  // beyond Unicode
}

TEST(Printable, AnyBytesAreOneLineWithoutControlCharactersAndEscapingAgainChangesNothing) {
  for (unsigned seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    std::mt19937 random(seed);
    std::string bytes(random() % 100, '\0');
    for (char& byte : bytes) byte = static_cast<char>(random());
    const std::string text = printable(bytes);
    for (const char c : text) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != '\x7f');
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, JsonHoldsNoControlCharacterEither) {
  const std::string name = "\x1b[2J\x7f\xC2\x9B\xC2\x80 \xC2\xA0\xC3\xA9";
  const std::string text = asText({{"input", name}});
  EXPECT_NE(text.find("\\u001b[2J\\u007f\\u009b\\u0080 \xC2\xA0\xC3\xA9"), std::string::npos) << text;
  EXPECT_EQ(nlohmann::ordered_json::parse(text)["input"], name);
  EXPECT_NO_THROW(asText({{"input", "\xFF"}}));  // no UTF-8, as names of files may be
}

/// Whatever a command prints about a file of any name, or of any bytes, is safe to show.
class HostileNames : public CommandFixture {
 protected:
  const std::string name_ = "a\x1b[31m\n\xFF\xC2\x9B.pcd";

  static void expectSafe(const std::string& text) {
    for (const char c : text)
      EXPECT_TRUE((static_cast<unsigned char>(c) >= 0x20 && c != '\x7f') || c == '\n') << text;
    EXPECT_EQ(text.find("\xC2\x9B"), std::string::npos) << text;
  }
};

TEST_F(HostileNames, AreNoHindrance) {
  const std::string scan = makeCloud(name_, boxScan());
  for (const char* how : {"--height", "--json"}) {
    const Printed printed = segment(scan, {how});
    EXPECT_FALSE(printed.out.empty());
    expectSafe(printed.out + printed.err);
  }
  const std::string other = makeCloud("b" + name_, boxScan());
  for (const Words& more : std::vector<Words>{{}, {"--json"}, {"--csv", pathOf("table\x1b.csv")}}) {
    Words words{scan,  other,        "--cell-size", "0.04",     "--max-object-size",
                "0.6", "--pictures", output(),      "--report", pathOf("\xFF.html")};
    words.insert(words.end(), more.begin(), more.end());
    const Printed printed = run(runEvaluate, words);
    EXPECT_FALSE(printed.out.empty());
    expectSafe(printed.out + printed.err);
  }
  const Printed simulated = run(runSimulate, {"wreck", "--points", "100", "-o", pathOf("made\x1b\xFF.pcd")});
  EXPECT_NE(simulated.out.find("made\\x1b\\xff.pcd"), std::string::npos) << simulated.out;
}

TEST_F(HostileNames, WarningsEscapeWhatAFileBrings) {
  const std::string bytes =
      "VERSION .7\nFIELDS x y z \x1b[31m\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 0\nWIDTH 4\nHEIGHT 1\n"
      "POINTS 4\nDATA ascii\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n";
  const Printed printed = segment(makeFile("zero.pcd", bytes));
  EXPECT_NE(printed.err.find("\\x1b[31m"), std::string::npos) << printed.err;
  expectSafe(printed.out + printed.err);
}

}  // namespace
}  // namespace pcl_fft_ground::cli

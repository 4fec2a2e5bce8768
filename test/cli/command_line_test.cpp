#include "command_line.h"

#include <gtest/gtest.h>

#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

namespace po = boost::program_options;
using Words = std::vector<std::string>;

po::variables_map parse(const Words& words) {
  po::options_description options;
  auto add = options.add_options();
  add("cell-size", po::value<double>());
  add("filter-order", po::value<long long>());
  add("up-direction", po::value<std::string>());
  add("output,o", po::value<std::string>());
  add("quiet", po::bool_switch());
  add("cloud", po::value<std::string>());
  po::positional_options_description positional;
  positional.add("cloud", 1);
  return parseArguments("segment", words, options, positional);
}

std::string refusalOf(const Words& words) {
  try {
    parse(words);
  } catch (const UsageError& error) {
    return error.what();
  }
  ADD_FAILURE() << "not refused";
  return {};
}

TEST(CommandLine, TakesValuesAsTheNextWordOrBehindAnEqualsSign) {
  for (const Words& words : {Words{"a.pcd", "--cell-size", "0.5", "-o", "out", "--quiet"},
                             Words{"--cell-size=0.5", "--quiet", "--output=out", "a.pcd"},
                             Words{"-oout", "--quiet", "--cell-size", "5e-1", "--", "a.pcd"}}) {
    const po::variables_map values = parse(words);
    EXPECT_EQ(values["cell-size"].as<double>(), 0.5);
    EXPECT_EQ(values["output"].as<std::string>(), "out");
    EXPECT_EQ(values["cloud"].as<std::string>(), "a.pcd");
    EXPECT_TRUE(values["quiet"].as<bool>());
  }
}

TEST(CommandLine, NegativeNumbersAreValuesNotOptions) {
  EXPECT_EQ(parse({"--cell-size", "-1.5"})["cell-size"].as<double>(), -1.5);
  EXPECT_EQ(parse({"--cell-size", "-.5"})["cell-size"].as<double>(), -0.5);
  EXPECT_EQ(parse({"--cell-size=-2e-3"})["cell-size"].as<double>(), -2e-3);
  EXPECT_EQ(parse({"--filter-order", "-3"})["filter-order"].as<long long>(), -3);
}

TEST(CommandLine, ADirectionTakesThreeWords) {
  const po::variables_map values = parse({"--up-direction", "0", "-0.5", "-1", "a.pcd"});
  EXPECT_EQ(values["up-direction"].as<std::string>(), "0 -0.5 -1");
  EXPECT_EQ(values["cloud"].as<std::string>(), "a.pcd");
  EXPECT_EQ(parse({"--up-direction=0 0 -1"})["up-direction"].as<std::string>(), "0 0 -1");
  EXPECT_NE(refusalOf({"--up-direction", "0", "1"}).find("three numbers"), std::string::npos);
  EXPECT_NE(refusalOf({"--up-direction"}).find("three numbers"), std::string::npos);
}

TEST(CommandLine, NamesAndBlanksPassUnchanged) {
  EXPECT_EQ(parse({"-o", "two words"})["output"].as<std::string>(), "two words");
  EXPECT_EQ(parse({"H\xc3\xb6he \xe6\xb5\xb7.pcd"})["cloud"].as<std::string>(),
            "H\xc3\xb6he \xe6\xb5\xb7.pcd");
}

/// Words that are refused, and what the message has to name.
struct Refused {
  Words words;
  Words named;
};

class CommandLineRefuses : public ::testing::TestWithParam<Refused> {};

TEST_P(CommandLineRefuses, InOneLineThatNamesTheWord) {
  const std::string message = refusalOf(GetParam().words);
  EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  for (const std::string& name : GetParam().named)
    EXPECT_NE(message.find(name), std::string::npos) << message;
}

INSTANTIATE_TEST_SUITE_P(
    CommandLine, CommandLineRefuses,
    ::testing::Values(
        Refused{{"--cel-size", "1"}, {"--cel-size"}}, Refused{{"--cell", "1"}, {"--cell"}},
        Refused{{"-c", "1"}, {"-c"}}, Refused{{"--cell-size"}, {"--cell-size", "missing"}},
        Refused{{"-o"}, {"--output", "missing"}},
        Refused{{"--cell-size", "1", "--cell-size", "2"}, {"--cell-size", "more than once"}},
        Refused{{"--quiet", "--quiet"}, {"--quiet", "more than once"}}, Refused{{"--quiet=yes"}, {"--quiet"}},
        Refused{{"a.pcd", "b.pcd"}, {"too many", "quotes"}},
        Refused{{"--cell-size", "0,02"}, {"--cell-size", "0,02", "allowed is a number"}},
        Refused{{"--cell-size", "1m"}, {"--cell-size", "1m", "allowed is a number"}},
        Refused{{"--filter-order", "1.5"}, {"--filter-order", "1.5", "allowed is a whole number"}},
        Refused{{"--filter-order", "99999999999999999999"}, {"--filter-order", "whole number"}}));

}  // namespace
}  // namespace pcl_fft_ground::cli

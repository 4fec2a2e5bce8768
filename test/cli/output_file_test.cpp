#include "io/output_file.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <stdexcept>

#include "errors.h"
#include "temporary_folder.h"

namespace pcl_fft_ground::cli {
namespace {

using OutputFile = TemporaryFolder;

/// The message of the WorkError that `work` must throw.
template <typename Work>
std::string messageOf(const Work& work) {
  try {
    work();
  } catch (const WorkError& error) {
    return error.what();
  }
  ADD_FAILURE() << "no WorkError was thrown";
  return {};
}

TEST_F(OutputFile, WritesTheBytesAndLeavesNothingElse) {
  const std::string content("two\nlines\0and a zero", 20);
  writeText(pathOf("a.txt"), content);
  EXPECT_EQ(contentOf(pathOf("a.txt")), content);
  EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
}

TEST_F(OutputFile, ReplacesAnOlderFile) {
  makeFile("a.txt", "a much longer older content");
  writeText(pathOf("a.txt"), "new");
  EXPECT_EQ(contentOf(pathOf("a.txt")), "new");
  EXPECT_EQ(names().size(), 1u);
}

TEST_F(OutputFile, WritesBesideTheTargetUnderAHiddenName) {
  writeWhole(pathOf("a.png"), [&](const std::string& temporary) {
    EXPECT_EQ(std::filesystem::path(temporary).parent_path(), folder_);
    EXPECT_EQ(std::filesystem::path(temporary).filename().string().front(), '.');
    EXPECT_FALSE(std::filesystem::exists(pathOf("a.png")));
    std::ofstream(temporary) << "picture";
  });
  EXPECT_EQ(contentOf(pathOf("a.png")), "picture");
}

TEST_F(OutputFile, AFailureKeepsTheOldFileAndRemovesTheTemporary) {
  makeFile("a.txt", "old");
  const auto message = messageOf([&] {
    writeWhole(pathOf("a.txt"), [](const std::string& temporary) {
      std::ofstream(temporary) << "half";
      throw std::runtime_error("the picture is too large");
    });
  });
  EXPECT_NE(message.find(pathOf("a.txt")), std::string::npos) << message;
  EXPECT_NE(message.find("the picture is too large"), std::string::npos) << message;
  EXPECT_EQ(contentOf(pathOf("a.txt")), "old");
  EXPECT_EQ(names(), std::vector<std::string>{"a.txt"});
}

TEST_F(OutputFile, AnUnknownExceptionPassesAndRemovesTheTemporary) {
  const auto write = [](const std::string& temporary) {
    std::ofstream(temporary) << "half";
    throw 7;
  };
  EXPECT_THROW(writeWhole(pathOf("a.txt"), write), int);
  EXPECT_TRUE(names().empty());
}

TEST_F(OutputFile, NothingMadeIsAnError) {
  const auto message = messageOf([&] { writeWhole(pathOf("a.txt"), [](const std::string&) {}); });
  EXPECT_NE(message.find(pathOf("a.txt")), std::string::npos) << message;
}

TEST_F(OutputFile, RefusesTargetsThatAreNoPlaceForAFile) {
  makeFile("file", "x");
  std::filesystem::create_directory(folder_ / "folder");
  for (const std::string& path : {pathOf("missing/a.txt"), pathOf("file/a.txt"), pathOf("folder"),
                                  pathOf("folder/"), std::string("/dev/null"), std::string()}) {
    const auto message = messageOf([&] { writeText(path, "x"); });
    EXPECT_NE(message.find("'" + path + "'"), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  EXPECT_EQ(names().size(), 2u);
}

TEST_F(OutputFile, AFileThatCannotBeCompletedIsAnErrorAndGoes) {
  rlimit old_limit{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &old_limit), 0);
  const rlimit small_limit{1000, old_limit.rlim_max};  // as a full disk does, it makes writing fail half way
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  setrlimit(RLIMIT_FSIZE, &small_limit);
  const auto message = messageOf([&] { writeText(pathOf("a.txt"), std::string(1000000, 'x')); });
  setrlimit(RLIMIT_FSIZE, &old_limit);
  std::signal(SIGXFSZ, old_handler);
  EXPECT_NE(message.find(pathOf("a.txt")), std::string::npos) << message;
  EXPECT_TRUE(names().empty());
}

TEST_F(OutputFile, AFolderThatMayNotBeWrittenIsAnError) {
  if (geteuid() == 0) GTEST_SKIP() << "root may write everywhere";
  std::filesystem::permissions(folder_,
                               std::filesystem::perms::owner_read | std::filesystem::perms::owner_exec);
  const auto message = messageOf([&] { writeText(pathOf("a.txt"), "x"); });
  std::filesystem::permissions(folder_, std::filesystem::perms::owner_all);
  EXPECT_NE(message.find(pathOf("a.txt")), std::string::npos) << message;
}

TEST_F(OutputFile, MakesFoldersAndAcceptsOnesThatExist) {
  makeDirectory(pathOf("a/b/c"));
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "a" / "b" / "c"));
  makeFile("a/kept.txt", "kept");
  makeDirectory(pathOf("a"));
  EXPECT_EQ(contentOf(pathOf("a/kept.txt")), "kept");
  makeDirectory(pathOf("with_slash/"));
  EXPECT_TRUE(std::filesystem::is_directory(folder_ / "with_slash"));
}

TEST_F(OutputFile, AFileInTheWayOfAFolderIsAnError) {
  makeFile("file", "x");
  for (const std::string& path : {pathOf("file"), pathOf("file/below"), std::string()}) {
    const auto message = messageOf([&] { makeDirectory(path); });
    EXPECT_NE(message.find("'" + path + "'"), std::string::npos) << message;
  }
  EXPECT_EQ(contentOf(pathOf("file")), "x");
}

TEST_F(OutputFile, AFolderIsOneRunsAtATime) {
  {
    const OutputFolder first(pathOf("results"));
    const auto message = messageOf([&] { OutputFolder(pathOf("results/../results")); });
    EXPECT_NE(message.find("another run is writing to the folder"), std::string::npos) << message;
    EXPECT_NE(message.find(pathOf("results/../results")), std::string::npos) << message;
    const OutputFolder other(pathOf("results/inside"));
  }
  EXPECT_NO_THROW(OutputFolder(pathOf("results")));
  EXPECT_EQ(names(), std::vector<std::string>{"results"});
}

TEST_F(OutputFile, AFolderIsUsedTogetherOrAlone) {
  const OutputFolder first(pathOf("results"), FolderUse::TOGETHER);
  EXPECT_NO_THROW(OutputFolder(pathOf("results"), FolderUse::TOGETHER));
  EXPECT_NE(messageOf([&] { OutputFolder(pathOf("results")); }).find("another run"), std::string::npos);
}

TEST_F(OutputFile, AFolderThatCannotBeMadeIsNoOutputFolder) {
  makeFile("file", "x");
  EXPECT_NE(messageOf([&] { OutputFolder(pathOf("file")); }).find("it is a file"), std::string::npos);
}

TEST_F(OutputFile, WhatAKilledRunLeftHalfWrittenGoesWithTheNextRun) {
  const pid_t killed = fork();
  if (killed == 0) {
    try {
      writeWhole(pathOf("a.pcd"), [](const std::string& temporary) {
        std::ofstream(temporary) << "half";
        raise(SIGKILL);
      });
    } catch (...) {
    }
    _exit(0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(killed, &status, 0), killed);
  ASSERT_TRUE(WIFSIGNALED(status));
  ASSERT_EQ(names().size(), 1u);
  const std::string of_a_living_process = ".b.pcd." + std::to_string(getppid()) + ".part";
  for (const std::string& name : {of_a_living_process, std::string(".part"), std::string(".x.part"),
                                  std::string("c.9999999.part"), std::string(".d.-5.part")})
    makeFile(name, "not ours to remove");
  const OutputFolder folder(folder_.string());
  EXPECT_EQ(names().size(), 5u);
  EXPECT_TRUE(std::filesystem::exists(pathOf(of_a_living_process)));
}

}  // namespace
}  // namespace pcl_fft_ground::cli

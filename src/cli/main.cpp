#include <pcl/console/print.h>

#include <algorithm>
#include <csignal>
#include <exception>
#include <iostream>
#include <new>
#include <string>
#include <vector>

#include "commands/commands.h"
#include "errors.h"
#include "pcl_fft_ground/version.h"
#include "printable.h"

namespace {

constexpr const char* HELP = R"(Usage: pcl_fft_ground COMMAND ...

Takes the ground out of 3D scans in the frequency domain.

Commands:
  segment  CLOUD -o DIR              split a scan into ground, objects and segments
  evaluate CLOUD...                  compare methods on labelled scans
  simulate wreck|pipes|reef -o FILE  make a labelled scan of the sea floor
  simulate survey wreck|pipes -o DIR make the overlapping sub-maps of a survey, with true poses
  align    REFERENCE MOVING -o DIR   align two overlapping scans by their segments
  survey   FOLDER... -o DIR          align all sub-maps of surveys and map the sites

`pcl_fft_ground COMMAND --help` explains a command. Also: --help, --version.

Try it:
  pcl_fft_ground simulate wreck -o wreck.pcd
  pcl_fft_ground segment wreck.pcd -o result --max-object-size 1
)";

int run(const std::vector<std::string>& words) {
  using namespace pcl_fft_ground::cli;
  const std::string command = words.empty() ? "" : words.front();
  const std::vector<std::string> arguments(words.begin() + std::min<std::ptrdiff_t>(1, words.size()),
                                           words.end());
  if (command == "segment") {
    runSegment(arguments);
  } else if (command == "evaluate") {
    runEvaluate(arguments);
  } else if (command == "simulate") {
    runSimulate(arguments);
  } else if (command == "align") {
    runAlign(arguments);
  } else if (command == "survey") {
    runSurvey(arguments);
  } else if (command == "--help" || command == "-h" || command == "help") {
    std::cout << HELP;
  } else if (command == "--version") {
    std::cout << "pcl_fft_ground " << PCL_FFT_GROUND_VERSION << '\n';
  } else {
    throw UsageError(
        (command.empty() ? "no command given" : "command '" + command + "'") +
        std::string(": allowed is segment, evaluate, simulate, align or survey; see pcl_fft_ground --help"));
  }
  if (!std::cout.flush()) throw WorkError("cannot write to the standard output");
  return 0;
}

int report(const std::string& message, int status) {
  pcl_fft_ground::cli::printFault(message);
  return status;
}

}  // namespace

int main(int argc, char** argv) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  std::signal(SIGXFSZ, SIG_IGN);  // a file beyond the limit of its size is an error like a full disk
  try {
    return run({argv + 1, argv + argc});
  } catch (const pcl_fft_ground::cli::UsageError& error) {
    return report(error.what(), 2);
  } catch (const std::bad_alloc&) {
    return report("not enough memory for this work", 1);
  } catch (const std::exception& error) {
    return report(error.what(), 1);
  }
}

// Any bytes against what is promised of them, a target for each kind of input.
//
//   fuzz_tests --target=NAME [OPTION OF LIBFUZZER...] [FOLDER...]   built by Clang with libFuzzer, see the
//   preset fuzz fuzz_tests NAME FOLDER RUNS                                     otherwise: the files of a
//   folder, and RUNS changes
//                                                                   of them by a fixed seed

#include "fuzz.h"

#include <pcl/console/print.h>
#include <unistd.h>

#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>

namespace pcl_fft_ground::fuzz {
namespace {

Target chosen;

void choose(const std::string& name) {
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  std::vector<Target> targets = readerTargets();
  for (const Target& target : scanTargets()) targets.push_back(target);
  for (const Target& target : targets)
    if (target.name == name) chosen = target;
  if (chosen.promise != nullptr) return;
  std::cerr << "No target '" << name << "'. There are:";
  for (const Target& target : targets) std::cerr << ' ' << target.name;
  std::cerr << '\n';
  std::exit(2);
}

}  // namespace
}  // namespace pcl_fft_ground::fuzz

#ifdef PCL_FFT_GROUND_LIBFUZZER

extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  const std::string option = "--target=";
  std::string name;
  for (int n = 1; n < *count; ++n)
    if (std::string((*words)[n]).rfind(option, 0) == 0) name = (*words)[n] + option.size();
  pcl_fft_ground::fuzz::choose(name);
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  pcl_fft_ground::fuzz::chosen.promise(
      pcl_fft_ground::fuzz::Bytes({reinterpret_cast<const char*>(data), size}));
  return 0;
}

#else

namespace {

using Random = std::mt19937;

std::vector<std::string> filesOf(const std::string& folder) {
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) paths.push_back(entry.path());
  std::sort(paths.begin(), paths.end());
  std::vector<std::string> files;
  for (const auto& path : paths) {
    std::ifstream stream(path, std::ios::binary);
    files.emplace_back(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  }
  return files;
}

/// A place in the bytes, its end included.
std::size_t place(const std::string& bytes, Random& random) {
  return random() % (bytes.size() + 1);
}

/// A file with one to eight changes: bits and bytes, pieces of this file and of others, its end cut off.
std::string changed(std::string bytes, const std::vector<std::string>& files, Random& random) {
  constexpr std::string_view NASTY = "0919-+.,;: \n\"'#exn\x1b\x80\xff";
  for (unsigned changes = 1 + random() % 8; changes > 0; --changes) {
    const std::size_t at = place(bytes, random), length = random() % 16;
    const std::string& other = files[random() % files.size()];
    switch (random() % 7) {
      case 0:
        if (at < bytes.size()) bytes[at] = static_cast<char>(bytes[at] ^ (1U << random() % 8));
        break;
      case 1:
        bytes.replace(at, 1, 1, static_cast<char>(random()));
        break;
      case 2:
        bytes.replace(at, random() % 2, 1, NASTY[random() % NASTY.size()]);
        break;
      case 3:
        bytes.replace(at, length, length, random() % 2 == 0 ? '\0' : '\xff');
        break;
      case 4:
        bytes.erase(at, length);
        break;
      case 5:
        bytes.insert(at, other, place(other, random), 4 * length);
        break;
      default:
        if (random() % 8 == 0) bytes.resize(at);
    }
  }
  return bytes;
}

std::string current;  ///< what is being tried, for the message of a crash

[[noreturn]] void tellAndAbort() {
  std::cerr << "The promise is broken by " << current << '\n';
  if (const std::exception_ptr error = std::current_exception()) {
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& e) {
      std::cerr << e.what() << '\n';
    }
  }
  std::abort();
}

}  // namespace

int main(int count, char** words) {
  if (count != 4) {
    std::cerr << "Usage: fuzz_tests NAME FOLDER RUNS\n";
    return 2;
  }
  using namespace pcl_fft_ground::fuzz;
  choose(words[1]);
  const std::vector<std::string> files = filesOf(words[2]);
  if (files.empty()) {
    std::cerr << "No files in " << words[2] << '\n';
    return 2;
  }
  std::set_terminate(tellAndAbort);
  for (std::size_t n = 0; n < files.size(); ++n) {
    current = "file " + std::to_string(n) + " in the order of the names";
    chosen.promise(Bytes(files[n]));
  }
  const unsigned long runs = std::strtoul(words[3], nullptr, 10);
  for (unsigned run = 0; run < runs; ++run) {
    current = "change " + std::to_string(run);
    Random random(run);
    const std::string& file = files[random() % files.size()];
    chosen.promise(Bytes(changed(file, files, random)));
  }
  std::cout << files.size() << " files and " << runs << " changes of them: as promised\n";
  return 0;
}

#endif

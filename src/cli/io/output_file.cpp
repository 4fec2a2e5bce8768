#include "io/output_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <vector>

#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const std::string& path, const std::string& reason) {
  throw WorkError("cannot write '" + path + "': " + reason);
}

/// Refuses a target that a new file could not, or should not, take the place of (a folder, a device).
void checkTarget(const std::string& path) {
  std::error_code error;
  const fs::path folder = fs::path(path).parent_path();
  if (fs::path(path).filename().empty()) fail(path, "it names no file");
  if (!folder.empty() && !fs::is_directory(folder, error)) fail(path, "its folder does not exist");
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) fail(path, "it is a folder");
  if (fs::exists(status) && !fs::is_regular_file(status)) fail(path, "it is not a regular file");
}

constexpr std::string_view PART = ".part";

/// The process that writes, or wrote, a temporary file ".NAME.PROCESS.part"; nothing for any other name.
std::optional<pid_t> writerOf(std::string_view name) {
  if (name.size() <= PART.size() || name.front() != '.' || name.substr(name.size() - PART.size()) != PART)
    return std::nullopt;
  name.remove_suffix(PART.size());
  const std::string_view number = name.substr(name.rfind('.') + 1);
  pid_t process = 0;
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), process);
  if (error != std::errc() || end != number.data() + number.size() || process <= 0) return std::nullopt;
  return process;
}

/// Removes the temporary files of processes that are no more.
void removeLeftovers(const fs::path& folder) {
  std::error_code ignored;
  std::vector<fs::path> leftovers;
  for (fs::directory_iterator entry(folder, ignored), end; !ignored && entry != end;
       entry.increment(ignored)) {
    const std::optional<pid_t> writer = writerOf(entry->path().filename().string());
    if (writer && kill(*writer, 0) != 0 && errno == ESRCH) leftovers.push_back(entry->path());
  }
  for (const fs::path& leftover : leftovers) fs::remove(leftover, ignored);
}

/// A path that is removed at the end of the scope, if it is still there.
class TemporaryFile {
 public:
  explicit TemporaryFile(const fs::path& target)
      : path_(target.parent_path() /
              ("." + target.filename().string() + "." + std::to_string(getpid()) + std::string(PART))) {}
  ~TemporaryFile() {
    std::error_code ignored;
    fs::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

}  // namespace

void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  checkTarget(path);
  const TemporaryFile temporary(path);
  try {
    write(temporary.path().string());
  } catch (const std::exception& error) {
    fail(path, error.what());
  }
  std::error_code error;
  if (!fs::is_regular_file(temporary.path(), error)) fail(path, "the file was not made");
  fs::rename(temporary.path(), path, error);
  if (error) fail(path, error.message());
}

std::string fileBytes(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::string bytes{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (!stream.is_open() || stream.bad()) throw WorkError("cannot read '" + path + "'");
  return bytes;
}

std::string writtenBytes(const std::string& path,
                         const std::function<void(const std::string& temporary)>& write) {
  const TemporaryFile temporary(path);
  write(temporary.path().string());
  return fileBytes(temporary.path().string());
}

void writeText(const std::string& path, std::string_view content) {
  writeWhole(path, [&](const std::string& temporary) {
    errno = 0;
    std::ofstream stream(temporary, std::ios::binary);
    stream.write(content.data(), static_cast<std::streamsize>(content.size()));
    stream.close();
    if (!stream) throw WorkError(errno != 0 ? std::strerror(errno) : "writing failed");
  });
}

void makeDirectory(const std::string& path) {
  std::error_code error;
  if (fs::is_directory(path, error)) return;
  const bool is_file = fs::exists(path, error);
  if (!is_file) fs::create_directories(path, error);
  if (is_file || error) {
    throw WorkError("cannot make the folder '" + path + "': " + (is_file ? "it is a file" : error.message()));
  }
}

OutputFolder::OutputFolder(const std::string& path, FolderUse use) {
  makeDirectory(path);
  descriptor_ = open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor_ >= 0 && flock(descriptor_, (use == FolderUse::ALONE ? LOCK_EX : LOCK_SH) | LOCK_NB) != 0 &&
      errno == EWOULDBLOCK) {
    close(descriptor_);
    throw WorkError("another run is writing to the folder '" + path + "'");
  }
  if (use == FolderUse::ALONE) removeLeftovers(path);
}

OutputFolder::~OutputFolder() {
  if (descriptor_ >= 0) close(descriptor_);
}

}  // namespace pcl_fft_ground::cli

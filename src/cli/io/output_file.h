#pragma once

#include <functional>
#include <string>
#include <string_view>

namespace pcl_fft_ground::cli {

/// Lets `write` make a file at a temporary path, in the same folder under a hidden name, and gives it its
/// real name when it is complete: so a file appears whole or not at all, and an older one stays until then.
/// The temporary file is removed if anything fails.
/// \param path  a new file or a regular one, in a folder that exists
/// \throws WorkError naming `path` and the reason, whatever `write` threw
void writeWhole(const std::string& path, const std::function<void(const std::string& temporary)>& write);

/// The bytes that `write` puts into a file of its own at a temporary path in the folder of `path`, removed
/// again. \throws what `write` throws, and WorkError naming `path` if there is no file
std::string writtenBytes(const std::string& path,
                         const std::function<void(const std::string& temporary)>& write);

/// The bytes of a file. \throws WorkError naming it
std::string fileBytes(const std::string& path);

/// Writes these bytes as a file, whole or not at all.
/// \throws WorkError naming the file
void writeText(const std::string& path, std::string_view content);

/// Makes a folder and those above it, as far as they are missing.
/// \throws WorkError naming the folder, for one if `path` or a part of it is a file
void makeDirectory(const std::string& path);

/// Whether a run wants a folder of results for itself.
enum class FolderUse {
  ALONE,     ///< no other run may use it
  TOGETHER,  ///< others may that use it together, too, such as the shards of a survey
};

/// The folder that a run writes its results to, and no other run while this object lives: so what lies there
/// at the end comes from one run. The lock goes with the process, however it ends. Where the system cannot
/// lock a folder (some network file systems, a folder that may not be listed) there is none.
class OutputFolder {
 public:
  /// Makes the folder if need be. A run alone removes what runs that were killed left half-written in it.
  /// \throws WorkError naming the folder, also if another run writes to it
  explicit OutputFolder(const std::string& path, FolderUse use = FolderUse::ALONE);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

 private:
  int descriptor_;
};

}  // namespace pcl_fft_ground::cli

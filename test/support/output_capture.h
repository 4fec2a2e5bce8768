#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

namespace pcl_fft_ground::test {

/// Collects what is written to a stream's file descriptor (by PCL's console, say) while the object lives.
class StreamCapture {
 public:
  /// \param stream stdout or stderr
  explicit StreamCapture(std::FILE* stream)
      : stream_(stream), file_(std::tmpfile()), original_(flushedCopy(stream)) {
    dup2(fileno(file_), fileno(stream_));
  }
  StreamCapture(const StreamCapture&) = delete;
  StreamCapture& operator=(const StreamCapture&) = delete;
  ~StreamCapture() {
    std::fflush(stream_);
    dup2(original_, fileno(stream_));
    close(original_);
    std::fclose(file_);
  }

  /// What has been written so far.
  std::string text() const {
    std::fflush(stream_);
    std::string content(static_cast<std::size_t>(lseek(fileno(file_), 0, SEEK_END)), '\0');
    const ssize_t count = pread(fileno(file_), content.data(), content.size(), 0);
    content.resize(static_cast<std::size_t>(count < 0 ? 0 : count));
    return content;
  }

 private:
  static int flushedCopy(std::FILE* stream) {
    std::fflush(stream);
    return dup(fileno(stream));
  }

  std::FILE* stream_;
  std::FILE* file_;
  int original_;
};

/// Collects both streams.
struct OutputCapture {
  StreamCapture standard_output{stdout};
  StreamCapture standard_error{stderr};
};

}  // namespace pcl_fft_ground::test

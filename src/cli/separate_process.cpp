#include "separate_process.h"

#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <limits>
#include <system_error>

#include "errors.h"

namespace pcl_fft_ground::cli {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int REFUSED_STATUS = 2;

/** Reads what another process writes to a pipe, until it closes it or the time is up.
 * \return false where the time was up
 */
bool readUntil(int pipe, std::optional<Clock::time_point> deadline, std::string& bytes) {
  constexpr std::chrono::milliseconds::rep LONGEST = 1000000;
  std::array<char, 65536> block{};
  while (true) {
    const auto left =
        deadline ? std::chrono::ceil<std::chrono::milliseconds>(*deadline - Clock::now()).count() : LONGEST;
    if (left <= 0) return false;
    pollfd waiting{pipe, POLLIN, 0};
    const int ready = poll(&waiting, 1, static_cast<int>(std::min(left, LONGEST)));
    if (ready <= 0) continue;
    const ssize_t count = read(pipe, block.data(), block.size());
    if (count == 0) return true;
    if (count > 0) bytes.append(block.data(), static_cast<std::size_t>(count));
  }
}

/// Writes it all; the end of a process that cannot says enough.
void writeWhole(int pipe, const std::string& bytes) {
  for (std::size_t written = 0; written < bytes.size();) {
    const ssize_t count = write(pipe, bytes.data() + written, bytes.size() - written);
    if (count <= 0) _exit(1);
    written += static_cast<std::size_t>(count);
  }
}

/// What the other process does.
[[noreturn]] void runAndWrite(const std::function<std::string()>& function, int pipe) {
  try {
    writeWhole(pipe, function());
    _exit(0);
  } catch (const WorkError& error) {
    writeWhole(pipe, error.what());
    _exit(REFUSED_STATUS);
  } catch (...) {
    _exit(1);
  }
}

}  // namespace

Outcome runApart(const std::function<std::string()>& function, std::optional<double> time_limit) {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
  const pid_t parent = getpid();
  const pid_t child = fork();
  if (child < 0) throw std::system_error(errno, std::generic_category(), "fork");
  if (child == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    if (getppid() != parent) _exit(1);
    runAndWrite(function, ends[1]);
  }
  close(ends[1]);
  std::optional<Clock::time_point> deadline;
  if (time_limit)
    deadline = Clock::now() +
               std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(*time_limit));
  Outcome outcome;
  const bool ended = readUntil(ends[0], deadline, outcome.bytes);
  close(ends[0]);
  if (!ended) kill(child, SIGKILL);
  int status = 0;
  while (waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (!ended) {
    outcome.end = End::OUT_OF_TIME;
  } else if (WIFSIGNALED(status)) {
    outcome.end = End::CRASHED;
    outcome.signal = WTERMSIG(status);
  } else if (WEXITSTATUS(status) != 0) {
    outcome.end = WEXITSTATUS(status) == REFUSED_STATUS ? End::REFUSED : End::OUT_OF_MEMORY;
  }
  return outcome;
}

}  // namespace pcl_fft_ground::cli

#include "pcl_fft_ground/core/scan/threads.h"

#ifndef PCL_FFT_GROUND_WITHOUT_THREADS
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <utility>
#include <vector>
#endif

namespace pcl_fft_ground::core {

#ifdef PCL_FFT_GROUND_WITHOUT_THREADS

class Threads::Pool {};

Threads::Threads(unsigned) : outer_(nullptr) {}
Threads::~Threads() = default;

void forEachPart(Eigen::Index parts, const std::function<void(Eigen::Index)>& work) {
  for (Eigen::Index part = 0; part < parts; ++part) work(part);
}

#else

/// Threads that wait for work; the one that brings it does its share.
class Threads::Pool {
 public:
  explicit Pool(unsigned number) : number_(number) {}
  ~Pool() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      is_over_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
  }

  void run(Eigen::Index parts, const std::function<void(Eigen::Index)>& work) {
    start();
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      work_ = &work;
      parts_ = parts;
      next_ = 0;
      busy_ = threads_.size();
      ++round_;
    }
    wake_.notify_all();
    takeParts();
    std::unique_lock<std::mutex> lock(mutex_);
    done_.wait(lock, [&] { return busy_ == 0; });
    if (problem_) std::rethrow_exception(std::exchange(problem_, nullptr));
  }

  /// The pool of the thread that asks; none within the work itself.
  static Pool*& current() {
    thread_local Pool* pool = nullptr;
    return pool;
  }

 private:
  void start() {
    if (!threads_.empty()) return;
    try {
      while (threads_.size() + 1 < number_) threads_.emplace_back([this] { serve(); });
    } catch (const std::system_error&) {
      number_ = static_cast<unsigned>(threads_.size() + 1);  // the system gives no more
    }
  }

  void serve() {
    unsigned seen = 0;
    while (true) {
      {
        std::unique_lock<std::mutex> lock(mutex_);
        wake_.wait(lock, [&] { return is_over_ || round_ != seen; });
        if (is_over_) return;
        seen = round_;
      }
      takeParts();
      const std::lock_guard<std::mutex> lock(mutex_);
      if (--busy_ == 0) done_.notify_one();
    }
  }

  void takeParts() {
    Pool* const outer = std::exchange(current(), nullptr);
    for (Eigen::Index part = next_++; part < parts_; part = next_++) {
      try {
        (*work_)(part);
      } catch (...) {
        const std::lock_guard<std::mutex> lock(mutex_);
        if (!problem_) problem_ = std::current_exception();
        next_ = parts_;
      }
    }
    current() = outer;
  }

  unsigned number_;
  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  const std::function<void(Eigen::Index)>* work_ = nullptr;
  Eigen::Index parts_ = 0;
  std::atomic<Eigen::Index> next_{0};
  std::size_t busy_ = 0;  // threads that have not finished this round
  unsigned round_ = 0;
  bool is_over_ = false;
  std::exception_ptr problem_;
};

Threads::Threads(unsigned number) : outer_(Pool::current()) {
  if (number == 0) number = std::max(std::thread::hardware_concurrency(), 1U);
  if (number == 1) return;
  pool_ = std::make_unique<Pool>(number);
  Pool::current() = pool_.get();
}

Threads::~Threads() {
  Pool::current() = outer_;
}

void forEachPart(Eigen::Index parts, const std::function<void(Eigen::Index)>& work) {
  Threads::Pool* const pool = Threads::Pool::current();
  if (pool != nullptr && parts > 1)
    pool->run(parts, work);
  else
    for (Eigen::Index part = 0; part < parts; ++part) work(part);
}

#endif

}  // namespace pcl_fft_ground::core

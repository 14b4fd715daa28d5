// A team of threads that do the same thing to parts of one whole, again and again: many times per
// millisecond.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <exception>
#include <thread>
#include <utility>
#include <vector>

namespace grainlaw {

/// Whoever calls run() is the first of the team; the others wait for it, for a short while awake, then
/// asleep, so that a team without work costs nothing and one between two steps loses no time.
class ThreadPool {
 public:
  /// Throws std::system_error where the system has no more threads.
  explicit ThreadPool(int threads) {
    try {
      failures_.resize(static_cast<std::size_t>(threads));
      for (int t = 1; t < threads; ++t) others_.emplace_back([this, t] { serve(t); });
    } catch (...) {
      dismiss();
      throw;
    }
  }
  ~ThreadPool() { dismiss(); }
  ThreadPool(const ThreadPool&) = delete;
  ThreadPool& operator=(const ThreadPool&) = delete;

  int threads() const { return static_cast<int>(others_.size()) + 1; }

  /// Calls f(0) ... f(threads - 1), each on a thread of its own, and returns when all have. Throws what one
  /// of them has thrown, then. Each thread calls a copy of f: so what f has captured by value lies on no line
  /// of memory that another thread writes to. f must be copyable, and callable where it is const.
  template <class F>
  void run(const F& f) {
    start(&call<F>, &f);
    call<F>(*this, &f, 0);
    for (int left = left_.load(std::memory_order_acquire); left != 0;
         left = left_.load(std::memory_order_acquire))
      wait_while(left_, left);
    std::exception_ptr first;
    for (std::exception_ptr& failure : failures_)
      if (std::exception_ptr thrown = std::exchange(failure, nullptr); first == nullptr) first = thrown;
    if (first != nullptr) std::rethrow_exception(first);
  }

 private:
  void dismiss() {
    start(nullptr, nullptr);
    for (std::thread& other : others_) other.join();
  }

  using Job = void (*)(ThreadPool&, const void*, int);

  template <class F>
  static void call(ThreadPool& pool, const void* function, int t) {
    try {
      const F own(*static_cast<const F*>(function));
      own(t);
    } catch (...) {
      pool.failures_[static_cast<std::size_t>(t)] = std::current_exception();
    }
  }

  void start(Job job, const void* function) {
    job_ = job;
    function_ = function;
    left_.store(static_cast<int>(others_.size()), std::memory_order_relaxed);
    turn_.fetch_add(1, std::memory_order_release);
    turn_.notify_all();
  }

  void serve(int t) {
    for (unsigned turn = 0;; ++turn) {
      wait_while(turn_, turn);
      if (job_ == nullptr) return;
      job_(*this, function_, t);
      if (left_.fetch_sub(1, std::memory_order_acq_rel) == 1) left_.notify_one();
    }
  }

  /// How long a wait looks again and again before it asks to be woken. Longer is no faster on quiet cores;
  /// where others wait for these, who has slept is woken at once, and who has looked all the time is not.
  static constexpr std::chrono::microseconds awake{20};

  template <class T>
  static void wait_while(const std::atomic<T>& what, T value) {
    using Clock = std::chrono::steady_clock;
    Clock::time_point begin;
    for (int round = 0; round == 0 || Clock::now() - begin < awake; ++round) {
      for (int look = 0; look < 64; ++look) {
        if (what.load(std::memory_order_acquire) != value) return;
#if defined(__x86_64__)
        __builtin_ia32_pause();
#endif
      }
      if (round == 0) begin = Clock::now();
    }
    what.wait(value, std::memory_order_acquire);
  }

  Job job_ = nullptr;
  const void* function_ = nullptr;
  alignas(64) std::atomic<unsigned> turn_{0};  ///< how often work was given out; it may wrap around
  alignas(64) std::atomic<int> left_{0};       ///< how many of the others are still at it
  std::vector<std::exception_ptr> failures_;   ///< of each thread
  std::vector<std::thread> others_;
};

}  // namespace grainlaw

// What pieces of work take on this machine now: processor seconds, memory.
#pragma once

#include <cstdint>
#include <functional>

namespace grainlaw::dem {

/// Processor seconds of this thread: a busy machine disturbs them less than the clock on the wall.
double thread_seconds();

/// Seconds of a call, from as many as fit into `budget` seconds; at least `least`.
template <class F>
double seconds_of(F&& call, double budget, std::uint64_t least) {
  const double begin = thread_seconds();
  std::uint64_t calls = 0;
  double spent = 0;
  do {
    call();
    ++calls;
    spent = thread_seconds() - begin;
  } while (spent < budget || calls < least);
  return spent / static_cast<double>(calls);
}

/// What is allocated, in bytes; NaN where the allocator does not tell, as those of sanitizers.
double heap_bytes();

/// The most memory that a call holds at one time beyond what is held when it begins, in bytes; 0 where the
/// system does not tell.
double peak_bytes(const std::function<void()>& call);

}  // namespace grainlaw::dem

// Which instruction set the kernels run on.
#pragma once

#include <string>
#include <vector>

namespace grainlaw::dem {

/// "avx512", "avx2" or "baseline" on x86-64; elsewhere Highway's name of it in lower case. The best that the
/// machine has, unless one was forced. Runs on different ones differ in the last digits, and grow apart as
/// the flow's chaos has it.
std::string simd_target();

/// Those that this machine can run, the best one first.
std::vector<std::string> simd_targets_here();

/// Makes all kernels of this process run on `name`. Throws Error if the machine lacks it. Not while a test
/// runs.
void force_simd_target(const std::string& name);

}  // namespace grainlaw::dem

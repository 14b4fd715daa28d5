// Which instruction set the kernels run on.
#pragma once

#include <string>

namespace grainlaw::dem {

/// "avx512", "avx2" or "baseline" on x86-64; elsewhere Highway's name of it in lower case. Chosen when the
/// program starts, for the machine it runs on. Runs on different ones differ in the last digits, and grow
/// apart as the flow's chaos has it.
std::string simd_target();

}  // namespace grainlaw::dem

// Which instruction sets the kernels are compiled for; to be included before Highway's headers. Those between
// the baseline and AVX2 have no vectors of four doubles, and AVX3_DL has nothing over AVX3 that the kernels
// use.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

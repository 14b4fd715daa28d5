// Which instruction sets the kernels are compiled for, before Highway's headers. Three are enough: those in between
// have no vectors of four doubles, or nothing that the kernels use.
#pragma once

#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3_DL)

// The contact law of the engine, for numbers; what a law is stands in element/contact_law-inl.hpp.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>

#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {
#include "grainlaw/element/contact_law-inl.hpp"
}  // namespace grainlaw::dem

// The contact law of the engine, for numbers; what a law is stands in contact_law-inl.hpp.
#pragma once

#include "grainlaw/element/material.hpp"

namespace grainlaw::dem {
#include "grainlaw/dem/step/contact_law-inl.hpp"
}  // namespace grainlaw::dem

// Wraps doctest::Approx, which takes doubles, for floats.
#pragma once

#include <doctest/doctest.h>

namespace bolt {

inline doctest::Approx about(double value) { return doctest::Approx(value); }
inline doctest::Approx about(float value) { return doctest::Approx(static_cast<double>(value)); }

}  // namespace bolt

// Whole numbers of floating-point ones that may be anything: converting NaN or what does not fit is undefined.
#pragma once

#include <cstddef>

namespace stairwright {

inline constexpr std::size_t kMostSteps = 100'000;  // more than any course is divided into

// `x` rounded down, at least 0 and at most `most`; 0 where it is no number.
constexpr std::size_t whole_part(double x, std::size_t most = kMostSteps) {
    if (!(x > 0.0)) return 0;
    return x >= static_cast<double>(most) ? most : static_cast<std::size_t>(x);
}

}  // namespace stairwright

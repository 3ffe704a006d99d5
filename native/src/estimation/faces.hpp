// What counts as a tread and as near to a corner, the same for all parts of the estimator.
#pragma once

namespace stairwright::estimation {

constexpr double kTread = 0.7;         // cosine of the slope of a face that is a tread; a steeper one is a face
constexpr double kNearCorner = 0.006;  // m; which way a wheel rolls this near to a concave corner is open
constexpr double kBeside = 1e-6;       // m before or past a corner, where the one or the other face is
constexpr double kClearOfEdge = 0.01;   // m along the curve
constexpr double kWindow = 0.12;       // m; a wheel is looked for this far from where it was
constexpr double kBeyondDoubt = 3.0;   // standard deviations

}  // namespace stairwright::estimation

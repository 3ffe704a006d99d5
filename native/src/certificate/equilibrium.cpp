#include "stairwright/certificate/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stairwright::certificate {

namespace {

constexpr double kRounding = 1e-7;  // weights
constexpr double kSingular = 1e-12;

// Edge of a friction cone.
struct Ray {
    double x = 0.0, z = 0.0;  // force
    double moment = 0.0;      // about the centre of mass
};

// Whether (0, 1, 0) is a sum of the rays with factors between 0 and kStrongest, by Cramer's rule: for this
// right-hand side the factors are minors of force x and moment over the determinant.
bool holds(const Ray& u, const Ray& v, const Ray& w) {
    const auto minor = [](const Ray& a, const Ray& b) { return b.x * a.moment - a.x * b.moment; };
    const std::array minors = {minor(v, w), minor(w, u), minor(u, v)};
    const double det = minors[0] * u.z + minors[1] * v.z + minors[2] * w.z;
    return std::abs(det) > kSingular && std::all_of(minors.begin(), minors.end(), [det](double each) {
               return each / det >= -kRounding && each / det <= kStrongest;
           });
}

}  // namespace

bool balanced(std::span<const Face> touched, double com_x, double friction) {
    std::array<Ray, 4 * kFaces> rays;
    std::size_t n = 0;
    for (const double side : {friction, -friction})
        for (const Face& face : touched) {
            const double x = face.normal.x + side * face.normal.z, z = face.normal.z - side * face.normal.x;
            rays[n++] = {x, z, (face.at.x - com_x) * z - face.at.z * x};
        }
    // By Caratheodory's theorem three rays are enough.
    for (std::size_t u = 0; u < n; ++u)
        for (std::size_t v = u + 1; v < n; ++v)
            for (std::size_t w = v + 1; w < n; ++w)
                if (holds(rays[u], rays[v], rays[w])) return true;
    return false;
}

}  // namespace stairwright::certificate

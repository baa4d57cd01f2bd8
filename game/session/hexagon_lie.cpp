#include "game/session/hexagon_lie.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace bolt::session {

HexagonLie lie_of(const servo::NutGeometry& nut, std::span<const glm::dvec3> points) {
    std::complex<double> sixfold = 0.0;
    double low = 1e9;
    for (const Vec3& p : points) {
        const Vec3 d = p - nut.seat;
        const Vec3 q(glm::dot(d, nut.e1), glm::dot(d, nut.e2), glm::dot(d, nut.axis));
        low = std::min(low, q.z);
        const double out = std::hypot(q.x, q.y) / nut.across_flats;
        sixfold += std::pow(out, 24.0) * std::polar(1.0, 6.0 * std::atan2(q.y, q.x));
    }
    return {glm::angleAxis(-std::arg(sixfold) / 6.0, Vec3(0, 0, 1)), low};
}

}  // namespace bolt::session

#include "haptics/joint/flange.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>

namespace bolt::joint {

FlangePlate FlangePlate::make(double thickness, double E, double poisson, double interface_stiffness) {
    return {E * thickness * square(thickness) / (12.0 * (1.0 - square(poisson))), interface_stiffness};
}

double FlangePlate::length() const { return std::sqrt(std::sqrt(rigidity / foundation)); }

double FlangePlate::deflection_per_force(double r) const {
    const double l = length();
    return -square(l) / (2.0 * pi * rigidity) * kelvin_kei(r / l);
}

double kelvin_kei(double x) {
    if (x < 1e-9) return -0.25 * pi;
    // K0(z) = ∫₀^∞ exp(−z cosh t) dt. The integrand is even and analytic: the trapezoidal rule converges
    // exponentially.
    const std::complex<double> z = std::polar(x, 0.25 * pi);
    constexpr double step = 1.0 / 64.0;
    double sum = 0.5 * std::exp(-z).imag();
    for (double t = step;; t += step) {
        const std::complex<double> term = std::exp(-z * std::cosh(t));
        sum += term.imag();
        if (z.real() * std::cosh(t) > 40.0) break;
    }
    return sum * step;
}

CouplingMatrix couple(const FlangePlate& plate, std::span<const Vec3> seats) {
    const double reach = 10.0 * plate.length();
    CouplingMatrix m;
    m.own = plate.deflection_per_force(0.0);
    m.row_begin.push_back(0);
    // Sorted by x, so that a large field of joints costs n log n and not n².
    std::vector<std::uint32_t> by_x(seats.size());
    std::iota(by_x.begin(), by_x.end(), 0U);
    std::sort(by_x.begin(), by_x.end(), [&](auto a, auto b) { return seats[a].x < seats[b].x; });
    for (std::uint32_t i = 0; i < seats.size(); ++i) {
        const auto from = std::lower_bound(by_x.begin(), by_x.end(), seats[i].x - reach,
                                           [&](auto j, double x) { return seats[j].x < x; });
        const std::size_t row = m.column.size();
        for (auto j = from; j != by_x.end() && seats[*j].x <= seats[i].x + reach; ++j)
            if (*j != i && glm::distance(seats[i], seats[*j]) <= reach) m.column.push_back(*j);
        std::sort(m.column.begin() + static_cast<std::ptrdiff_t>(row), m.column.end());
        for (std::size_t k = row; k < m.column.size(); ++k)
            m.value.push_back(plate.deflection_per_force(glm::distance(seats[i], seats[m.column[k]])));
        m.row_begin.push_back(static_cast<std::uint32_t>(m.column.size()));
    }
    return m;
}

}  // namespace bolt::joint

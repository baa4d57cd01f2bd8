#include "tools/author/import/draft_order.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

namespace bolt::step_import {

std::vector<std::size_t> tightening_order(const std::vector<Vec3>& seats) {
    const std::size_t n = seats.size();
    if (n == 0) return {};
    const auto apart = [&](std::size_t i, std::size_t k) { return glm::length(seats[i] - seats[k]); };
    Vec3 middle{0.0};
    for (const Vec3& seat : seats) middle += seat / static_cast<double>(n);
    std::vector<double> radius(n);
    for (std::size_t i = 0; i < n; ++i) radius[i] = glm::length(seats[i] - middle);
    const auto [least, most] = std::minmax_element(radius.begin(), radius.end());
    const bool circle = *most - *least < 0.02 * *most;
    std::vector<std::size_t> order;
    // Rounded to 0.1 mm, so that equal distances compare equal.
    const auto rank = [&](std::size_t i) {
        double nearest = circle ? 1e3 : -radius[i];
        for (const std::size_t k : order) nearest = circle ? std::min(nearest, apart(i, k)) : nearest;
        const double last = order.empty() ? 0.0 : apart(i, order.back());
        return std::pair(std::lround(nearest * 1e4), std::lround(last * 1e4));
    };
    std::vector<std::size_t> left(n);
    std::iota(left.begin(), left.end(), std::size_t{0});
    while (!left.empty()) {
        const auto next = std::max_element(left.begin(), left.end(),
                                           [&](std::size_t a, std::size_t b) { return rank(a) < rank(b); });
        order.push_back(*next);
        left.erase(next);
    }
    return order;
}

}  // namespace bolt::step_import

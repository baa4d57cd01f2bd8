#include "game/analysis/quartiles.hpp"

#include <algorithm>
#include <cmath>

namespace bolt::analysis {

Quartiles quartiles(std::vector<double> values) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double share) {
        const double at = share * static_cast<double>(values.size() - 1);
        const auto below = static_cast<std::size_t>(at);
        const std::size_t above = std::min(below + 1, values.size() - 1);
        return values[below] + (at - static_cast<double>(below)) * (values[above] - values[below]);
    };
    return {quantile(0.25), quantile(0.5), quantile(0.75), values.size()};
}

}  // namespace bolt::analysis

#include <algorithm>
#include <numeric>

#include "content/studies/study.hpp"
#include "engine/base/random.hpp"

namespace bolt::content {

namespace {

// Uniform below `n`, without the bias of a remainder.
std::size_t below(Random& random, std::size_t n) {
    const auto bound = static_cast<std::uint32_t>(n);
    const std::uint32_t limit = 0xFFFFFFFFU - 0xFFFFFFFFU % bound;
    std::uint32_t bits = random.bits();
    while (bits >= limit) bits = random.bits();
    return bits % bound;
}

// 0 ... n − 1 in drawn order (Fisher and Yates).
std::vector<std::size_t> shuffled(std::size_t n, Random& random) {
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    for (std::size_t i = n; i > 1; --i) std::swap(order[i - 1], order[below(random, i)]);
    return order;
}

}  // namespace

std::vector<std::vector<std::size_t>> williams_square(std::size_t n) {
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t shift = 0; shift < n; ++shift) {
        std::vector<std::size_t>& row = rows.emplace_back();
        for (std::size_t i = 0; i < n; ++i) {
            const std::size_t first = i % 2 == 1 ? (i + 1) / 2 : (n - i / 2) % n;
            row.push_back((first + shift) % n);
        }
    }
    if (n % 2 == 1 && n > 1)
        for (std::size_t i = 0; i < n; ++i) rows.emplace_back(rows[i].rbegin(), rows[i].rend());
    return rows;
}

std::size_t balanced_participants(const Study& study) {
    const std::size_t n = study.conditions.size();
    const bool williams =
        study.design.subjects == StudySubjects::within && study.design.order == StudyOrder::williams && n > 1;
    return williams && n % 2 == 1 ? 2 * n : n;
}

std::vector<std::size_t> conditions_of(const Study& study, std::size_t place) {
    const std::size_t n = study.conditions.size();
    const std::size_t block_size = balanced_participants(study);
    const std::size_t block = place / block_size, in_block = place % block_size;
    Random random(study.design.seed, block);
    if (study.design.subjects == StudySubjects::between) return {shuffled(n, random)[in_block]};
    if (study.design.order == StudyOrder::williams)
        return williams_square(n)[shuffled(block_size, random)[in_block]];
    const std::vector<std::size_t> rows = shuffled(n, random), labels = shuffled(n, random);
    std::vector<std::size_t> row;
    for (std::size_t i = 0; i < n; ++i) row.push_back(labels[(rows[in_block] + i) % n]);
    return row;
}

}  // namespace bolt::content

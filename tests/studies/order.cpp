// The balanced orders of conditions.
#include <doctest/doctest.h>

#include <algorithm>
#include <map>

#include "content/studies/study.hpp"

namespace study_order_test {

using namespace bolt::content;

namespace {

Study study_of(std::size_t conditions, StudySubjects subjects, StudyOrder order, std::uint64_t seed = 1) {
    Study study;
    study.conditions.resize(conditions);
    study.design.subjects = subjects;
    study.design.order = order;
    study.design.seed = seed;
    return study;
}

// Counts of each succession of two numbers in the rows, and of each number in each position.
struct Counts {
    std::map<std::pair<std::size_t, std::size_t>, int> successions, positions;
};
Counts counts_of(const std::vector<std::vector<std::size_t>>& rows) {
    Counts counts;
    for (const auto& row : rows)
        for (std::size_t i = 0; i < row.size(); ++i) {
            ++counts.positions[{row[i], i}];
            if (i > 0) ++counts.successions[{row[i - 1], row[i]}];
        }
    return counts;
}

// Each of `size` keys is counted `times` times.
bool all_counted(const std::map<std::pair<std::size_t, std::size_t>, int>& counts, std::size_t size,
                 int times) {
    return counts.size() == size && std::all_of(counts.begin(), counts.end(),
                                                [&](const auto& entry) { return entry.second == times; });
}

std::vector<std::vector<std::size_t>> orders(const Study& study, std::size_t participants) {
    std::vector<std::vector<std::size_t>> rows;
    for (std::size_t place = 0; place < participants; ++place) rows.push_back(conditions_of(study, place));
    return rows;
}

}  // namespace

TEST_CASE("Studies: the Williams square of four is the printed one") {
    const std::vector<std::vector<std::size_t>> printed{
        {0, 1, 3, 2}, {1, 2, 0, 3}, {2, 3, 1, 0}, {3, 0, 2, 1}};
    CHECK(williams_square(4) == printed);
    CHECK(williams_square(3).size() == 6);
    CHECK(williams_square(1) == std::vector<std::vector<std::size_t>>{{0}});
}

TEST_CASE("Studies: in a Williams square each condition follows each other one equally often") {
    for (std::size_t n = 2; n <= 12; ++n) {
        const auto rows = williams_square(n);
        const int times = n % 2 == 1 ? 2 : 1;
        const Counts counts = counts_of(rows);
        CAPTURE(n);
        CHECK(all_counted(counts.successions, n * (n - 1), times));
        CHECK(all_counted(counts.positions, n * n, times));
    }
    auto wrong = williams_square(4);
    std::swap(wrong[0][0], wrong[0][1]);
    CHECK_FALSE(all_counted(counts_of(wrong).successions, 12, 1));  // the check can fail
}

TEST_CASE("Studies: every complete block of participants is balanced, for every seed") {
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        for (std::size_t n = 2; n <= 6; ++n) {
            const Study williams = study_of(n, StudySubjects::within, StudyOrder::williams, seed);
            const std::size_t block = balanced_participants(williams);
            REQUIRE(block == (n % 2 == 1 ? 2 * n : n));
            const int times = static_cast<int>(3 * block / n);
            const Counts counts = counts_of(orders(williams, 3 * block));
            CAPTURE(n);
            CHECK(all_counted(counts.successions, n * (n - 1), times));
            CHECK(all_counted(counts.positions, n * n, times));

            const Study random = study_of(n, StudySubjects::within, StudyOrder::random, seed);
            CHECK(all_counted(counts_of(orders(random, 3 * n)).positions, n * n, 3));

            const Study between = study_of(n, StudySubjects::between, StudyOrder::random, seed);
            const auto groups = orders(between, 3 * n);
            CHECK(all_counted(counts_of(groups).positions, n, 3));
            CHECK(std::all_of(groups.begin(), groups.end(), [](const auto& g) { return g.size() == 1; }));
        }
}

TEST_CASE("Studies: the order depends on the seed and on nothing else") {
    const Study a = study_of(4, StudySubjects::within, StudyOrder::williams, 7);
    CHECK(orders(a, 40) == orders(a, 40));
    CHECK(orders(a, 40) != orders(study_of(4, StudySubjects::within, StudyOrder::williams, 8), 40));
    // The blocks of one study differ too, so that nobody can foresee the next order.
    const auto rows = orders(a, 40);
    int repeated = 0;
    for (std::size_t block = 1; block < 10; ++block)
        repeated +=
            std::equal(rows.begin(), rows.begin() + 4, rows.begin() + static_cast<std::ptrdiff_t>(4 * block));
    CHECK(repeated < 3);
}

}  // namespace study_order_test

// Plans of studies: any bytes give a plan whose orders are permutations of its conditions, or errors with
// positions, never a crash.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "content/studies/study.hpp"

namespace {

using namespace bolt::content;

void expect(bool condition) {
    if (!condition) std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    const LoadedStudy read = parse_study(text, "fuzz.json");
    for (const bolt::Error& error : read.errors) expect(error.line >= 1 && !error.what.empty());
    if (!read.ok()) return 0;
    const Study& study = read.study;
    const std::size_t n = study.conditions.size();
    expect(n >= 1 && study.design.participants >= 1 && study.design.lessons >= 1);
    for (std::size_t place = 0; place < 2 * balanced_participants(study); ++place) {
        std::vector<std::size_t> order = conditions_of(study, place);
        std::sort(order.begin(), order.end());
        expect(std::adjacent_find(order.begin(), order.end()) == order.end() && order.back() < n);
        expect(order.size() == (study.design.subjects == StudySubjects::between ? 1 : n));
    }
    for (const PlannedComparison& comparison : study.comparisons) {
        expect(comparison.groups.size() >= 2);
        for (const ComparedGroup& group : comparison.groups)
            for (const std::size_t condition : group.conditions) expect(condition < n);
    }
    return 0;
}

// The trainees of a report: one person under a code and under a typed name, and the names on the page.
#include <doctest/doctest.h>

#include "game/people/page_trainees.hpp"
#include "game/report/attempts.hpp"
#include "game/report/report.hpp"
#include "tests/report/synthetic.hpp"
#include "tests/report/well_formed.hpp"

namespace report_trainees_test {

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::report;

namespace {

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("Trainees: sessions under a code and under the linked name of an older program are one person's") {
    const content::Person ada{"T-7K3M9Q", "Ada <L>"}, bea{"T-AAAAAA", "Bea"};
    std::vector<SessionData> sessions;
    for (const char* trainee : {"Ada <L>", "T-7K3M9Q", "Bea", "T-7K3M9Q", "Cy", "Cy"}) {
        sessions.push_back(synthetic_session({}).data);
        sessions.back().header.trainee_profile = "person";
        sessions.back().header.trainee = trainee;
    }
    sessions.push_back(sessions.front());
    sessions.back().header.trainee_profile = "novice";  // simulated, although it has the person's name
    const auto curves = [&](const TraineeNames& names) {
        std::vector<Attempt> attempts;
        for (const SessionData& session : sessions) attempts.push_back(attempt_of(session, names));
        return split_by_trainee(attempts, attempt_groups(attempts).front());
    };
    using Curves = std::vector<std::vector<std::size_t>>;
    CHECK(curves({}) == Curves{{0}, {1, 3}, {2}, {4, 5}, {6}});
    CHECK(curves({{ada, bea}, false}) == Curves{{0, 1, 3}, {2}, {4, 5}, {6}});
    CHECK(curves({{ada, bea}, true}) == Curves{{0, 1, 3}, {2}, {4, 5}, {6}});

    // Without names a page has codes only; with them both. An unlinked name of an older program stays.
    const std::string with_codes = make_report(sessions, TraineeNames{{ada, bea}, false});
    CHECK(markup_fault(with_codes) == "");
    CHECK_FALSE(has(with_codes, "Bea"));
    CHECK(count_of(with_codes, "Ada") == count_of(with_codes, "Ada &lt;L&gt; (simulated novice)"));
    CHECK(has(with_codes, "<h3>T-7K3M9Q <span"));
    CHECK(has(with_codes, "<h3>Cy <span"));
    const std::string with_names = make_report(sessions, TraineeNames{{ada, bea}, true});
    CHECK(markup_fault(with_names) == "");
    CHECK(has(with_names, "<h3>Ada &lt;L&gt; (T-7K3M9Q) <span"));
    CHECK(has(with_names, "<dt>trainee</dt><dd>Bea (T-AAAAAA)</dd>"));
    for (const std::string& page : {with_codes, with_names})
        CHECK(people::page_trainees(page) == std::vector<std::string>{"Cy", "T-7K3M9Q", "T-AAAAAA"});
}

}  // namespace report_trainees_test

#include "game/report/report.hpp"

#include <fmt/format.h>

#include "game/plot/html.hpp"
#include "game/report/attempts.hpp"
#include "game/report/section.hpp"

namespace bolt::report {

namespace {

struct Pages {
    std::vector<Attempt> attempts;
    std::string sections;

    void add(const analysis::SessionData& session, bool alone, Extent extent = Extent::everything) {
        attempts.push_back(attempt_of(session));
        if (alone || extent == Extent::everything)
            sections += session_section(session, alone ? 0 : attempts.size());
    }

    [[nodiscard]] std::string finish(Extent extent = Extent::everything) const {
        if (attempts.size() == 1) return plot::page(attempts.front().title + " – training report", sections);
        return plot::page(fmt::format("{} attempts – training report", attempts.size()),
                          attempts_section(attempts, extent == Extent::overview) + sections);
    }
};

}  // namespace

Result<std::string> make_report(std::span<const session::Reader* const> sessions, Extent extent) {
    if (sessions.empty())
        return fail(ErrorCode::usage, "no session was given to report", "one or more session files");
    Pages pages;
    for (const session::Reader* session : sessions) {
        BOLT_TRY_ASSIGN(const auto data, analysis::read_session(*session));
        pages.add(data, sessions.size() == 1, extent);
    }
    return pages.finish(extent);
}

std::string make_report(std::span<const analysis::SessionData> sessions) {
    Pages pages;
    for (const analysis::SessionData& session : sessions) pages.add(session, sessions.size() == 1);
    return pages.finish();
}

}  // namespace bolt::report

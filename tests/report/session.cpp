#include <doctest/doctest.h>

#include <filesystem>
#include <string>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "game/analysis/comparison.hpp"
#include "game/plot/html.hpp"
#include "game/report/report.hpp"
#include "tests/report/synthetic.hpp"
#include "tests/report/well_formed.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::plot;
using namespace bolt::report;

namespace {

// A session file of the cover assembly, removed at the end: its first joints are worked on as the synthetic
// ones were.
struct Recorded {
    test::Folder folder;
    std::filesystem::path path = folder / "recorded.boltwright";
    SyntheticSession played;

    Recorded(std::string assembly_text, bool finish) {
        played = synthetic_session({});
        session::Header header = played.data.header;
        header.assembly_text = std::move(assembly_text);
        header.variant.clear();
        Result<session::Writer> writer = session::Writer::create(path, header);
        REQUIRE_MESSAGE(writer, (writer ? "" : writer.error().message()));
        for (const lesson::Event& event : played.events) REQUIRE(writer->add(event));
        for (const session::TickRecord& tick : played.ticks) REQUIRE(writer->append(tick));
        lesson::LessonResult result;
        result.duration = played.data.duration;
        result.score = 77.25;
        result.joints = {played.data.joints[0]};
        result.joints[0].id = "B1";
        if (finish) REQUIRE(writer->finish(result));
    }
};

std::string cover_text() {
    const auto file = content::content_folder() / "assemblies" / "cover-m8" / "assembly.json";
    const Result<std::string> text = read_file(file, 1U << 20U, ErrorCode::bad_content);
    REQUIRE_MESSAGE(text, (text ? "" : text.error().message()));
    return *text;
}

}  // namespace

TEST_CASE("a session file becomes a page") {
    const Recorded recorded(cover_text(), true);
    const Result<session::Reader> reader = session::Reader::open(recorded.path);
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    const Result<SessionData> data = read_session(*reader);
    REQUIRE_MESSAGE(data, (data ? "" : data.error().message()));
    REQUIRE(data->curves.size() == 4);  // the cover has four joints; the other ticks name none of them
    CHECK(data->joints[0].torque == doctest::Approx(recorded.played.data.joints[0].torque));
    CHECK(data->joints[1].overall == lesson::Verdict::none);
    for (std::size_t j = 0; j < 4; ++j) {
        REQUIRE(data->curves[j].visits.size() == recorded.played.data.curves[j].visits.size());
        CHECK(data->curves[j].end_angle == recorded.played.data.curves[j].end_angle);
    }
    const session::Reader* one[] = {&*reader};
    const Result<std::string> html = make_report(one);
    REQUIRE(html);
    CHECK(markup_fault(*html) == "");
    CHECK(html->find(number(77.25, 1) + " <small>/ 100") != std::string::npos);
    CHECK(html->find("cut short") == std::string::npos);
}

TEST_CASE("a session that was cut short still makes a page") {
    const Recorded recorded(cover_text(), false);
    const Result<session::Reader> reader = session::Reader::open(recorded.path);
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    const session::Reader* one[] = {&*reader};
    const Result<std::string> html = make_report(one);
    REQUIRE_MESSAGE(html, (html ? "" : html.error().message()));
    CHECK(html->find("This session was cut short") != std::string::npos);
    CHECK(markup_fault(*html) == "");
}

TEST_CASE("a session whose assembly cannot be read names the session and the mistake") {
    const Recorded recorded("{ \"joints\": 7 }", true);
    const Result<session::Reader> reader = session::Reader::open(recorded.path);
    REQUIRE(reader);
    const Result<SessionData> data = read_session(*reader);
    REQUIRE_FALSE(data.has_value());
    CHECK(data.error().file == reader->file());
    CHECK(data.error().what.starts_with("the assembly stored in this session cannot be read: "));
}

TEST_CASE("no session is a usage error") {
    const Result<std::string> html = make_report(std::span<const session::Reader* const>{});
    REQUIRE_FALSE(html.has_value());
    CHECK(html.error().code == ErrorCode::usage);
}

TEST_CASE("curves for a comparison exist only in the direction that was worked") {
    const Recorded recorded(cover_text(), true);
    const Result<session::Reader> reader = session::Reader::open(recorded.path);
    REQUIRE(reader);
    const auto tightened = advance_curves(*reader, 4, joint::Direction::tighten);
    const auto loosened = advance_curves(*reader, 4, joint::Direction::loosen);
    REQUIRE(tightened);
    REQUIRE(loosened);
    for (std::size_t j = 0; j < 4; ++j) {
        REQUIRE((*tightened)[j].has_value());
        CHECK_FALSE((*loosened)[j].has_value());
        const Curve& curve = *(*tightened)[j];
        std::size_t checked = 0;
        for (std::size_t i = 0; i < curve.size(); ++i) {
            // Counted from the first tick of the run-down, 5.4° on; the wrench takes over about the seat.
            const double beyond_seat = to_degrees(curve.angle[i]) + 5.4 - 18.0 * 360.0;
            if (beyond_seat < 0.0) continue;
            CHECK(curve.torque[i] == doctest::Approx(synthetic_torque(beyond_seat)).epsilon(1e-3));
            ++checked;
        }
        CHECK(checked > 150);
    }
}

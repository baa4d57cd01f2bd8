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

// A temporary session file of the cover assembly, with the ticks of a synthetic session.
struct Recorded {
    test::Folder folder;
    std::filesystem::path path = folder / "recorded.boltwright";
    SyntheticSession played;

    Recorded(std::string assembly_text, bool finish) {
        played = synthetic_session({});
        session::Header header = played.data.header;
        header.assembly_text = std::move(assembly_text);
        header.variant.clear();
        Result<session::SessionWriter> writer = session::SessionWriter::create(path, header);
        REQUIRE_MESSAGE(writer, (writer ? "" : writer.error().message()));
        for (const lesson::LessonEvent& event : played.events) REQUIRE(writer->add(event));
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

TEST_CASE("Report: a session file gives its curves, results and score") {
    const Recorded recorded(cover_text(), true);
    const Result<session::SessionReader> reader = session::SessionReader::open(recorded.path);
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    const Result<SessionData> data = read_session(*reader);
    REQUIRE_MESSAGE(data, (data ? "" : data.error().message()));
    REQUIRE(data->curves.size() == 4);  // the cover has four joints; ticks of other joints are ignored
    CHECK(data->joints[0].torque == doctest::Approx(recorded.played.data.joints[0].torque));
    CHECK(data->joints[1].overall == lesson::Verdict::none);
    for (std::size_t j = 0; j < 4; ++j) {
        REQUIRE(data->curves[j].visits.size() == recorded.played.data.curves[j].visits.size());
        CHECK(data->curves[j].end_angle == recorded.played.data.curves[j].end_angle);
    }
    const session::SessionReader* one[] = {&*reader};
    const Result<std::string> html = make_report(one);
    REQUIRE(html);
    CHECK(markup_fault(*html) == "");
    CHECK(html->find(number(77.25, 1) + " <small>/ 100") != std::string::npos);
    CHECK(html->find("cut short") == std::string::npos);
}

TEST_CASE("Report: a session file that was cut short is reported as such") {
    const Recorded recorded(cover_text(), false);
    const Result<session::SessionReader> reader = session::SessionReader::open(recorded.path);
    REQUIRE_MESSAGE(reader, (reader ? "" : reader.error().message()));
    const session::SessionReader* one[] = {&*reader};
    const Result<std::string> html = make_report(one);
    REQUIRE_MESSAGE(html, (html ? "" : html.error().message()));
    CHECK(html->find("This session was cut short") != std::string::npos);
    CHECK(markup_fault(*html) == "");
}

TEST_CASE("Report: an unreadable assembly names the session and the fault") {
    const Recorded recorded("{ \"joints\": 7 }", true);
    const Result<session::SessionReader> reader = session::SessionReader::open(recorded.path);
    REQUIRE(reader);
    const Result<SessionData> data = read_session(*reader);
    REQUIRE_FALSE(data.has_value());
    CHECK(data.error().file == reader->file());
    CHECK(data.error().what.starts_with("the assembly stored in this session cannot be read: "));
}

TEST_CASE("Report: no session is a usage error") {
    const Result<std::string> html = make_report(std::span<const session::SessionReader* const>{});
    REQUIRE_FALSE(html.has_value());
    CHECK(html.error().code == ErrorCode::usage);
}

TEST_CASE("Comparison: torque curves exist only in the direction of work") {
    const Recorded recorded(cover_text(), true);
    const Result<session::SessionReader> reader = session::SessionReader::open(recorded.path);
    REQUIRE(reader);
    const auto tightened = torque_curves(*reader, 4, joint::Direction::tighten);
    const auto loosened = torque_curves(*reader, 4, joint::Direction::loosen);
    REQUIRE(tightened);
    REQUIRE(loosened);
    for (std::size_t j = 0; j < 4; ++j) {
        REQUIRE((*tightened)[j].has_value());
        CHECK_FALSE((*loosened)[j].has_value());
        const TorqueCurve& curve = *(*tightened)[j];
        std::size_t checked = 0;
        for (std::size_t i = 0; i < curve.size(); ++i) {
            // Angles count from the first tick of the run-down, which is at 5.4°. From about the seat on the
            // wrench turns the nut.
            const double beyond_seat = to_degrees(curve.angle[i]) + 5.4 - 18.0 * 360.0;
            if (beyond_seat < 0.0) continue;
            CHECK(curve.torque[i] == doctest::Approx(synthetic_torque(beyond_seat)).epsilon(1e-3));
            ++checked;
        }
        CHECK(checked > 150);
    }
}

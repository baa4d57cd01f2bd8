#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>

#include "content/format/assembly.hpp"
#include "engine/base/file.hpp"
#include "game/report/report.hpp"
#include "game/session/session_file.hpp"
#include "tests/analysis/curves.hpp"
#include "tests/report/well_formed.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::analysis;
using namespace bolt::report;

namespace {

// A session that only loosens joint B2 of the cover, with the curve of curves.hpp.
struct Loosened {
    test::Folder folder;
    std::filesystem::path path = folder / "loosened.boltwright";
    static constexpr double start = 4000.0;  // degrees of nut angle

    Loosened() {
        session::Header header;
        const auto file = content::content_folder() / "assemblies" / "cover-m8" / "assembly.json";
        const Result<std::string> text = read_file(file, 1U << 20U, ErrorCode::bad_content);
        REQUIRE_MESSAGE(text, (text ? "" : text.error().message()));
        header.assembly_text = *text;
        header.law = joint::Law::mechanistic;
        header.task = lesson::Task::loosen;
        Result<session::SessionWriter> writer = session::SessionWriter::create(path, header);
        REQUIRE(writer);
        for (int i = 0; i < 50; ++i) put(*writer, 0.0, loosening_torque(0.0) * i / 50.0);
        for (double back = 0.0; back <= 200.0; back += 0.1) put(*writer, back, loosening_torque(back));
        REQUIRE(writer->finish({}));
    }

    static void put(session::SessionWriter& writer, double back, double torque) {
        session::TickRecord tick;
        tick.joint = 1;
        tick.nut_angle = static_cast<float>(to_radians(start - back));
        tick.wrench_torque = static_cast<float>(torque);
        tick.stage = static_cast<std::uint8_t>(stage_at(torque));
        REQUIRE(writer.append(tick));
    }
};

MeasuredRecord rig(double play, double factor) {
    std::string text = "angle_deg,torque_Nm\n";
    for (double at = -play; at < 150.0; at += 1.0)
        text += std::to_string(at + play) + "," +
                std::to_string(factor * (at < 0.0 ? 0.0 : loosening_torque(at))) + "\n";
    const Result<MeasuredRecord> measured = parse_measured(text, "rig.csv");
    REQUIRE_MESSAGE(measured, (measured ? "" : measured.error().message()));
    return *measured;
}

}  // namespace

TEST_CASE("Comparison: a session against a rig with the same curve") {
    const Loosened session;
    const Result<session::SessionReader> reader = session::SessionReader::open(session.path);
    REQUIRE(reader);
    const Result<Comparison> c = analysis::compare(*reader, rig(30.0, 1.0), "");
    REQUIRE_MESSAGE(c, (c ? "" : c.error().message()));
    REQUIRE(c->joints.size() == 1);
    CHECK(c->joints[0].joint == "B2");
    CHECK(to_degrees(c->joints[0].cycles[0].alignment.shift) == doctest::Approx(-30.0).epsilon(1e-3));
    CHECK(c->errors.all.count > 30);
    CHECK(c->errors.all.mre < 0.01);
    CHECK(c->errors.outside == 30);  // the rig's play
    CHECK(report::markup_fault(comparison_page(*c)) == "");

    const Result<Comparison> weaker = analysis::compare(*reader, rig(30.0, 1.0 / 1.1), "B2");
    REQUIRE(weaker);
    CHECK(weaker->errors.all.mre == doctest::Approx(0.1).epsilon(0.05));
    CHECK(weaker->errors.all.mape == doctest::Approx(0.1).epsilon(0.05));
}

TEST_CASE("Comparison: a record of another thread has no errors, however equal its torques are") {
    const Loosened session;
    const Result<session::SessionReader> reader = session::SessionReader::open(session.path);
    REQUIRE(reader);
    MeasuredRecord measured = rig(30.0, 1.0);
    measured.thread = "M8x1";
    const Result<Comparison> c = analysis::compare(*reader, measured, "");
    REQUIRE_MESSAGE(c, (c ? "" : c.error().message()));
    CHECK(c->joints[0].mismatch_reason == "the measured thread is M8×1, the joint's M8×1.25");
    CHECK(c->errors.all.count == 0);
    measured.thread = "M9";
    const Result<Comparison> unknown = analysis::compare(*reader, measured, "");
    REQUIRE_FALSE(unknown.has_value());
    CHECK(unknown.error().message().starts_with("rig.csv: the line \"# thread:\" is wrong: "));
}

TEST_CASE("Comparison: a record of a bolt of another length or class has no errors") {
    const Loosened session;
    const Result<session::SessionReader> reader = session::SessionReader::open(session.path);
    REQUIRE(reader);
    const auto why = [&](const char* length, const char* grade) {
        MeasuredRecord measured = rig(30.0, 1.0);
        measured.bolt_length = length;
        measured.property_class = grade;
        const Result<Comparison> c = analysis::compare(*reader, measured, "");
        if (!c) return c.error().message();
        CHECK((c->errors.all.count == 0) != c->joints[0].mismatch_reason.empty());
        return c->joints[0].mismatch_reason;
    };
    CHECK(why("30", "8.8") == "");
    CHECK(why("45", "") == "the measured bolt is 45 mm long, the joint's 30 mm");
    CHECK(why("", "10.9") == "the measured property class is 10.9, the joint's 8.8");
    CHECK(why("long", "") ==
          "rig.csv: the line \"# bolt_length_mm:\" is wrong: 'long' is not a length; expected millimetres, "
          "such as 75");
}

TEST_CASE("Comparison: errors name the joint and the direction") {
    const Loosened session;
    const Result<session::SessionReader> reader = session::SessionReader::open(session.path);
    REQUIRE(reader);
    const MeasuredRecord measured = rig(30.0, 1.0);
    const Result<Comparison> unknown = analysis::compare(*reader, measured, "b2");
    REQUIRE_FALSE(unknown.has_value());
    CHECK(unknown.error().code == ErrorCode::usage);
    CHECK(unknown.error().message() == "there is no joint \"b2\" in the session; did you mean \"B2\"?");
    const Result<Comparison> untouched = analysis::compare(*reader, measured, "B1");
    REQUIRE_FALSE(untouched.has_value());
    CHECK(untouched.error().what == "joint 'B1' was not loosened in this session");
    MeasuredRecord tightening = measured;
    tightening.direction = joint::Direction::tighten;
    const Result<Comparison> other = analysis::compare(*reader, tightening, "");
    REQUIRE_FALSE(other.has_value());
    CHECK(other.error().what == "no joint was tightened in this session");
}

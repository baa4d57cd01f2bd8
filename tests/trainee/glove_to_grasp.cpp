// The whole chain: an emulated glove on a pseudo-terminal, its driver, the calibration session, the
// calibration file, and a hand that grasps a tool and keeps it while the glove is lost. The test waits for
// events without time limits of its own.
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "content/trainee/glove_calibration.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/grasp.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/hand/measured_hand.hpp"
#include "tests/hand/test_tools.hpp"
#include "tests/support/eventually.hpp"
#include "tests/support/folder.hpp"
#include "tools/emulate/glove.hpp"

using namespace bolt;
using hand::Sensor;

namespace {

// The fit of each emulated sensor, which the calibration must find.
constexpr hand::LinearFit truth(std::size_t sensor) {
    const double gain = 0.0125 + 0.0002 * static_cast<double>(sensor % 7);
    return sensor % 5 == 3 ? hand::LinearFit{-gain, 220.0}
                           : hand::LinearFit{gain, 45.0 + static_cast<double>(sensor)};
}

std::uint8_t raw_of(std::size_t sensor, double angle) {
    const hand::LinearFit line = truth(sensor);
    return static_cast<std::uint8_t>(std::clamp(std::lround(angle / line.gain + line.offset), 1L, 255L));
}

hand::PerSensor<std::uint8_t> raw_of(hand::Posture posture) {
    hand::PerSensor<std::uint8_t> raw{};
    for (std::size_t i = 0; i < hand::sensor_count; ++i)
        raw[i] = raw_of(i, hand::posture_angle(posture, static_cast<Sensor>(i)).value_or(0.1));
    return raw;
}

hand::PerSensor<std::uint8_t> raw_of(const hand::Angles& angles) {
    hand::PerSensor<hand::LinearFit> lines;
    for (std::size_t i = 0; i < lines.size(); ++i) lines[i] = truth(i);
    return emulate::raw_values(angles, lines);
}

// Reads every new sample of the driver once.
struct SampleReader {
    hand::GloveDriver driver;
    std::uint64_t last = 0;
    const hand::GloveSample* next() {
        const hand::GloveSample& sample = driver.sample();
        if (sample.number == last) return nullptr;
        last = sample.number;
        return &sample;
    }
};

hand::CalibrationResult calibrated(emulate::SerialGlove& line, SampleReader& reader) {
    hand::CalibrationSession session;
    session.options.hold = 0.4;  // the emulated hand does not tremble
    session.options.settle = 0.1;
    session.options.silence = 5.0;  // a busy machine must not look like a silent glove
    double now = 0.0;
    REQUIRE(test::eventually([&] {
        line.set_raw(raw_of(session.requested));
        const hand::GloveSample* sample = reader.next();
        if (sample != nullptr) now = sample->time;
        if (now > 0.0) update(session, sample == nullptr ? nullptr : &sample->frame, now);
        return session.phase == hand::CalibrationPhase::done;
    }));
    return *session.result;
}

}  // namespace

TEST_CASE("Glove to grasp: from an emulated glove to a wrench in the hand") {
    for (const std::size_t sensors : {18U, 22U}) {
        const bool right = sensors == 18;
        auto line = emulate::SerialGlove::start(
            {.sensors = sensors, .hand = right ? hand::Side::right : hand::Side::left});
        REQUIRE(line);
        SampleReader reader{hand::GloveDriver::start(line->port())};
        REQUIRE(test::eventually([&] { return reader.next() != nullptr; }));
        const hand::GloveIdentity identity = reader.driver.report().identity;
        REQUIRE(identity.sensors == sensors);

        // Calibration, written to a file and read back.
        const hand::CalibrationResult made = calibrated(*line, reader);
        CHECK(made.score > 0.5);
        content::GloveCalibration stored;
        stored.trainee = "Ada";
        stored.hand = identity.side;
        stored.sensors = identity.sensors;
        stored.date = "2026-11-22";
        stored.quality = made.score;
        stored.calibration = made.calibration;
        const test::Folder folder;
        const auto path = content::glove_calibration_path(folder.path(), stored.trainee, stored.hand);
        REQUIRE(content::save_glove_calibration(path, stored));
        const auto loaded = content::load_glove_calibration(path);
        REQUIRE(loaded);
        for (const Sensor sensor : hand::sensors_of(sensors)) {
            const auto& found = loaded->calibration.fits[hand::index(sensor)];
            if (sensor == Sensor::wrist_pitch || sensor == Sensor::wrist_yaw) continue;
            REQUIRE(found);
            CHECK(found->gain == doctest::Approx(truth(hand::index(sensor)).gain).epsilon(0.05));
        }

        // The hand closes on a bar, then the glove is lost.
        hand::GloveWearer wearer;
        wearer.calibration = loaded->calibration;
        wearer.hand = hand::make_hand(loaded->hand, loaded->hand_length);
        hand::MeasuredHand worn;
        hand::GraspState grasp;
        const grasp_test::TestTool bar = grasp_test::bar();
        Pose wrist = grasp_test::across_the_palm();
        if (!right) wrist = hand::mirrored(wrist);  // the bar is symmetric
        hand::GraspEvent last_event = hand::GraspEvent::none;
        const auto turn = [&] {
            const hand::GloveSample* sample = reader.next();
            if (sample != nullptr) hand::update(worn, wearer, sample->frame, sample->time);
            const hand::GraspEvent now =
                update_grasp(grasp, {}, bar.tool, wearer.hand, {sample != nullptr, worn.angles, wrist}, 0.01);
            if (now != hand::GraspEvent::none) last_event = now;
        };
        line->set_raw(raw_of(hand::Angles{}));
        REQUIRE(test::eventually([&] {
            turn();
            return grasp.has_frame && std::abs(worn.angles.fingers[1].pip) < 0.03;
        }));
        CHECK(!grasp.held);
        const hand::Angles fist = grasp_test::closed(1.0);
        line->set_raw(raw_of(fist));
        REQUIRE(test::eventually([&] {
            turn();
            return grasp.held && !grasp.lost && worn.angles.fingers[1].pip > fist.fingers[1].pip - 0.05;
        }));
        // The measured angles are those of the hand within the glove's resolution; the displayed fingers stop
        // at the bar.
        CHECK(worn.angles.fingers[2].mcp == doctest::Approx(fist.fingers[2].mcp).epsilon(0.03));
        CHECK(worn.angles.thumb.roll == doctest::Approx(fist.thumb.roll).epsilon(0.03));
        for (std::size_t d = 1; d < hand::digit_count; ++d) {
            CHECK(grasp.closure.digits[d].touches);
            CHECK(grasp.closure.angles.fingers[d - 1].mcp < 0.8 * worn.angles.fingers[d - 1].mcp);
        }
        line->stall(true);
        REQUIRE(test::eventually([&] {
            turn();
            return grasp.lost;
        }));
        for (int i = 0; i < 100; ++i) turn();
        CHECK(grasp.held);
        CHECK(last_event == hand::GraspEvent::glove_lost);
        line->stall(false);
        REQUIRE(test::eventually([&] {
            turn();
            return !grasp.lost;
        }));
        CHECK(grasp.held);
        line->set_raw(raw_of(hand::Angles{}));
        REQUIRE(test::eventually([&] {
            turn();
            return !grasp.held;
        }));
    }
}

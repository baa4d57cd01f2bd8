#include "game/station/wearer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "content/trainee/settings.hpp"
#include "game/session/contact_models.hpp"
#include "haptics/device/device.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::station_setup {

namespace {

namespace fs = std::filesystem;

constexpr int longest_latency_timer = 2;  // ms
constexpr double patience = 6.0;          // s; the handshake sends each query three times before it gives up

// For a right hand of average size: offset, m, and rotation of a flat bar along x, such as a handle, from the
// wrist when the fingers enclose it.
constexpr Vec3 handle_at(0.0, -0.028, -0.098);
constexpr double across = to_radians(-17.5);
constexpr std::array closed_so_far{0.7, 0.8, 0.9, 1.0};  // shares of a full closure; people do not clench

// Offsets to try, m, nearest first: a thin handle lies deeper in the fingers.
std::vector<Vec3> places() {
    std::vector<Vec3> all;
    for (int y = -3; y <= 3; ++y)
        for (int z = -4; z <= 4; ++z) all.emplace_back(0.0, 0.004 * y, 0.005 * z);
    std::stable_sort(all.begin(), all.end(),
                     [](const Vec3& a, const Vec3& b) { return glm::length(a) < glm::length(b); });
    return all;
}

Pose wrist_at(const hand::Hand& hand, const Vec3& off, double along) {
    Pose wrist = inverse(Pose{hand.scale * (handle_at + off), rotation({0.0, across, 0.0})});
    if (hand.side == hand::Side::left) {
        // Mirrored in the handle's length, and turned about its thickness so that the thumb points to the
        // jaw.
        const Quat& q = wrist.orientation;
        const Pose mirrored{wrist.position * Vec3(-1.0, 1.0, 1.0), Quat(q.w, q.x, -q.y, -q.z)};
        wrist = Pose{Vec3(0.0), rotation({0.0, pi, 0.0})} * mirrored;
    }
    // The thickness of the handle is the jaw's normal.
    return Pose{Vec3(along, 0.0, 0.0), rotation({0.5 * pi, 0.0, 0.0})} * wrist;
}

const char* name(hand::Side hand) { return hand == hand::Side::left ? "left" : "right"; }

}  // namespace

Result<fs::path> calibrations_folder() {
    BOLT_TRY_ASSIGN(const auto data, content::data_folder());
    return data / "gloves";
}

Result<hand::GloveIdentity> await_glove(hand::GloveDriver& driver, const fs::path& port) {
    const device::Timer timer = device::steady_timer();
    const double until = timer.now() + patience;
    while (driver.sample().number == 0) {
        const hand::GloveReport& report = driver.report();
        const bool told = report.trouble[0] != '\0';
        // Fails at once if the port cannot be opened or another device answers; waits while there is no
        // answer.
        if ((told && report.state == hand::GloveState::rejected) ||
            (told && !report.open && report.openings == 0) || timer.now() > until)
            return fail(ErrorCode::no_device,
                        fmt::format("{}: {}", port.string(), told ? report.trouble.data() : "no answer"),
                        told ? "" : "a CyberGlove that is switched on");
        timer.wait(0.01);
    }
    return driver.report().identity;
}

std::string about_adapter(const fs::path& port) {
    const auto ms = hand::latency_timer_ms(port);
    if (!ms || *ms <= longest_latency_timer) return {};
    return fmt::format(
        "its adapter gathers bytes for {} ms: install the udev rule (60-boltwright.rules) and plug it in "
        "again",
        *ms);
}

Result<content::GloveCalibration> calibration_of(const std::string& trainee, const hand::GloveIdentity& glove,
                                                 const fs::path& folder) {
    BOLT_TRY_ASSIGN(const auto where, folder.empty() ? calibrations_folder() : folder);
    const fs::path path = content::glove_calibration_path(where, trainee, glove.hand);
    const std::string make = fmt::format("`boltwright glove calibrate --trainee \"{}\"` makes one", trainee);
    std::error_code failed;
    if (!fs::exists(path, failed))
        return fail(ErrorCode::bad_content,
                    fmt::format("no calibration of {}'s {} hand is kept in {}", trainee, name(glove.hand),
                                where.string()),
                    make);
    Result<content::GloveCalibration> kept = content::load_glove_calibration(path);
    if (kept && kept->sensors != glove.sensors)
        return fail(ErrorCode::bad_content,
                    fmt::format("{} is of a glove with {} sensors, and this one has {}", path.string(),
                                kept->sensors, glove.sensors),
                    make);
    return kept;
}

Pose wrist_at_handle(const hand::Hand& hand, const collision::ToolShape& tool, double along) {
    Pose best;
    int most = -1;
    for (const Vec3& off : places()) {
        const Pose wrist = wrist_at(hand, off, along);
        int held = 0;
        for (const double share : closed_so_far) {
            hand::GraspState grip;
            hand::update_grasp(grip, {}, tool, hand, {true, hand::closed_hand_angles(share), wrist}, 0.01);
            held += grip.grasping ? 1 : 0;
        }
        if (held <= most) continue;
        most = held;
        best = wrist;
    }
    return best;
}

Result<station::HandSetup> hand_plan(const content::Assembly& assembly,
                                     const content::GloveCalibration& calibration) {
    BOLT_TRY_ASSIGN(auto tool, session::load_wrench(assembly));
    hand::GloveWearer wearer;
    wearer.calibration = calibration.calibration;
    wearer.hand = hand::make_hand(calibration.hand, calibration.hand_length);
    const Pose wrist = wrist_at_handle(wearer.hand, tool, assembly.wrench.handle_length);
    return station::HandSetup{std::move(wearer), std::move(tool), wrist, {}};
}

}  // namespace bolt::station_setup

#include "game/station/wearer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "content/trainee/data_folder.hpp"
#include "game/play/touch_models.hpp"
#include "haptics/device/timer.hpp"
#include "haptics/glove/adapter.hpp"
#include "haptics/hand/closing.hpp"

namespace bolt::station {

namespace {

namespace fs = std::filesystem;

constexpr int quick = 2;          // ms: what an adapter may gather
constexpr double patience = 6.0;  // s: a glove is asked each question three times before it is given up

// Of a right hand of the usual size: a flat bar along x, as a wrench's handle is, lies so far below and ahead
// of the wrist when fingers reach round it, and so far across.
constexpr Vec3 handle_at(0.0, -0.028, -0.098);
constexpr double across = to_radians(-17.5);
constexpr std::array closed_so_far{0.7, 0.8, 0.9, 1.0};  // people do not clench

// Where else it is tried, what is nearest first: a thin handle lies deeper in the fingers.
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

const char* name(glove::Hand hand) { return hand == glove::Hand::left ? "left" : "right"; }

}  // namespace

Result<fs::path> calibrations_folder() {
    const Result<fs::path> data = content::data_folder();
    if (!data) return fail(data.error());
    return *data / "gloves";
}

Result<glove::Identity> await_glove(glove::Driver& driver, const fs::path& port) {
    const device::Timer timer = device::steady_timer();
    const double until = timer.now() + patience;
    while (driver.sample().number == 0) {
        const glove::Report& report = driver.report();
        const bool told = report.trouble[0] != '\0';
        // A port that cannot be opened or a line that is no glove's is said at once; silence is waited for.
        if ((told && report.state == glove::State::refused) ||
            (told && !report.open && report.openings == 0) || timer.now() > until)
            return fail(ErrorCode::no_device,
                        fmt::format("{}: {}", port.string(), told ? report.trouble.data() : "no answer"),
                        told ? "" : "a CyberGlove that is switched on");
        timer.wait(0.01);
    }
    return driver.report().identity;
}

std::string about_adapter(const fs::path& port) {
    const auto ms = glove::gathers_ms(port);
    if (!ms || *ms <= quick) return {};
    return fmt::format(
        "its adapter gathers bytes for {} ms: install the udev rule (60-boltwright.rules) and plug it in "
        "again",
        *ms);
}

Result<content::GloveCalibration> calibration_of(const std::string& trainee, const glove::Identity& glove,
                                                 const fs::path& folder) {
    const Result<fs::path> where = folder.empty() ? calibrations_folder() : folder;
    if (!where) return fail(where.error());
    const fs::path path = content::glove_calibration_path(*where, trainee, glove.hand);
    const std::string make = fmt::format("`boltwright glove calibrate --trainee \"{}\"` makes one", trainee);
    std::error_code failed;
    if (!fs::exists(path, failed))
        return fail(ErrorCode::bad_content,
                    fmt::format("no calibration of {}'s {} hand is kept in {}", trainee, name(glove.hand),
                                where->string()),
                    make);
    Result<content::GloveCalibration> kept = content::load_glove_calibration(path);
    if (kept && kept->sensors != glove.sensors)
        return fail(ErrorCode::bad_content,
                    fmt::format("{} is of a glove with {} sensors, and this one has {}", path.string(),
                                kept->sensors, glove.sensors),
                    make);
    return kept;
}

Pose wrist_at_handle(const hand::Hand& hand, const contact::ToolShape& tool, double along) {
    Pose best;
    int most = -1;
    for (const Vec3& off : places()) {
        const Pose wrist = wrist_at(hand, off, along);
        int held = 0;
        for (const double share : closed_so_far) {
            grip::Grip grip;
            grip::step(grip, {}, tool, hand, {true, hand::closing(share), wrist}, 0.01);
            held += grip.grasping ? 1 : 0;
        }
        if (held <= most) continue;
        most = held;
        best = wrist;
    }
    return best;
}

Result<HandPlan> hand_plan(const content::Assembly& assembly, const content::GloveCalibration& calibration) {
    Result<contact::ToolShape> tool = play::load_wrench(assembly);
    if (!tool) return fail(tool.error());
    glove::Wearer wearer;
    wearer.calibration = calibration.calibration;
    wearer.hand = hand::make_hand(glove::side_of(calibration.hand), calibration.hand_length);
    const Pose wrist = wrist_at_handle(wearer.hand, *tool, assembly.wrench.handle_length);
    return HandPlan{std::move(wearer), std::move(*tool), wrist, {}};
}

}  // namespace bolt::station

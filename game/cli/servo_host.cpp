#include "game/cli/servo_host.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cmath>
#include <thread>

#include "content/format/assembly.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/servo_setup.hpp"
#include "haptics/servo/thread.hpp"

namespace bolt::cli {

namespace {

// A hand that puts the wrench on the first nut once a second, eight degrees off, so that it stands on top,
// and lifts it again: obstacles, god-object, guiding and output stage are all at work.
servo::Input working(const servo::Setup& setup, const servo::State& state) {
    const servo::NutGeometry& nut = setup.nuts.front();
    const double time = static_cast<double>(state.tick) * setup.dt;
    const Vec3 at = servo::nut_centre(nut, 0.0) + nut.axis * (0.014 + 0.012 * std::cos(2.0 * pi * time));
    // Away from the casing: out over the flange's edge.
    const double handle = setup.wrench.head_angle + to_radians(8.0) + (nut.seat.z > 0.0 ? 0.5 : 1.5) * pi;
    const double nearest =
        std::round(handle / (pi / 3.0)) * (pi / 3.0) + setup.wrench.head_angle + to_radians(8.0);
    const Vec3 x = std::cos(-nearest) * nut.e1 + std::sin(-nearest) * nut.e2;
    const Quat q = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
    servo::Input input;
    input.device = servo::sample_of({at, q});
    input.grip = servo::Grip::wrench;
    input.enabled = true;
    input.guide = 0;
    return input;
}

std::string describe(const servo::ThreadPrivileges& granted) {
    std::string text;
    if (granted.priority > 0) text += fmt::format("  real-time priority {} (SCHED_FIFO)\n", granted.priority);
    if (granted.memory_locked) text += "  memory is locked\n";
    for (const std::string& refused : granted.refused) text += "  " + refused + "\n";
    return text;
}

}  // namespace

Result<std::string> examine_servo(double seconds, const std::string& assembly) {
    const content::Loaded loaded = content::load_assembly(assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    std::string text;
    std::optional<servo::ToolContact> touch;  // made once: it takes seconds
    for (const double rate : {1000.0, 4000.0}) {
        const servo::Setup setup =
            session::make_setup(loaded.assembly, loaded.assembly.law, force::OutputLimits{}, 0, 1.0 / rate);
        servo::State state = servo::initial_state(setup);
        if (!touch) {
            BOLT_TRY_ASSIGN(auto made, session::load_tool_contact(loaded.assembly, setup));
            touch = std::move(made);
        }
        if (touch) servo::set_coupling(setup, *touch);
        state.tool_contact = std::move(touch);
        servo::tick(setup, state, working(setup, state));  // the first one proves everything anew
        servo::ThreadOptions options;
        options.rate = rate;
        BOLT_TRY_ASSIGN(auto thread, servo::Thread::start(options, [&](const servo::Deadline&) {
                            servo::tick(setup, state, working(setup, state));
                            return true;
                        }));
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        thread.stop();
        if (text.empty()) text = describe(thread.privileges());
        touch = std::move(state.tool_contact);
        const servo::HostAssessment assessment = servo::assess_host(thread.timing(), rate);
        text += fmt::format("  at {:.0f} ticks a second this machine is {}\n", rate,
                            assessment.adequate ? "good enough" : "NOT good enough");
        for (const std::string& reason : assessment.reasons) text += "    " + reason + "\n";
        text += servo::describe(thread.timing());
    }
    return text;
}

}  // namespace bolt::cli

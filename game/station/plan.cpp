#include "game/station/plan.hpp"

#include <algorithm>
#include <utility>

#include "content/station/wheel_config_file.hpp"
#include "game/motion/path_planning.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/nut_views.hpp"
#include "game/session/servo_setup.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/hand/glove_driver.hpp"

namespace bolt::station_setup {

namespace {

constexpr double stroke = to_radians(30.0);  // rad of free swing that the handle needs
constexpr double clearance = 1e-3;           // m below the wrench

// The initial state of the servo. Built before a device is opened: it takes seconds, in which the device
// would time out.
struct Worked {
    content::Assembly assembly;
    std::uint64_t seed = 0;
    std::vector<joint::JointState> joints;
    std::optional<servo::ToolContact> touch;

    [[nodiscard]] servo::Setup setup(const force::OutputLimits& limits, double dt) const {
        return session::make_setup(assembly, assembly.law, limits, seed, dt);
    }
    // Call it once; it moves the obstacles out.
    servo::State begin(const servo::Setup& setup) {
        servo::State state = servo::initial_state(setup);
        state.joints = joints;
        if (touch) servo::set_coupling(setup, *touch);
        state.tool_contact = std::exchange(touch, std::nullopt);
        return state;
    }
};

Status open_glove(const content::Assembly& assembly, const Wanted& wanted, Planned& planned) {
    if (wanted.glove.empty()) return {};
    planned.glove = planned.plan.glove = wanted.glove;
    BOLT_TRY(hand::check_port_access(wanted.glove));
    hand::GloveDriver driver = hand::GloveDriver::start(wanted.glove);
    BOLT_TRY_ASSIGN(const auto glove, await_glove(driver, wanted.glove));
    if (wanted.trainee.empty()) return {};
    BOLT_TRY_ASSIGN(const auto worn, calibration_of(wanted.trainee, glove, wanted.calibrations));
    BOLT_TRY_ASSIGN(auto hand, hand_plan(assembly, worn));
    planned.worn = worn;
    planned.plan.hand = std::move(hand);
    return {};
}

Status choose_devices(const Wanted& wanted, Planned& planned) {
    device::WheelConfig rig;
    if (!wanted.rig.empty()) {
        BOLT_TRY_ASSIGN(const auto read, content::load_wheel_config(wanted.rig));
        rig = read;
    }
    const Result<Choice> choice = choose(device::list_devices(true), wanted.devices);
    if (!choice) return fail(choice.error());
    planned.choice = *choice;
    if (choice->mover) planned.plan.mover = device::factory_for(choice->mover->id, rig);
    if (choice->wheel) planned.plan.wheel = device::factory_for(choice->wheel->id, rig);
    if (!choice->mover) planned.plan.mover = wanted.otherwise;
    return {};
}

}  // namespace

Pose wrench_on_nut(const servo::Setup& setup, const servo::ToolContact* touch, std::size_t joint,
                   double nut_angle) {
    const motion::GripAngle grip =
        motion::choose_grip(setup, touch, joint, nut_angle, nut_angle, 1.0, stroke);
    const servo::NutGeometry& nut = setup.nuts[joint];
    // Raises a head that is thicker than the nut, so that it does not penetrate the nut's seat.
    const double above = std::max(0.0, 0.5 * (setup.wrench.jaw.thickness - nut.height) + clearance);
    return {servo::nut_centre(nut, nut_angle) + above * nut.axis,
            motion::orientation_of(nut, grip.handle, grip.flipped)};
}

Result<Planned> make_plan(const content::Assembly& assembly, const Wanted& wanted) {
    Planned planned;
    BOLT_TRY(choose_devices(wanted, planned));
    BOLT_TRY(open_glove(assembly, wanted, planned));

    const auto worked = std::make_shared<Worked>();
    worked->assembly = assembly;
    worked->seed = wanted.seed;
    const servo::Setup setup = worked->setup({}, 1.0 / planned.plan.servo.rate);
    servo::State state = servo::initial_state(setup);
    if (wanted.tight) BOLT_TRY(session::pretighten(assembly, setup, state));
    worked->joints = state.joints;
    if (wanted.obstacles) {
        Result<std::optional<servo::ToolContact>> touch = session::load_tool_contact(assembly, setup);
        if (!touch) return fail(touch.error());
        worked->touch = std::move(*touch);
        if (worked->touch && wanted.tight) session::seat_nuts(setup, *worked->touch);
    }
    planned.obstacles = worked->touch.has_value();
    planned.plan.home = wrench_on_nut(setup, worked->touch ? &*worked->touch : nullptr, wanted.joint,
                                      state.joints[wanted.joint].nut.angle);
    planned.plan.setup = [worked](const force::OutputLimits& limits, double dt) {
        return worked->setup(limits, dt);
    };
    planned.plan.state = [worked](const servo::Setup& made) -> Result<servo::State> {
        return worked->begin(made);
    };
    return planned;
}

Result<Planned> plan_lesson(const content::Assembly& assembly, const session::CourseOptions& course,
                            const Wanted& wanted, const Pose& home) {
    struct Begins {
        session::CourseOptions options;
        session::Prepared at;
    };
    Planned planned;
    BOLT_TRY(choose_devices(wanted, planned));
    BOLT_TRY(open_glove(assembly, wanted, planned));
    BOLT_TRY_ASSIGN(auto prepared, session::prepare(assembly, course));
    const auto begins = std::make_shared<Begins>(Begins{course, std::move(prepared)});
    planned.obstacles = begins->at.state.tool_contact.has_value();
    planned.plan.home = home;
    planned.plan.servo.rate = 1.0 / course.dt;
    planned.plan.setup = [begins, scale = wanted.force_scale](const force::OutputLimits& limits, double) {
        begins->options.device = force::scaled(limits, scale);
        session::use_device(begins->options, begins->at);
        return begins->at.setup;
    };
    planned.plan.state = [begins](const servo::Setup&) -> Result<servo::State> {
        return std::move(begins->at.state);
    };
    return planned;
}

}  // namespace bolt::station_setup

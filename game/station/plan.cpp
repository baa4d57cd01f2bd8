#include "game/station/plan.hpp"

#include <algorithm>
#include <utility>

#include "content/station/rig_file.hpp"
#include "game/operators/around.hpp"
#include "game/operators/mind.hpp"
#include "game/play/nut_views.hpp"
#include "game/play/servo_setup.hpp"
#include "game/play/touch_models.hpp"
#include "haptics/force/scaled.hpp"
#include "haptics/glove/adapter.hpp"

namespace bolt::station {

namespace {

constexpr double stroke = to_radians(30.0);  // that the handle is to have room for
constexpr double clearance = 1e-3;           // m, under the wrench

// What the servo begins with. Made before there is a device: it takes seconds, in which one would be silent.
struct Worked {
    content::Assembly assembly;
    std::uint64_t seed = 0;
    std::vector<joint::JointState> joints;
    std::optional<servo::Touch> touch;

    [[nodiscard]] servo::Setup setup(const force::OutputLimits& limits, double dt) const {
        return play::make_setup(assembly, assembly.law, limits, seed, dt);
    }
    // Once: the obstacles go with it.
    servo::State begin(const servo::Setup& setup) {
        servo::State state = servo::initial_state(setup);
        state.joints = joints;
        if (touch) servo::set_coupling(setup, *touch);
        state.touch = std::exchange(touch, std::nullopt);
        return state;
    }
};

Status open_glove(const content::Assembly& assembly, const Wanted& wanted, Planned& planned) {
    if (wanted.glove.empty()) return {};
    planned.glove = planned.plan.glove = wanted.glove;
    if (Status may = glove::may_use(wanted.glove); !may) return may;
    glove::Driver driver = glove::Driver::start(wanted.glove);
    const Result<glove::Identity> glove = await_glove(driver, wanted.glove);
    if (!glove) return fail(glove.error());
    if (wanted.trainee.empty()) return {};
    const auto worn = calibration_of(wanted.trainee, *glove, wanted.calibrations);
    if (!worn) return fail(worn.error());
    Result<HandPlan> hand = hand_plan(assembly, *worn);
    if (!hand) return fail(hand.error());
    planned.worn = *worn;
    planned.plan.hand = std::move(*hand);
    return {};
}

Status choose_devices(const Wanted& wanted, Planned& planned) {
    device::Rig rig;
    if (!wanted.rig.empty()) {
        const Result<device::Rig> read = content::load_rig(wanted.rig);
        if (!read) return fail(read.error());
        rig = *read;
    }
    const Result<Choice> choice = choose(device::list(true), wanted.devices);
    if (!choice) return fail(choice.error());
    planned.choice = *choice;
    if (choice->mover) planned.plan.mover = device::opener(choice->mover->id, rig);
    if (choice->wheel) planned.plan.wheel = device::opener(choice->wheel->id, rig);
    if (!choice->mover) planned.plan.mover = wanted.otherwise;
    return {};
}

}  // namespace

Pose wrench_on_nut(const servo::Setup& setup, const servo::Touch* touch, std::size_t joint,
                   double nut_angle) {
    const operators::GripAngle grip =
        operators::choose_grip(setup, touch, joint, nut_angle, nut_angle, 1.0, stroke);
    const servo::NutPlace& nut = setup.nuts[joint];
    // A head that is thicker than the nut is high does not lie in what the nut lies on.
    const double above = std::max(0.0, 0.5 * (setup.wrench.jaw.thickness - nut.height) + clearance);
    return {servo::nut_centre(nut, nut_angle) + above * nut.axis,
            operators::orientation_of(nut, grip.handle, grip.flipped)};
}

Result<Planned> make_plan(const content::Assembly& assembly, const Wanted& wanted) {
    Planned planned;
    if (Status chosen = choose_devices(wanted, planned); !chosen) return fail(chosen.error());
    if (Status worn = open_glove(assembly, wanted, planned); !worn) return fail(worn.error());

    const auto worked = std::make_shared<Worked>();
    worked->assembly = assembly;
    worked->seed = wanted.seed;
    const servo::Setup setup = worked->setup({}, 1.0 / planned.plan.servo.rate);
    servo::State state = servo::initial_state(setup);
    if (wanted.tight)
        if (Status tight = play::pretighten(assembly, setup, state); !tight) return fail(tight.error());
    worked->joints = state.joints;
    if (wanted.obstacles) {
        Result<std::optional<servo::Touch>> touch = play::load_touch(assembly, setup);
        if (!touch) return fail(touch.error());
        worked->touch = std::move(*touch);
        if (worked->touch && wanted.tight) play::seat_nuts(setup, *worked->touch);
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

Result<Planned> plan_lesson(const content::Assembly& assembly, const play::CourseOptions& course,
                            const Wanted& wanted, const Pose& home) {
    struct Begins {
        play::CourseOptions options;
        play::Prepared at;
    };
    Planned planned;
    if (Status chosen = choose_devices(wanted, planned); !chosen) return fail(chosen.error());
    if (Status worn = open_glove(assembly, wanted, planned); !worn) return fail(worn.error());
    Result<play::Prepared> prepared = play::prepare(assembly, course);
    if (!prepared) return fail(prepared.error());
    const auto begins = std::make_shared<Begins>(Begins{course, std::move(*prepared)});
    planned.obstacles = begins->at.state.touch.has_value();
    planned.plan.home = home;
    planned.plan.servo.rate = 1.0 / course.dt;
    planned.plan.setup = [begins, scale = wanted.force_scale](const force::OutputLimits& limits, double) {
        begins->options.device = force::scaled(limits, scale);
        play::use_device(begins->options, begins->at);
        return begins->at.setup;
    };
    planned.plan.state = [begins](const servo::Setup&) -> Result<servo::State> {
        return std::move(begins->at.state);
    };
    return planned;
}

}  // namespace bolt::station

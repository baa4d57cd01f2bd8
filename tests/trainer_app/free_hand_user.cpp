#include "tests/trainer_app/free_hand_user.hpp"

#include <algorithm>

#include "haptics/collision/jaw.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::test {

using namespace trainer;

namespace {

const glm::dvec2 nowhere(2.0, 2.0);  // px, a corner of the picture
constexpr double gain = 0.25;        // of the visible error that one frame corrects
constexpr double hover = 0.03;       // m above the nut
constexpr double arrived = 0.008;    // m
constexpr double notch = 0.02;       // m of a wheel's notch
constexpr double pull_step = 0.03;   // rad of a frame
constexpr double aligned = to_radians(3.0);
constexpr double stroke = to_radians(50.0);

}  // namespace

Vec3 FreeHandUser::nut() const {
    const std::size_t joint = due()->joint;
    return servo::nut_centre(lesson().session->setup().nuts[joint],
                             lesson().session->state().joints[joint].nut.angle);
}

Vec3 FreeHandUser::axis() const { return lesson().session->setup().nuts[due()->joint].axis; }

Pose FreeHandUser::hand() const {
    return hand_of(lesson()).wrench ? tool_of(lesson()).pose : hand_of(lesson()).pose;
}

void FreeHandUser::hold(bool left, const std::optional<Vec3>& at) {
    if (left == left_) return;
    left_ = left;
    notches_ = 0.0;
    if (!left) return driver_.release(pointer_);
    ++presses;
    pointer_ = at ? project(driver_.screen(), *at).value_or(nowhere) : nowhere;
    driver_.press(pointer_);
}

void FreeHandUser::frame(const glm::dvec2& px, double notches) {
    pointer_ += px;
    notches_ += notches;
    const int whole = static_cast<int>(notches_);
    notches_ -= whole;
    driver_.drag(pointer_, whole);
    on_frame();
}

void FreeHandUser::drag_by(const Vec3& at, const Vec3& error) {
    const Screen screen = driver_.screen();
    const auto from = project(screen, at), to = project(screen, at + error);
    const Vec3 view = glm::normalize(at - Vec3(screen.eye.position));
    const glm::dvec2 px = from && to ? gain * (*to - *from) : glm::dvec2(0.0);
    frame(px, gain * glm::dot(error, view) / notch);
}

bool FreeHandUser::reach(double height, double longest) {
    const servo::Setup& setup = lesson().session->setup();
    const std::size_t joint = due()->joint;
    for (const double until = now() + longest; going() && due() != nullptr && now() < until;) {
        if (engaged() >= 0) return true;
        const Pose tool = hand();
        const Vec3 up = axis(), target = nut() + height * up;
        Vec3 error = target - tool.position;
        const double above = glm::dot(error, up);
        const Vec3 level = error - above * up;
        // Over the nut first, then down; from below up at once.
        if (glm::length(level) > 0.02 && above < 0.0) error = level;
        Vec3 at = tool.position;
        if (hand_of(lesson()).wrench) {
            const double length = setup.wrench.handle_length;
            const servo::NutGeometry& geometry = setup.nuts[joint];
            const collision::JawSeat seat =
                collision::seat_of(setup.wrench.jaw, servo::prism_of(geometry),
                                   servo::on_nut(geometry, lesson().session->state().joints[joint].nut.angle,
                                                 servo::at_pose(tool)));
            const Vec3 handle = tool.orientation * Vec3(length, 0.0, 0.0);
            at += handle;
            // Turning about −axis tightens; the misalignment is positive if the jaw is ahead.
            if (glm::length(level) < 0.05) error += seat.misalignment * glm::cross(up, handle);
            // A jaw that does not fit would rest on the nut: align it above.
            const bool fits = std::abs(seat.misalignment) < aligned;
            if (height == 0.0 && !fits && above > -hover && above < 0.0) error += hover * up;
        }
        if ((height > 0.0 || !hand_of(lesson()).wrench) && glm::length(error) < arrived) return true;
        drag_by(at, error);
    }
    return false;
}

void FreeHandUser::run_down() {
    if (hand_of(lesson()).wrench) {
        hold(false);
        driver_.key(platform::Key::t);
        frame();
        return;
    }
    const std::size_t joint = due()->joint, step = lesson().session->lesson().current;
    hold(true);
    if (!reach(0.0, 8.0)) return;
    hold(false);
    hold(true, nut());  // beside the nut: now the fingers close
    for (const double until = now() + 20.0;
         going() && due() != nullptr && now() < until && lesson().session->lesson().current == step &&
         lesson().session->state().joints[joint].stage == joint::Stage::navigation;)
        frame({engaged() >= 0 ? 12.0 : 0.0, 0.0});
    hold(false);
    for (int i = 0; i < 5; ++i) frame();
    hold(true);
    drag_by(hand().position, 0.1 * axis() / gain);
}

void FreeHandUser::tighten() {
    if (!hand_of(lesson()).wrench) {
        hold(false);
        driver_.key(platform::Key::home);
        hold(true, hand_of(lesson()).rest * Vec3(0.05, 0.0, 0.0));
        for (int i = 0; i < 5; ++i) frame();
        return;
    }
    hold(true);
    if (engaged() >= 0 && engaged() != static_cast<int>(due()->joint)) lift();
    if (engaged() < 0 && !(reach(hover, 10.0) && (reach(0.0, 6.0) || engaged() >= 0))) return;
    const std::size_t joint = due()->joint;
    const servo::Setup& setup = lesson().session->setup();
    double swung = 0.0;
    while (going() && due() != nullptr && due()->joint == joint && engaged() == static_cast<int>(joint) &&
           swung < stroke) {
        const double torque = lesson().session->state().joints[joint].torque;
        if (torque >= torque_share * due()->torque) {
            hold(false);
            for (int i = 0; i < 10; ++i) frame();
            lift();
            return;
        }
        const double share = std::clamp(1.0 - torque / due()->torque, 0.1, 1.0);
        const Screen screen = driver_.screen();
        const glm::dvec2 lever =
            lever_on_screen(screen, tool_of(lesson()).pose, axis(), setup.wrench.handle_length);
        swung += pull_step * share;
        frame(lever * (pull_step * share));
    }
    lift();
}

// Off the nut with the wheel, as a drag would swing the wrench.
void FreeHandUser::lift() {
    hold(true);
    for (int i = 0; i < 60 && going() && engaged() >= 0; ++i) frame({}, -0.5);
    for (int i = 0; i < 4 && going(); ++i) frame({}, -0.5);
}

void FreeHandUser::play(double longest, std::size_t steps) {
    while (going() && now() < longest && lesson().session->lesson().current < steps) {
        if (due() == nullptr)
            frame();
        else if (due()->kind == lesson::StepKind::run_down)
            run_down();
        else
            tighten();
    }
    hold(false);
}

}  // namespace bolt::test

#include "tests/trainer_app/free_hand_user.hpp"

#include <algorithm>

#include "game/lesson/step_requirements.hpp"
#include "haptics/collision/jaw.hpp"
#include "haptics/servo/engagement.hpp"

namespace bolt::test {

using namespace trainer;

namespace {

constexpr double correction = 5.0;           // 1/s, rate at which the visible error is corrected
constexpr double largest_correction = 0.35;  // of the error in a frame, because the arm follows late
constexpr double hand_speed = 0.35;          // m/s
constexpr double hand_turn = 2.0;            // rad/s
constexpr double notch = 0.02;               // m of a wheel's notch in the air
constexpr double notch_on_bolt = 0.01;       // m, also beside a bolt
constexpr double aligned = to_radians(4.0), turned_well = to_radians(2.0), askew = to_radians(10.0);
constexpr double level_error = 0.004;        // m beside the bolt's axis at which the jaw may go down
constexpr double max_hover = 0.045;          // m above the nut
constexpr double pull_speed = 0.6;           // rad/s of the handle
constexpr double slowest_pull = 0.08;        // of pull_speed
constexpr double stroke = to_radians(50.0);  // rad
constexpr double push_speed = 0.03;          // m/s
constexpr double settled = 0.1e-3, settled_time = 0.5;  // m and s
constexpr double lift_speed = 0.15;                     // m/s
constexpr double spin_rate = 20.0;                      // notches/s of the wheel
constexpr double margin = 0.04;                         // of the picture, in which the pointer presses anew
constexpr double rises[] = {0.13, 0.25,
                            0.45};  // m above the start and the nut, where no bolt turns the wrench

}  // namespace

bool FreeHandUser::going_on(std::size_t joint) const {
    return going() && due() != nullptr && due()->joint == joint;
}

Vec3 FreeHandUser::nut() const {
    return servo::nut_centre(setup().nuts[due()->joint], state().joints[due()->joint].nut.angle);
}

Vec3 FreeHandUser::axis() const { return setup().nuts[due()->joint].axis; }

Pose FreeHandUser::hand() const {
    return hand_of(lesson()).wrench ? tool_of(lesson()).pose : hand_of(lesson()).pose;
}

Vec3 FreeHandUser::handle_end(const Pose& pose) const {
    return pose * Vec3(hand_of(lesson()).wrench ? setup().wrench.handle_length : 0.0, 0.0, 0.0);
}

bool FreeHandUser::beside_bolt() const {
    return hand_of(lesson()).wrench && hand_of(lesson()).nut.has_value();
}

glm::dvec2 FreeHandUser::free_place(const glm::dvec2& direction) const {
    const glm::dvec2 size = driver_.size();
    const auto nut_place = due() != nullptr ? project(driver_.projection(), nut()) : std::nullopt;
    glm::dvec2 best = 0.5 * size;
    double most = -1e9;
    for (const double x : {0.25, 0.4, 0.6, 0.75})
        for (const double y : {0.35, 0.5, 0.65}) {
            const glm::dvec2 at = glm::dvec2(x, y) * size;
            const bool on_nut = nut_place && glm::distance(at, *nut_place) < 0.2 * size.y;
            const double room = -glm::dot(at - 0.5 * size, direction) - (on_nut ? 1e3 * size.x : 0.0);
            if (room <= most) continue;
            most = room;
            best = at;
        }
    return best;
}

void FreeHandUser::hold(bool left, const std::optional<Vec3>& at, const glm::dvec2& direction) {
    if (left == left_) return;
    if (!left) turn(false);
    left_ = left;
    notches_ = 0.0;
    if (!left) return driver_.release(pointer_);
    ++presses;
    const auto place = at ? project(driver_.projection(), *at) : std::nullopt;
    pointer_ = place.value_or(free_place(direction));
    driver_.press(pointer_);
}

void FreeHandUser::turn(bool right) {
    if (right == right_) return;
    right_ = right;
    driver_.turn_button(pointer_, right);
    on_frame();
}

void FreeHandUser::frame(const glm::dvec2& px, double notches) {
    const glm::dvec2 to = pointer_ + px, size = driver_.size();
    const bool outside = to.x < margin * size.x || to.y < margin * size.y || to.x > (1.0 - margin) * size.x ||
                         to.y > (1.0 - margin) * size.y;
    if (left_ && outside && glm::length(px) > 0.0) {
        const bool right = right_;
        hold(false);
        hold(true, {}, px / glm::length(px));
        turn(right);
    }
    pointer_ = glm::clamp(pointer_ + px, glm::dvec2(0.0), size - 1.0);
    notches_ += notches;
    const int whole = static_cast<int>(notches_);
    notches_ -= whole;
    const double before = now();
    driver_.drag(pointer_, whole);
    on_frame();
    // In slow pictures a person moves slowly.
    if (going()) seconds_ = std::clamp(now() - before, 0.01, 0.1);
}

void FreeHandUser::wait(double seconds) {
    for (const double until = now() + seconds - 1e-6; going() && now() < until;) frame();
}

void FreeHandUser::drag_by(const Vec3& error) {
    turn(false);
    const Projection screen = driver_.projection();
    const Vec3 at = sees(handle_end(hand())) ? handle_end(hand()) : hand().position;
    const Vec3 view = glm::normalize(at - Vec3(screen.eye.position));
    const double length = glm::length(error);
    const double share = std::min(std::min(largest_correction, correction * seconds_),
                                  length > 0.0 ? hand_speed * seconds_ / length : 0.0);
    Vec3 across = error;
    double notches = glm::dot(error, view) / notch;
    if (beside_bolt()) {
        const Vec3& up = setup().nuts[*hand_of(lesson()).nut].axis;
        const double above = glm::dot(error, up);
        across -= above * up;
        notches = above / notch_on_bolt * (glm::dot(up, view) < 0.0 ? -1.0 : 1.0);
    }
    // To come nearer to the eye, first lift with the wheel, then drag sideways.
    if (!beside_bolt() && hand_of(lesson()).wrench && notches < -1.0) across = Vec3(0.0);
    const auto from = project(screen, at), to = project(screen, at + across);
    frame(from && to ? share * (*to - *from) : glm::dvec2(0.0), share * notches);
}

void FreeHandUser::turn_by(double angle, const Vec3& about) {
    turn(true);
    const double most = hand_turn * seconds_;
    const double share = std::min(largest_correction, correction * seconds_);
    // The lever is that of a turn about −about.
    const glm::dvec2 lever =
        lever_on_screen(driver_.projection(), hand(), about, setup().wrench.handle_length);
    frame(-std::clamp(share * angle, -most, most) * lever);
}

bool FreeHandUser::lead_to(const Pose& target, double near, double longest, bool turned) {
    const bool wrench = hand_of(lesson()).wrench;
    bool turns = false;
    for (const double until = now() + longest; going() && due() != nullptr && now() < until;) {
        if (engaged() >= 0) return false;
        const Pose tool = hand();
        const Vec3 error = handle_end(target) - handle_end(tool);
        const Vec3 normal = tool.orientation * Vec3(0.0, 0.0, 1.0);
        const double angle =
            wrench && turned ? glm::dot(normal, turn_between(tool.orientation, target.orientation)) : 0.0;
        turns = !beside_bolt() && std::abs(angle) > (turns ? turned_well : askew);
        if (!turns && glm::length(error) < near && std::abs(angle) < askew) return true;
        if (turns)
            turn_by(angle, normal);
        else
            drag_by(error);
    }
    return false;
}

bool FreeHandUser::sees(const Vec3& point) const {
    const glm::dvec2 size = driver_.size();
    const auto at = project(driver_.projection(), point);
    return at && at->x > 0.05 * size.x && at->y > 0.05 * size.y && at->x < 0.95 * size.x &&
           at->y < 0.95 * size.y;
}

// Shows the goal and the hand: the whole machine, and from further away until both are in the picture.
void FreeHandUser::look(const Vec3& goal) {
    const auto shown = [&] { return sees(goal) && sees(hand().position) && sees(handle_end(hand())); };
    if (shown()) return;
    hold(false);
    driver_.key(platform::Key::f);
    wait(0.8);
    for (int i = 0; i < 8 && going() && !shown(); ++i) {
        driver_.drag(0.5 * driver_.size(), -1);
        wait(0.3);
    }
}

void FreeHandUser::run_down() {
    if (hand_of(lesson()).wrench) {
        hold(false);
        driver_.key(platform::Key::t);
        frame();
        return;
    }
    look(nut());
    const std::size_t joint = due()->joint, step = lesson().session->lesson().current;
    hold(true);
    if (!lead_to({nut(), hand().orientation}, 0.008, 8.0) && engaged() < 0) return;
    hold(false);
    hold(true, nut());  // beside the nut: now the fingers close
    const double sense = setup().nuts[joint].sense;
    for (const double until = now() + 30.0; going_on(joint) && now() < until &&
                                            lesson().session->lesson().current == step &&
                                            state().joints[joint].stage == joint::Stage::navigation;)
        frame(glm::dvec2(0.0), engaged() >= 0 ? sense * spin_rate * seconds_ : 0.0);
    hold(false);
    wait(0.25);
    if (!going()) return;
    hold(true);
    lead_to({hand().position + 0.1 * setup().nuts[joint].axis, hand().orientation}, 0.02, 2.0);
}

void FreeHandUser::take_wrench() {
    hold(false);
    driver_.key(platform::Key::home);
    frame();
    const Vec3 beside = hand_of(lesson()).rest * Vec3(0.05, 0.0, 0.0);
    look(beside);
    hold(true, beside);
    for (int i = 0; i < 5; ++i) frame();
}

// The head is asymmetric. Each preferred angle is one at which the jaw fits unturned, because a mouse does
// not turn the wrench over.
motion::HandleAngle FreeHandUser::choose_side() const {
    const std::size_t joint = due()->joint;
    const servo::NutGeometry& geometry = setup().nuts[joint];
    const double nut_angle = state().joints[joint].nut.angle;
    const bool loosens = due()->kind == lesson::StepKind::loosen;
    const double sign = loosens ? -1.0 : 1.0;
    const Vec3 near = hand_of(lesson()).rest.position - geometry.seat;
    const double preferred = servo::angle_of(geometry, near) - 0.5 * sign * stroke;
    const auto& contact = state().tool_contact;
    std::vector<std::pair<double, motion::HandleAngle>> sides;
    for (int sixth = 0; sixth < 6; ++sixth) {
        const double fits = nut_angle + geometry.sense * setup().wrench.head_angle + sixth * pi / 3.0;
        const motion::HandleAngle side = motion::choose_handle_angle(
            setup(), contact ? &*contact : nullptr, joint, state().joints[joint], fits, sign, stroke);
        if (side.flipped) continue;
        const double off = std::abs(std::remainder(side.angle - preferred, 2.0 * pi));
        sides.emplace_back(off + 4.0 * (stroke - side.free_swing), side);
    }
    if (sides.empty()) return {preferred, false, stroke};
    std::sort(sides.begin(), sides.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    return sides[misses_ % sides.size()].second;
}

// The lowest path on which the wrench touches nothing: up, turn, across, down.
std::vector<Pose> FreeHandUser::way_to(const Pose& over) const {
    const Vec3 up = axis();
    const Pose from = hand();
    const auto& contact = state().tool_contact;
    const auto is_free = [&](const Pose& a, const Pose& b) {
        const motion::ReachPath path = motion::plan_reach(setup(), *contact, a, b, up, 0.0);
        return path.waypoints.empty() && glm::length(path.bulge) == 0.0;
    };
    std::vector<Pose> way;
    for (const double rise : rises) {
        const double height = rise + std::max(glm::dot(from.position, up), glm::dot(over.position, up));
        const auto raised = [&](const Pose& pose) {
            return pose.position + (height - glm::dot(pose.position, up)) * up;
        };
        way = {{raised(from), from.orientation},
               {raised(from), over.orientation},
               {raised(over), over.orientation},
               over};
        if (!contact) break;
        if (is_free(from, way[0]) && is_free(way[0], way[1]) && is_free(way[1], way[2]) &&
            is_free(way[2], over))
            break;
    }
    return way;
}

// Leads the wrench over the nut and onto it.
bool FreeHandUser::approach() {
    const std::size_t joint = due()->joint;
    const servo::NutGeometry& geometry = setup().nuts[joint];
    const auto& contact = state().tool_contact;
    const motion::HandleAngle side = choose_side();
    room_ = side.free_swing;
    const double nut_angle = state().joints[joint].nut.angle;
    const double height =
        contact ? motion::hover_height(setup(), *contact, joint, nut_angle, side, max_hover) : max_hover;
    const Pose seated{nut(), motion::tool_orientation(geometry, side.angle, false)};
    const Pose over{nut() + height * geometry.axis, seated.orientation};
    hold(true);
    const std::vector<Pose> way = way_to(over);
    for (std::size_t i = 0; i < way.size(); ++i)
        if (!lead_to(way[i], 0.02, 6.0, i > 0)) return engaged() == static_cast<int>(joint);
    if (!lead_to(over, 0.006, 6.0)) return engaged() == static_cast<int>(joint);
    return lower(seated);
}

bool FreeHandUser::lower(const Pose& seated) {
    const std::size_t joint = due()->joint;
    const servo::NutGeometry& geometry = setup().nuts[joint];
    const Vec3 up = geometry.axis;
    for (const double until = now() + 6.0; going_on(joint) && now() < until;) {
        if (engaged() >= 0) return engaged() == static_cast<int>(joint);
        const Pose tool = hand();
        const Vec3 error = seated.position - tool.position;
        const Vec3 level = error - glm::dot(error, up) * up;
        const collision::HeadFit seat = collision::head_fit(
            setup().wrench.head, servo::shape_of(geometry),
            servo::pose_in_nut_frame(geometry, state().joints[joint], servo::tool_pose(tool)));
        const Vec3 handle = handle_end(tool) - tool.position;
        // The misalignment is positive if the jaw is turned too far clockwise, about −axis.
        const Vec3 swing = seat.misalignment * glm::cross(up, handle);
        const bool fits = std::abs(seat.misalignment) < aligned && glm::length(level) < level_error;
        // A jaw that does not fit would rest on the nut: align it above.
        const double height =
            fits ? 0.0 : 0.8 * geometry.height + 0.5 * collision::thickness(setup().wrench.head);
        drag_by(level + swing + (glm::dot(error, up) + height) * up);
    }
    return false;
}

// Pushes the jaw down with the wheel until the overlap no longer grows, because a jaw that holds the nut by
// its edge would slip off.
void FreeHandUser::push_down() {
    hold(true);
    double most = 0.0, moved = now();
    while (going() && due() != nullptr && engaged() >= 0 && now() < moved + settled_time) {
        const double overlap = state().engagement.fit.overlap;
        if (overlap > most + settled) moved = now();
        most = std::max(most, overlap);
        frame({}, push_speed * seconds_ / notch_on_bolt);
    }
}

void FreeHandUser::tighten() {
    if (!hand_of(lesson()).wrench) return take_wrench();
    look(nut());
    const std::size_t joint = due()->joint, step = lesson().session->lesson().current;
    if (engaged() >= 0 && engaged() != static_cast<int>(joint)) lift();
    hold(true);
    if (engaged() < 0 && !approach()) {
        ++misses_;
        ++new_starts;
        return lift();
    }
    push_down();
    if (going_on(joint)) pull();
    lift();
    if (going() && lesson().session->lesson().current != step) misses_ = 0;
}

void FreeHandUser::pull() {
    const std::size_t joint = due()->joint;
    const double begin = state().engagement.hand_angle;
    double furthest = begin, moved = now();
    while (going_on(joint) && engaged() == static_cast<int>(joint)) {
        const double torque = state().joints[joint].torque, until = torque_share * due()->torque;
        const bool yields = state().joints[joint].stage == joint::Stage::yield;
        if (lesson::requires_yield(lesson().session->lesson(), *due()) ? yields : torque >= until) break;
        const double angle = state().engagement.hand_angle;
        if (angle > furthest + 0.01) furthest = angle, moved = now();
        if (angle - begin > std::min(room_, stroke) || now() > moved + 2.0) break;
        const glm::dvec2 lever =
            setup().nuts[joint].sense * lever_on_screen(driver_.projection(), tool_of(lesson()).pose, axis(),
                                                        setup().wrench.handle_length);
        frame(lever * (pull_speed * seconds_ * std::clamp(1.0 - torque / until, slowest_pull, 1.0)));
    }
    hold(false);
    wait(0.5);
}

// Lifts the wrench off the nut with the mouse wheel, because a drag would swing it, and continues until it is
// clear.
void FreeHandUser::lift() {
    if (!going()) return;
    hold(true);
    const Vec3 up = setup().nuts.front().axis;
    const double from = glm::dot(hand().position, up);
    for (const double until = now() + 1.5; going() && now() < until;) {
        if (engaged() < 0 && glm::dot(hand().position, up) > from + 0.9 * max_hover) return;
        frame({}, -lift_speed * seconds_ / notch_on_bolt);
    }
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

// What a simulated trainee intends to do about a step of the lesson, right or wrong.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/random.hpp"
#include "game/lesson/lesson.hpp"
#include "game/motion/path_planning.hpp"
#include "game/motion/visibility_model.hpp"
#include "game/trainees/human_model.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::trainees {

struct Intent {
    std::size_t step = SIZE_MAX;  // of the lesson
    std::size_t joint = 0;        // that it believes is due
    bool fingers = false;         // the nut is run down by hand
    bool loosening = false;
    bool wrong = false;           // it went to a wrong joint
    bool until_seated = false;    // it runs the nut down until it sits
    bool checks = false;          // it only wants to see the nut begin to move
    bool stops_at_yield = false;  // it means to stop where the resistance stops growing
    bool until_click = false;     // it means to stop when its torque wrench clicks
    double goal = 0.0;            // N·m at which it means to stop
    double least = 0.0;           // N·m below which it knows that it is not done
    int tries = 0;                // at this step before
    bool finished = false;        // as far as it can tell
};

// The step to work on; null: none is left. In assessment nobody says that a joint is not tight enough: who
// believes to be done goes on.
const lesson::Step* next_step(const lesson::Lesson& lesson, const Intent& intent);

// How this person goes about a step. `before`: what it meant to do last.
Intent intend(const Profile& profile, Random& random, const servo::Setup& setup, const lesson::Lesson& lesson,
              const lesson::Step& due, const Intent& before);

// All that a simulated trainee remembers between ticks, and what it sees in this one. What it does with it
// stands beside: reach.hpp, pull.hpp, operator.hpp.

// What the hand is doing. Each phase ends by choosing the next.
enum class Phase { think, look, fetch, reach, lower, settle, pull, ease, lift, spin, spin_back, done };

struct Mind {
    Profile profile;
    Random random;
    motion::Tremor tremor;
    Nerves nerves;
    Intent intent;
    Phase phase = Phase::think;
    double time = 0.0;    // s since the lesson began
    double begun = 0.0;   // s, when the phase began
    double length = 0.0;  // s that the phase takes, where it has a length
    Pose from, to;        // of the movement
    bool flipped = false;
    double handle = 0.0;         // rad, handle angle about the bolt now
    double stroke_begin = 0.0;   // rad, where this pull began
    double nut_at_stroke = 0.0;  // rad, likewise
    int vain = 0;                // pulls in a row that neither turned the nut nor made it tight

    double begin_angle = 0.0;    // rad, of the nut when it came to it
    double free_turn = 0.0;      // rad turned without resistance, loosening
    Vec3 placed{0.0};            // m, how far off the centre it put the tool
    Vec3 bulge{0.0};             // m, how far the reach goes off the straight way
    std::vector<Pose> stations;  // that it still goes to after `to`, the last first
    double room = 0.0;           // rad that the handle may swing in this pull
    double above = 0.0;          // m over the nut, where the wrench waits

    bool holds_wrench = false;
    double caught = 0.0;  // s that the wrench has been kept from where the hand means to be
    int bumps = 0;        // times in a row that it was
    int misses = 0;       // times in a row that the jaw did not slide on
    motion::Sight sight;
    motion::ViewHelp view_help;
    Vec3 looks_from{0.0};                // m, where its head is on the way to
    std::vector<lesson::Event> noticed;  // since they were last taken
    double told = -1.0;                  // share of the nut that was told last
    std::size_t told_of = SIZE_MAX;      // and of which
    Arm arm;
    Pose hand;                 // where it is
    bool gripped = false;      // it had hold of a nut in the tick before
    bool turned_back = false;  // it was caught and means to be where the wrench is
    Pose rest;                 // before the assembly, where the wrench lies and nothing is in the way

    // What can be seen at this tick.
    const servo::Setup* setup = nullptr;
    const servo::State* state = nullptr;
    const lesson::Lesson* lesson = nullptr;

    Mind(const Profile& p, std::uint64_t seed, const servo::Setup& s)
        : profile(p), random(seed, 7001), tremor(random), nerves(p.reaction, s.dt, s.wrench.stiffness) {}

    [[nodiscard]] const servo::NutGeometry& nut() const { return setup->nuts[intent.joint]; }
    [[nodiscard]] const joint::JointState& joint() const { return state->joints[intent.joint]; }
    [[nodiscard]] const servo::ToolContact* obstacles() const {
        return state->tool_contact ? &*state->tool_contact : nullptr;
    }
    [[nodiscard]] double elapsed() const { return time - begun; }
    [[nodiscard]] double progress() const { return length > 0.0 ? elapsed() / length : 1.0; }
    [[nodiscard]] bool over() const { return progress() >= 1.0; }
    [[nodiscard]] bool step_is_past() const { return intent.step != lesson->current; }
    [[nodiscard]] bool on_its_nut() const {
        return state->engagement.joint == static_cast<int>(intent.joint);
    }
    [[nodiscard]] Vec3 off_centre(double deviation) {
        return Vec3(random.normal(), random.normal(), random.normal()) * deviation;
    }

    void enter(Phase next, double seconds = 0.0) {
        phase = next;
        begun = time;
        length = seconds;
    }

    // The tool over the nut, that `high`.
    [[nodiscard]] Pose at_nut(double high) const {
        return {servo::nut_centre(nut(), joint().nut.angle) + nut().axis * high + placed,
                motion::orientation_of(nut(), handle, flipped)};
    }
};

// The reach of a simulated hand: the choice of the nut and of the path, and the reaction to an obstacle.

// m above the nut before lowering and after lifting: past the bolt's end, also where a force of a few newtons
// draws the hand down.
constexpr double hover = 0.035;

// Chooses the due step and the intent for it, and starts the reach.
void decide(Mind& mind);

// Chooses the handle angle so that the stroke is centred on the trainee's side.
void choose_grip_angle(Mind& mind);

// Starts the reach to the nut, with the head where most of the nut is visible.
void set_off(Mind& mind);

// At the end of a movement: starts the movement to the next station, if there is one, and returns whether.
bool goes_on(Mind& mind, Phase reaching);

void lift_off(Mind& mind, const Pose& pose, double seconds);

// The jaw is on the nut: the wrench's pose becomes the hand's intended pose.
void take_hold(Mind& mind);

// Takes a wrench that is caught on an obstacle off it; the next path is higher.
void notice_caught(Mind& mind, const Pose& meant, const Pose& wrench);

// A simulated hand that turns a nut: its torque grows at the trainee's rate and stops when the felt torque
// reaches the goal.

// One tick each. With a wrench, for as far as there is room to swing it; fingers, for one twist.
void pull(Mind& mind, const Feeling& felt);
void spin(Mind& mind, const Feeling& felt);

// The wrench springs back before it comes off; fingers open, the hand turns back to take hold again.
void ease(Mind& mind);
void spin_back(Mind& mind);

}  // namespace bolt::trainees

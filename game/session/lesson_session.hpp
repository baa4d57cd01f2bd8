// A recorded lesson, without pictures: its initial state, the servo that steps it, the systems that run after
// each tick, and the session file that records it. The world of components belongs to the caller, which may
// add components of its own (world::WorldWith).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "engine/base/result.hpp"
#include "engine/ecs/system.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/lesson.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/session_file.hpp"
#include "game/world/world.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::session {

// The servo's setup for an assembly. `law` may differ from the assembly's own.
servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt);

// Makes the initial state of a loosening lesson: tightens each joint without the hand, in the order of the
// assembly's last tightening pass, then lets all joints settle for 10 s. Tightening ends at the target torque
// or, with strategy `yield`, at the beginning of the yield stage if that comes first. Fails if a joint does
// not get there.
Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state);

// `if_any`: obstacles if the assembly has contact models.
enum class ObstacleUse : std::uint8_t { none, if_any, required };

// The recording of an interrupted lesson, to continue it (resume.hpp).
struct InterruptedLesson {
    std::filesystem::path file;
    Header header;
    std::uint64_t ticks = 0;  // number of recorded ticks to repeat
};

struct LessonOptions {
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    joint::Law law = joint::Law::mechanistic;
    FormatRules rules;  // today's, except in a replay of a session of an older format
    std::uint64_t seed = 1;
    double dt = 0.001;
    // Collisions of the wrench with casing, bolts and nuts (contact_models.hpp).
    ObstacleUse obstacles = ObstacleUse::none;
    bool guiding_force = true;       // in guided mode a force guides the hand to the nut
    std::string trainee_profile;     // "person", or the simulated trainee's profile: "expert", …
    std::string trainee;             // a person's code, or the text of --trainee (Header::trainee)
    std::optional<hand::Side> hand;  // the working hand; none: unknown

    // A simulated trainee requests a view of the nut, as key V does. Empty: the trainee is a person.
    std::optional<bool> view_help;
    double servo_rate = 0.0;                     // Hz, of the servo's thread; 0: virtual time
    force::OutputLimits device_limits;           // default: a large 6-DoF arm, such as a Virtuose
    std::optional<InterruptedLesson> continues;  // none: a lesson from its beginning
};

// A lesson and its servo. LessonSession begins with one from prepare_session() and then advances its state.
struct SessionSetup {
    content::Assembly assembly;  // with the options' law applied (lesson::apply_law)
    servo::Setup setup;
    servo::State state;
    std::string contact_models;  // their files with size and checksum; empty: no obstacles
    std::vector<ObstacleName> obstacle_names;
};
// Fails if the contact models are required but missing or invalid, or if a joint cannot be pretightened.
Result<SessionSetup> prepare_session(const content::Assembly& given, const LessonOptions& options);

// The header of the session file.
Header make_header(const SessionSetup& start, const LessonOptions& options);

// Replaces the device limits by those of the options. All other options must equal those of
// prepare_session().
void set_device_limits(const LessonOptions& options, SessionSetup& start);

// A lesson that follows the ticks of a servo. Without a station the session's servo is the only one. With a
// station, the station's servo computes each tick first, and the session repeats it (LessonSession::repeat).
struct LessonTracker {
    lesson::Lesson lesson;
    // Steps that have begun, less those that undo took back. The servo should have this many checkpoints
    // (servo::State::checkpoint_count), one for the beginning of each step. While the checkpoint of a new
    // step is on its way to a station's servo (a few ticks), that servo has one less; an undo then returns to
    // the start of the step before.
    std::uint32_t expected_checkpoints = 0;
};

// The input of the systems of a tick besides the world.
struct TickContext {
    world::Snapshot servo;
    const servo::Setup& setup;
    LessonTracker& tracker;
};

void haptic_system(const world::WriteHaptics& world, TickContext& tick);
// Updates the lesson from the components, and undoes its steps if the servo restored a checkpoint.
void lesson_system(const world::WriteHaptics& world, TickContext& tick);

// The schedule after each servo tick, the same for a person at a window, a simulated trainee, a replay and a
// film. A program with pictures runs more systems once a frame.
inline constexpr ecs::System<const world::WriteHaptics, TickContext> tick_systems[] = {
    {"haptics", haptic_system}, {"lesson", lesson_system}};

struct LessonOutcome {
    lesson::LessonResult result;
    bool obstacles = false;  // the wrench could collide with the assembly
};

// A lesson that a person at a window or a simulated trainee performs. Not copyable or movable, because the
// lesson refers to its assembly.
class LessonSession {
  public:
    // Records the session into `file`. session::SessionWriter keeps an existing file under another name.
    static Result<std::unique_ptr<LessonSession>> begin(const content::Assembly& given,
                                                        const LessonOptions& options,
                                                        const std::filesystem::path& file);
    static Result<std::unique_ptr<LessonSession>> begin(SessionSetup start, const LessonOptions& options,
                                                        const std::filesystem::path& file);

    // Continues the interrupted lesson LessonOptions::continues. Repeats its ticks on `world`, beginning with
    // `start`, and records them into `file`, so that `file` has the whole lesson. The interrupted recording
    // stays as it is. Fails and deletes `file` if an output differs from the recorded one or the recording is
    // damaged.
    static Result<std::unique_ptr<LessonSession>> resume(SessionSetup start, const LessonOptions& options,
                                                         const std::filesystem::path& file,
                                                         const world::WriteHaptics& world);

    LessonSession(const LessonSession&) = delete;
    LessonSession& operator=(const LessonSession&) = delete;
    ~LessonSession();  // without finish() the session file is kept and marked as cut short

    // Computes one tick and runs tick_systems on `world`, in which world::add_haptics() has created the
    // entities. Pass the same world each time. `extra_events`: additional events to record with the tick.
    // Fails if the session file cannot be written; everything written before stays readable.
    Result<servo::Output> tick(const world::WriteHaptics& world, const servo::TickInput& input,
                               std::vector<lesson::LessonEvent> extra_events = {});

    // Repeats a tick that a station's servo has computed from the same initial state, and compares the
    // outputs. Fails also if they differ, which means that one of the two missed an input.
    Status repeat(const world::WriteHaptics& world, const servo::TickInput& input,
                  const servo::Output& output);
    // All checkpoints that should have been saved since the beginning; the number never falls. It is the
    // number saved so far, plus one while that of the present step is not saved yet. tick() saves it by
    // itself; a caller of repeat() must send the station a station::SaveCheckpoint whenever this number
    // rises.
    [[nodiscard]] std::uint32_t target_checkpoints() const {
        return checkpoints_saved_ + tracker_.expected_checkpoints - session_setup_.state.checkpoint_count;
    }
    // The number of checkpoints saved since the beginning; undo does not reduce it.
    [[nodiscard]] std::uint32_t checkpoints_saved() const { return checkpoints_saved_; }
    // The tool of the due joint, for servo::TickInput::tool.
    [[nodiscard]] std::uint8_t due_tool() const;
    // Returns the value of servo::TickInput::checkpoint_action that takes the nuts back to the start of the
    // due step, or to that of the step `steps` before it. Returns 0 if that is not allowed now.
    [[nodiscard]] std::uint8_t restore_action(std::size_t steps) const;

    // In the next tick, returns the nuts and the lesson to the start of the due step (0) or of the step
    // `steps` steps earlier; possible after the last step too. Ignored in an assessment, beyond the oldest
    // checkpoint, while a nut is held or the tool is beside one (servo::TickInput::checkpoint_action), and in
    // a tick that saves a checkpoint.
    void request_undo(std::size_t steps) { requested_undo_ = steps; }

    // Events of the last tick.
    [[nodiscard]] std::span<const lesson::LessonEvent> events() const { return events_; }

    [[nodiscard]] const content::Assembly& assembly() const { return session_setup_.assembly; }
    [[nodiscard]] const servo::Setup& setup() const { return session_setup_.setup; }
    [[nodiscard]] const servo::State& state() const { return session_setup_.state; }
    [[nodiscard]] const lesson::Lesson& lesson() const { return tracker_.lesson; }
    // Time of the lesson, s.
    [[nodiscard]] double time() const {
        return static_cast<double>(session_setup_.state.tick) * session_setup_.setup.dt;
    }
    [[nodiscard]] bool finished() const { return lesson().due() == nullptr; }
    [[nodiscard]] bool obstacles() const { return session_setup_.state.tool_contact.has_value(); }
    // The names of the obstacles that servo::Output::touched can name.
    [[nodiscard]] std::span<const ObstacleName> obstacle_names() const {
        return session_setup_.obstacle_names;
    }

    // Records the timing of the station's servo thread.
    Status record_timing(const servo::Timing& timing) { return writer_->record_timing(timing); }

    [[nodiscard]] LessonOutcome outcome(const world::ReadHaptics& world) const;  // so far
    // Writes the outcome to the session file; no ticks may follow.
    Result<LessonOutcome> finish(const world::ReadHaptics& world);

  private:
    LessonSession() = default;
    Status record_events(const world::ReadHaptics& world);
    Result<servo::Output> compute_tick(const world::WriteHaptics& world, const servo::TickInput& input,
                                       std::vector<lesson::LessonEvent>&& extra_events);

    SessionSetup session_setup_;  // its state advances with each tick
    LessonTracker tracker_;
    std::uint32_t checkpoints_saved_ = 0;
    std::optional<std::size_t> requested_undo_;
    std::vector<lesson::LessonEvent> events_;
    std::optional<SessionWriter> writer_;
};

}  // namespace bolt::session

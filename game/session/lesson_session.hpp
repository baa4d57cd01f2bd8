// An assembly as the servo sees it.
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
#include "game/lesson/lesson.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/session_file.hpp"
#include "haptics/force/output_stage.hpp"
#include "haptics/servo/setup.hpp"
#include "haptics/servo/tick.hpp"

namespace bolt::session {

// `law` may differ from the assembly's own.
servo::Setup make_setup(const content::Assembly& assembly, joint::Law law, const force::OutputLimits& limits,
                        std::uint64_t seed, double dt);

// Brings every joint to its target in the order of the last pass, by machine, and lets it rest: where a
// loosening lesson begins. Fails if a joint does not get there.
Status pretighten(const content::Assembly& assembly, const servo::Setup& setup, servo::State& state);

// A lesson in progress, played by a person at a window or by a simulated trainee through the inputs of the
// servo. Each tick is stepped, observed by the lesson and recorded.

enum class Obstacles : std::uint8_t { none, if_any, required };

struct CourseOptions {
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    joint::Law law = joint::Law::mechanistic;
    std::uint64_t seed = 1;
    double dt = 0.001;
    // Whether the wrench collides with casing, bolts and nuts (contact_models.hpp); `if_any`: where they are
    // modelled.
    Obstacles obstacles = Obstacles::none;
    bool guide = true;          // a guided lesson leads the hand to the nut
    std::string operator_name;  // "person", or the simulated trainee's profile: "expert", …
    std::string trainee;        // the name given with --trainee; may be empty
    std::string hand;           // "left" or "right", the working hand; empty: unknown

    std::string view_help;               // "on", "off" for a simulated trainee; empty for a person
    std::string servo = "virtual time";  // what steps the servo, as session::Header stores it
    force::OutputLimits device;          // default: a 6-DoF arm of the Virtuose class
};

// The initial state of a lesson and its servo.
struct Prepared {
    content::Assembly assembly;  // with the options' law in force (lesson::under_law)
    servo::Setup setup;
    servo::State state;
    std::string obstacles = "none";  // contact model files, as session::Header stores them
    std::vector<session::ObstacleName> obstacle_names;
};
Result<Prepared> prepare(const content::Assembly& given, const CourseOptions& options);

// Replaces the device by `options.device`. All other options must equal those of prepare().
void use_device(const CourseOptions& options, Prepared& prepared);

// Keeps a lesson in step with ticks that this or another servo makes.
struct LessonTracker {
    lesson::Lesson lesson;
    // Number of checkpoints the nuts should have (servo::State::marked): one for the start of each step.
    // Another servo saves its checkpoint some ticks later; until then an undo goes back one lesson step more
    // than checkpoints.
    std::uint32_t begun = 0;
};

// Updates the lesson after a tick: observes the output, and steps back if the nuts were undone.
void follow(LessonTracker& tracker, const servo::State& state, const servo::Output& output);

struct Played {
    lesson::LessonResult result;
    bool obstacles = false;  // the wrench could collide with the assembly
};

// Neither copied nor moved: the lesson refers to its assembly.
class Course {
  public:
    // Records the session into `file`. session::Writer keeps a file that is already there.
    static Result<std::unique_ptr<Course>> begin(const content::Assembly& given, const CourseOptions& options,
                                                 const std::filesystem::path& file);
    static Result<std::unique_ptr<Course>> begin(Prepared prepared, const CourseOptions& options,
                                                 const std::filesystem::path& file);

    Course(const Course&) = delete;
    Course& operator=(const Course&) = delete;
    ~Course();  // without finish() the session file is kept and marked as cut short

    // One tick. `noticed`: additional events to record with it. Fails if the session file cannot be written;
    // what was written before stays readable.
    Result<servo::Output> step(const servo::Input& input, std::vector<lesson::Event> noticed = {});

    // Repeats a tick that another servo made from the same initial state. Also fails if the outputs differ:
    // then one of the two missed an input.
    Status take(const servo::Input& input, const servo::Output& output,
                std::vector<lesson::Event> noticed = {});
    // For that servo: the number of checkpoints it should have saved since the start, and the value of
    // servo::Input::undo that takes back `steps` steps (0: not allowed).
    [[nodiscard]] std::uint32_t marks() const { return kept_ + tracker_.begun - at_.state.checkpoint_count; }
    [[nodiscard]] std::uint8_t undo_by(std::size_t steps) const;

    // With the next tick the nuts and the lesson return to the start of the due step (0), or to that of
    // `steps` steps earlier, also after the last step. Ignored in an assessment, beyond the oldest
    // checkpoint, and while a nut is held or the tool is beside one (servo::Input::undo).
    void go_back(std::size_t steps) { back_ = steps; }

    // Events of the last tick.
    [[nodiscard]] std::span<const lesson::Event> events() const { return events_; }

    [[nodiscard]] const content::Assembly& assembly() const { return at_.assembly; }
    [[nodiscard]] const servo::Setup& setup() const { return at_.setup; }
    [[nodiscard]] const servo::State& state() const { return at_.state; }
    [[nodiscard]] const lesson::Lesson& lesson() const { return tracker_.lesson; }
    [[nodiscard]] double time() const { return static_cast<double>(at_.state.tick) * at_.setup.dt; }  // s
    [[nodiscard]] bool over() const { return lesson().due() == nullptr; }
    [[nodiscard]] bool obstacles() const { return at_.state.tool_contact.has_value(); }
    // Numbered as in servo::Output::touched.
    [[nodiscard]] std::span<const session::ObstacleName> obstacle_names() const { return at_.obstacle_names; }

    // Records the timing of another servo's thread.
    Status keep(const servo::Timing& timing) { return writer_->keep(timing); }

    // judged(): the result so far. finish(): the same, written to the session file; no ticks may follow.
    [[nodiscard]] Played judged() const;
    Result<Played> finish();

  private:
    Course() = default;
    Status keep_events();
    Result<servo::Output> tick(const servo::Input& input, std::vector<lesson::Event>&& noticed);

    Prepared at_;
    LessonTracker tracker_;
    std::uint32_t kept_ = 0;  // checkpoints saved since the start
    std::optional<std::size_t> back_;
    std::vector<lesson::Event> events_;
    std::optional<session::Writer> writer_;
};

}  // namespace bolt::session

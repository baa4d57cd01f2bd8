// A lesson under way, whoever plays it: a person at a window or a simulated trainee, both through the inputs
// of the servo. Every tick is stepped, watched by the lesson and recorded.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"
#include "game/lesson/lesson.hpp"
#include "game/play/touch_models.hpp"
#include "game/record/session.hpp"

namespace bolt::play {

enum class Obstacles : std::uint8_t { none, if_any, required };

struct CourseOptions {
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    joint::Law law = joint::Law::mechanistic;
    std::uint64_t seed = 1;
    double dt = 0.001;
    // Whether the wrench meets casing, bolts and nuts (touch_models.hpp); `if_any`: where they are modelled.
    Obstacles obstacles = Obstacles::none;
    bool guide = true;          // a guided lesson leads the hand to the nut
    std::string operator_name;  // "expert", …, or "person"
    std::string hand;           // "left", "right", that they work with; empty: it is not said

    std::string view_help;               // "on", "off", of who is simulated; empty: a person has it
    std::string servo = "virtual time";  // who has the ticks, for the session (record::Header)
    force::OutputLimits device;  // what a 6-DoF arm of the Virtuose class renders, unless said otherwise
};

// What a lesson begins with.
struct Prepared {
    content::Assembly assembly;  // as its law has it
    servo::Setup setup;
    servo::State state;
    std::string obstacles = "none";  // files, as record::Header has them
    std::vector<record::ObstacleName> obstacle_names;
};
Result<Prepared> prepare(const content::Assembly& given, const CourseOptions& options);

// The same for `options.device`; everything else in the options is as it was.
void use_device(const CourseOptions& options, Prepared& prepared);

// A lesson beside its ticks, wherever those are made.
struct Following {
    lesson::Lesson lesson;
    // How many marks the nuts are to have (servo::State::marked): one for the beginning of every step. Ticks
    // that are made elsewhere hear of that late; until then a step back is one of the lesson's more.
    std::uint32_t begun = 0;
};

// The lesson after a tick: it sees what happened, and goes back where the nuts did.
void follow(Following& following, const servo::State& state, const servo::Output& output);

// How a lesson came out, and what it was played among.
struct Played {
    lesson::LessonResult result;
    bool obstacles = false;
};

// Stays where it is made: the lesson looks at its assembly.
class Course {
  public:
    // Writes the session to `file` as it goes (record::Writer says what becomes of a file that is there).
    static Result<std::unique_ptr<Course>> begin(const content::Assembly& given, const CourseOptions& options,
                                                 const std::filesystem::path& file);
    static Result<std::unique_ptr<Course>> begin(Prepared prepared, const CourseOptions& options,
                                                 const std::filesystem::path& file);

    Course(const Course&) = delete;
    Course& operator=(const Course&) = delete;
    ~Course();  // without finish() the session is kept as one that was cut short

    // One tick. `noticed`: what whoever plays wants to be kept with it. An error is the session file's; what
    // was written before stays readable.
    Result<servo::Output> step(const servo::Input& input, std::vector<lesson::Event> noticed = {});

    // A tick that a servo elsewhere has made, from the same beginning: this one makes it again. Also an
    // error:
    // it does not come to the same, so one of the two was not told everything.
    Status take(const servo::Input& input, const servo::Output& output,
                std::vector<lesson::Event> noticed = {});
    // For that servo: how many marks it is to have kept since the beginning, and what undo may ask for (0:
    // nothing; servo::Input::undo).
    [[nodiscard]] std::uint32_t marks() const { return kept_ + following_.begun - at_.state.marked; }
    [[nodiscard]] std::uint8_t undo_by(std::size_t steps) const;

    // With the next tick the nuts and the lesson go back to the beginning of the due step, or to that of a
    // step before it, also when all are done. Nothing happens where the lesson allows no way back (an
    // assessment), further back than marks are kept, and as long as a nut is held or the tool is beside one
    // (servo::Input::undo).
    void go_back(std::size_t steps) { back_ = steps; }

    // What happened in the last tick.
    [[nodiscard]] std::span<const lesson::Event> events() const { return events_; }

    [[nodiscard]] const content::Assembly& assembly() const { return at_.assembly; }
    [[nodiscard]] const servo::Setup& setup() const { return at_.setup; }
    [[nodiscard]] const servo::State& state() const { return at_.state; }
    [[nodiscard]] const lesson::Lesson& lesson() const { return following_.lesson; }
    [[nodiscard]] double time() const { return static_cast<double>(at_.state.tick) * at_.setup.dt; }  // s
    [[nodiscard]] bool over() const { return lesson().due() == nullptr; }
    [[nodiscard]] bool obstacles() const { return at_.state.touch.has_value(); }
    // As servo::Output::touched numbers them.
    [[nodiscard]] std::span<const record::ObstacleName> obstacle_names() const { return at_.obstacle_names; }

    // How the thread of another servo kept its time.
    Status keep(const servo::Timing& timing) { return writer_->keep(timing); }

    // As it stands; and the same written, after which there are no more ticks.
    [[nodiscard]] Played judged() const;
    Result<Played> finish();

  private:
    Course() = default;
    Status keep_events();
    Result<servo::Output> tick(const servo::Input& input, std::vector<lesson::Event>&& noticed);

    Prepared at_;
    Following following_;
    std::uint32_t kept_ = 0;  // marks, since the beginning
    std::optional<std::size_t> back_;
    std::vector<lesson::Event> events_;
    std::optional<record::Writer> writer_;
};

}  // namespace bolt::play

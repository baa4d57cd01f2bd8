// Reads the plan of a study with people: its conditions, who gets them in which order, its forms, and its
// planned comparisons. A study is a folder with the plan, study.json, whose members
// content/schema/study.schema.json describes, and the forms, questionnaires/ID.json:
//
//   {"format": "boltwright study 1", "id": "guiding", "title": {"en": "Guiding"},
//    "information": {"en": "..."}, "consent": {"en": ["I take part."]},
//    "design": {"subjects": "within", "order": "williams", "participants": 20},
//    "lesson": {"assembly": "cover-m8"},
//    "conditions": [{"id": "with", "title": {"en": "With"}, "lesson": {"mode": "guided"}},
//                   {"id": "without", "title": {"en": "Without"}, "lesson": {"mode": "practice"}}],
//    "forms": [{"form": "paper", "when": ["after_condition"]}],
//    "comparisons": [{"measure": "paper.guidance"}]}
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "content/questionnaires/questionnaire.hpp"
#include "engine/base/result.hpp"

namespace bolt::content {

// within: each participant works in all conditions. between: each works in one of them.
enum class StudySubjects : std::uint8_t { within, between };
// The rule for the order of a participant's conditions; conditions_of() defines both.
enum class StudyOrder : std::uint8_t { williams, random };

struct StudyDesign {
    StudySubjects subjects = StudySubjects::within;
    StudyOrder order = StudyOrder::williams;  // within subjects
    std::size_t participants = 1;             // planned
    std::size_t lessons = 1;                  // lessons in each condition
    std::uint64_t seed = 1;       // of all random choices: the orders and the scatter of the joints
    bool blind = false;           // hides the conditions from the experimenter before the results
    double shortest_break = 0.0;  // s, between two conditions
    bool show_results = false;    // shows the participant the result of each lesson
};

// Settings of a lesson, with the words of the schema.
struct StudyLesson {
    std::string assembly = "zq350";
    std::string variant, tool;  // empty: the assembly's default
    std::string mode = "practice", task = "tighten";
    std::string law;  // empty: the assembly's
    std::string hand = "helped";
    std::vector<std::string> devices;  // empty: those of the command line
    // "window", "headset" or "walls". Empty: the window or the command line's (names_displays()).
    std::string display;
    std::string displays;  // of walls: the display file
    std::string glove;     // "none", "auto" or a serial port; empty: that of the command line
    // `guiding_force`: a force leads the hand to the nut in guided mode. `view_help`: the program finds a
    // view of the nut.
    bool guiding_force = true, view_help = true;
    std::optional<double> force_scale;  // none: that of the participant's settings
    bool operator==(const StudyLesson&) const = default;
};

struct StudyTraining {
    double duration = 0.0;  // s in lessons
    StudyLesson lesson;
};

struct StudyCondition {
    std::string id;
    std::map<std::string, std::string> titles;  // by language
    StudyLesson lesson;
    std::map<std::string, std::string> levels;  // by factor, such as "on" for the factor "guiding"
};

enum class FormTime : std::uint8_t {
    before,           // after consent
    after_training,   // needs a training
    after_lesson,     // after each lesson of a condition
    after_condition,  // after the last lesson of a condition
    after,            // at the end of the first visit
    retention,        // after the retention test
};
inline constexpr std::size_t form_times = static_cast<std::size_t>(FormTime::retention) + 1;
std::string_view name(FormTime time);

struct StudyForm {
    std::string id;  // of the questionnaire
    std::array<bool, form_times> at{};
    [[nodiscard]] bool is_at(FormTime time) const { return at[static_cast<std::size_t>(time)]; }
};

// The retention test: a later lesson that shows what participants have kept. It is the same for all
// conditions.
struct StudyRetention {
    double after_days = 0.0;  // earliest day of the test, from the end of the first visit
    StudyLesson lesson;
};

// Measures that every lesson has, computed from its session; the results page has their definitions.
inline constexpr std::string_view objective_measures[] = {
    "score",        "duration_s", "joints_ok",      "torque_error", "clamp_scatter", "over_torque",
    "order_errors", "bumps",      "contact_time_s", "force_rate",   "time_to_nut_s", "nut_visible"};

// One group of a comparison: a single condition, or all conditions with one level of a factor.
struct ComparedGroup {
    std::string name;                     // id of the condition, or the level
    std::vector<std::size_t> conditions;  // indices into Study::conditions
    bool operator==(const ComparedGroup&) const = default;
};

// The conditions that are in both groups.
std::vector<std::size_t> conditions_in_both(const ComparedGroup& a, const ComparedGroup& b);

struct PlannedComparison {
    std::string measure;     // one of objective_measures, or FORM.SCALE
    std::string factor;      // empty: single conditions
    bool retention = false;  // compares values of the retention test
    std::vector<ComparedGroup> groups;
    // Two times of the form, whose answers are compared; `groups` has their names and no conditions. Empty:
    // the answers in conditions are compared.
    std::vector<FormTime> times;
    // Instead of the main effect of `factor`: its interaction with this factor. Both have two levels.
    std::string interaction;
    std::vector<ComparedGroup> interaction_groups;  // the levels of `interaction`
    bool operator==(const PlannedComparison&) const = default;
};

// The mean of a measure in an earlier study. The results page prints it beside the mean of this study.
struct PublishedValue {
    std::string measure;             // FORM.SCALE
    std::optional<double> min, max;  // lowest and highest answer of that study
    double mean = 0.0;
    int decimals = 0;   // of the printed mean
    std::size_t n = 0;  // number of people
    std::string source;
};

struct Study;
// Returns true if a lesson of the study names its display. The program then changes between displays, and
// lessons without one are shown in the window. Otherwise all are shown on the display of the command line.
bool names_displays(const Study& study);

struct Study {
    std::string id;
    std::map<std::string, std::string> titles, information;   // by language
    std::map<std::string, std::vector<std::string>> consent;  // statements, by language
    StudyDesign design;
    std::optional<StudyTraining> training;
    std::vector<StudyCondition> conditions;
    std::vector<StudyForm> forms;
    std::optional<StudyRetention> retention;
    std::vector<PlannedComparison> comparisons;
    std::vector<PublishedValue> published;
    std::vector<Questionnaire> questionnaires;  // one for each of `forms`, if loaded from a folder
    std::uint64_t checksum = 0;                 // of the files' bytes; changes with every change of the plan

    // The form of a measure "FORM.SCALE"; null for an objective measure.
    [[nodiscard]] const Questionnaire* form_of(std::string_view measure) const;
};

// A study without mistakes, or all mistakes of its files, each with file, line and column.
struct LoadedStudy {
    Study study;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is used in messages. `forms`: the forms whose scales measures may name; null: scales are not
// checked.
LoadedStudy parse_study(std::string_view text, const std::string& file,
                        const std::vector<Questionnaire>* forms = nullptr);
// Reads study.json of a folder, and the forms that it names. `forms`: the folder that has ID.json of each
// form; empty: `folder`/questionnaires.
LoadedStudy load_study(const std::filesystem::path& folder, const std::filesystem::path& forms = {});

// An error about a member of the plan in `folder`, with its line and column: at the first of these JSON
// pointers that the plan has.
Error plan_error(const std::filesystem::path& folder, const std::vector<std::string>& pointers,
                 std::string what, std::string expected);

// Contradictions of a valid plan that waste participants, each with line and column: members without effect,
// factors that change together, comparisons that repeat each other (check_plan.cpp).
std::vector<Error> plan_weaknesses(const Study& study, const std::filesystem::path& folder);

// The JSON pointers for an error about a lesson's member: the lesson's own, that of the study's "lesson", the
// object `lesson`, the whole plan. `lesson`: "/training", "/retention" or "/conditions/2".
std::vector<std::string> lesson_pointers(const std::string& lesson, const std::string& member);

inline constexpr const char* study_file_name = "study.json";
inline constexpr const char* forms_folder_name = "questionnaires";

// Languages in which a participant can read everything: the title, the information, every statement of the
// consent, and every item and label of every form. A form that ships without texts is complete in no language
// until the laboratory adds them.
std::vector<std::string> complete_languages(const Study& study);

// Orders of conditions (order.cpp).

// A Williams square of `n` conditions: rows in which every condition comes directly after every other
// condition equally often and is in each position equally often. n rows, or 2 n if n is odd (E. J. Williams,
// Aust. J. Sci. Res. A 2 (1949) 149; construction: 0, 1, n − 1, 2, n − 2, ..., each next row plus 1 modulo n,
// odd n also mirrored).
std::vector<std::vector<std::size_t>> williams_square(std::size_t n);

// Returns the conditions of a participant in their order, as indices into Study::conditions. Between subjects
// there is one. `place` counts from 0 and is unique among the participants who have not withdrawn.
//   williams        the rows of the square in turn, in a random order for each repetition of the square
//   random          each block of n places gets a Latin square with randomly permuted rows and conditions
//   between         each block of n places gets each condition once, in a random order
// Deterministic in design.seed.
std::vector<std::size_t> conditions_of(const Study& study, std::size_t place);

// Number of participants after which the orders are balanced: a multiple of it is needed.
std::size_t balanced_participants(const Study& study);

}  // namespace bolt::content

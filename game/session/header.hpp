// The header of a session file: the properties of the recorded lesson, and their texts in table meta.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"
#include "game/lesson/law.hpp"
#include "game/lesson/lesson.hpp"
#include "game/lesson/result.hpp"
#include "haptics/collision/contact.hpp"
#include "haptics/force/output_limits.hpp"
#include "haptics/hand/kinematics.hpp"
#include "haptics/joint/law.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::session {

// An obstacle's name, for TickRecord::touched.
struct ObstacleName {
    collision::ObstacleId id;  // one that has a file_number (recorded_tick.hpp)
    std::string name;
};

// The kind of trainee. `unrecorded`: the session is from an older program, which did not record it.
enum class TraineeKind : std::uint8_t { unrecorded, person, simulated };

// The laws under which tools bend (servo::Wrench::yield_torque). The published law has one table of torques
// for all sizes, so its torques say nothing about the strength of a tool.
// In format 8 tools bent under both laws, and keys at less torque (tool_models::KeyStrength).
enum class ToolYield : std::uint8_t { no_law, all_laws, mechanistic_law };

// Rules of lessons and simulation that have changed with the format of session files. A replay of an older
// file keeps to the rules of its format, so that it gives the same bits. The defaults are today's rules.
struct FormatRules {
    lesson::LawAdaptation law_adaptation = lesson::LawAdaptation::yield_end;
    ToolYield tools_yield = ToolYield::mechanistic_law;  // before format 8: no_law; in format 8: all_laws
    bool judges_tool_choice = true;                      // since format 9
    // Members of servo::Setup.
    bool rounds_all_loaded_corners = true;  // since format 10
    bool allows_narrow_gaps = true;         // since format 11
    bool renders_tool_in_use = true;        // since format 11
};

// The properties of a recorded lesson. The file stores them as text (header.cpp).
struct Header {
    std::string assembly;       // name
    std::string assembly_file;  // path as given by the user, for messages
    std::string assembly_text;  // the file's exact text, so that a session replays without the folder
    std::string variant;
    joint::Law law = joint::Law::mechanistic;
    FormatRules rules;  // not stored: they follow from the format of the file
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    // "person", or the simulated trainee's profile: "expert", … The key in the file is "operator".
    std::string trainee_profile;
    std::uint64_t seed = 0;
    double dt = 0.001;    // s
    std::string program;  // name and version of the writing program

    // Further inputs of the ticks; none in format 1, which lacks them.
    std::optional<bool> guiding_force;          // the guiding force towards the due joint
    std::optional<std::string> contact_models;  // their files with size and checksum; empty: no obstacles
    std::optional<force::OutputLimits> device_limits;
    std::optional<double> servo_rate;  // Hz, of the servo's thread; 0: virtual time
    std::vector<ObstacleName> obstacle_names;

    std::optional<bool> view_help;   // only of a simulated trainee
    std::string tool;                // name in the assembly; empty before format 4: the assembly's first tool
    std::optional<hand::Side> hand;  // the working hand; none if unknown

    // A person's code (content/trainee/people.hpp), or the text of --trainee for a simulated trainee; may be
    // empty. Older programs stored a person's typed name here, and still older ones in `trainee_profile`.
    std::optional<std::string> trainee;

    // The numbers of ticks after which the lesson was interrupted and later continued (resume.hpp),
    // ascending.
    std::vector<std::uint64_t> continued_after;
};

// "virtual time", or the rate as text.
std::string servo_text(double rate);

// Determines the kind of trainee without using the trainee's name. The first condition that holds decides:
//   `trainee` is set                  person if `trainee_profile` is "person", otherwise simulated
//   `view_help` is set                simulated: only sessions of simulated trainees record it
//   `trainee_profile` is "person"     person
//   `tool` is not empty               person: the format is 4 or newer, in which every session of a simulated
//                                     trainee has `view_help`, and this one has none
//   none of these                     unrecorded
TraineeKind trainee_kind(const Header& header);

// The person's code, or in sessions of older programs the typed name; empty if neither is recorded. For a
// simulated trainee: the text of --trainee.
std::string trainee_name(const Header& header);

// Keys of table meta.
namespace key {
inline constexpr const char* assembly = "assembly";
inline constexpr const char* assembly_file = "assembly_file";
inline constexpr const char* assembly_text = "assembly_text";
inline constexpr const char* variant = "variant";
inline constexpr const char* law = "law";
inline constexpr const char* mode = "mode";
inline constexpr const char* task = "task";
inline constexpr const char* trainee_profile = "operator";  // this name is older
inline constexpr const char* seed = "seed";
inline constexpr const char* dt = "dt_s";
inline constexpr const char* program = "program";
inline constexpr const char* guide = "guide";  // this and the next three since format 2
inline constexpr const char* obstacles = "obstacles";
inline constexpr const char* device = "device";
inline constexpr const char* servo = "servo";
inline constexpr const char* view_help = "view_help";                    // optional
inline constexpr const char* tool = "tool";                              // since format 4
inline constexpr const char* hand = "hand";                              // optional
inline constexpr const char* trainee = "trainee";                        // optional
inline constexpr const char* continued_after = "continued_after_ticks";  // optional

inline constexpr const char* state = "state";
inline constexpr const char* duration = "duration_s";  // this and the next two only in complete sessions
inline constexpr const char* score = "score";
inline constexpr const char* finished = "finished";
}  // namespace key

// The header as the texts of table meta, by key.
using HeaderTexts = std::map<std::string, std::string, std::less<>>;
HeaderTexts texts_of(const Header& header);
// Ignores other keys. Fails, and names `file`, if a text is missing or cannot be parsed. Texts that older
// formats do not store may be missing.
Result<Header> header_of(const HeaderTexts& texts, const std::string& file);

// The limits of a haptic device as one line: "force_N=20 torque_Nm=2 …", each limit by name, as the shortest
// number that reads back the same, because a replay needs all bits.
std::string limits_text(const force::OutputLimits& limits);
// The inverse. None if a name is missing or unknown, or a value is not a number.
std::optional<force::OutputLimits> parse_limits(std::string_view text);

}  // namespace bolt::session

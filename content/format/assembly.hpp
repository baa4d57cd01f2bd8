// An assembly as read from its file: plain values in SI, names resolved, defaults filled in; and the
// functions that read, check and create assemblies. Frame: the assembly's own, metres, Y up. Angles in
// radians.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "content/format/folders.hpp"
#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/law.hpp"
#include "haptics/joint/published.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::content {

// The target of tightening.
enum class Strategy : std::uint8_t {
    torque,        // the target torque; an angle window, if there is one, is judged too
    torque_angle,  // the target torque within a required angle window; in a lesson with turn passes, the
                   // target angle
    yield          // the onset of yield
};
// VDI/VDE 2862. A: danger to life; B: breakdown; C: other.
enum class RiskClass : std::uint8_t { A, B, C };

// A target value and its tolerance window: a value is OK if low ≤ value ≤ high.
struct ToleranceWindow {
    double target = 0.0;
    double low = 0.0;
    double high = 0.0;
};

struct Specification {
    Strategy strategy = Strategy::torque;
    ToleranceWindow torque;    // N·m, at the wrench
    double snug_torque = 0.0;  // N·m at which the measurement of the tightening angle starts
    bool has_angle = false;
    // rad, judged if has_angle. It counts from the angle at which the nut reaches the snug torque or, in a
    // lesson with turn passes, from the nut's angle when its first step of kind `turn` begins.
    ToleranceWindow angle;
    double target_clamp = 0.0;  // N; 0: derived from the target torque and the nominal friction
    RiskClass risk = RiskClass::C;
};

// A joint under the published law (haptics/joint/published.hpp).
struct PublishedJoint {
    joint::PublishedParameters law;
    // The file gives θ_max, the nut angle of the greatest torque. Otherwise lesson::apply_law derives it from
    // the nut's start on the thread.
    bool has_theta_max = false;
    // Replaces the joint's specification, except its risk class. None: derived from the law
    // (lesson::apply_law).
    std::optional<Specification> targets;
};

struct AssemblyJoint {
    std::size_t index_in_file = 0;  // in "joints"; a variant may leave joints out
    std::string type;               // name of its joint type
    joint::JointDesign design;
    Specification spec;
    PublishedJoint published;
    std::string node;  // unique node name in the .glb; may be empty only if the assembly has no .glb
    std::string tool;  // name of the only tool that may turn it; empty: the chosen one
};

// Name of the node that a lesson turns: ID_nut, or ID_bolt if the head is turned.
std::string turned_node(const AssemblyJoint& joint);

// True if the mesh of a node of this name is the part that a lesson turns: turned_node(), or the joint's own
// node if its head is turned, because that node may be the screw itself.
bool is_turned_node(const AssemblyJoint& joint, std::string_view mesh_node);

// True if the mesh of a node of this name is the held part that a second wrench can hold
// (joint::CounterHold): ID_bolt, or ID_nut if the head is turned.
bool is_held_node(const AssemblyJoint& joint, std::string_view mesh_node);

// run_down: nuts to their seats, by hand. tighten: to a fraction of the target torque. turn: to a fraction of
// the target angle, whatever the torque. recheck: at the full target torque. loosen: in a loosening lesson.
enum class PassKind : std::uint8_t { run_down, tighten, turn, recheck, loosen };

// The author's text at the beginning of a pass.
struct Instruction {
    std::map<std::string, std::string> text;  // by language; empty: no instruction
    std::string view;                         // name in Assembly::views; empty: the view stays as it is
    std::string picture;                      // path of a PNG or JPEG file; empty: none
};

// One round over the joints.
struct Pass {
    PassKind kind = PassKind::tighten;
    double fraction = 1.0;           // tighten: of the target torque; turn: of the target angle
    std::vector<std::size_t> order;  // indices into joints
    double turn_back = 0.0;          // rad, loosen only: turned back by this angle; 0: until it is free
    Instruction instruction = {};
};

enum class ToolKind : std::uint8_t {
    open_end_wrench,
    ring_wrench,
    hex_key,
    ratchet,
    click_torque_wrench,
    electronic_torque_wrench  // displays torque or angle, and lights up at the target; it does not click
};

// Returns true if the tool measures torque. Such a tool has a choice of heads, and is for tightening only.
constexpr bool is_torque_wrench(ToolKind kind) {
    return kind == ToolKind::click_torque_wrench || kind == ToolKind::electronic_torque_wrench;
}

// The part of a tool that grips. A ratchet and a torque wrench have a choice; each of the other kinds of
// tools has only one.
enum class ToolHeadKind : std::uint8_t { open_end, ring, socket, hex_key, hex_bit };

struct WrenchDesign {
    ToolKind kind = ToolKind::open_end_wrench;
    ToolHeadKind head = ToolHeadKind::open_end;
    // m. `jaw`: for an open end, its opening. `size`: for any other tool, the width across flats.
    double jaw = 0.0, size = 0.0;
    int teeth = 0;           // number of teeth of a ratchet; 0: no ratchet
    double extension = 0.0;  // m, length of the bar between ratchet and socket or bit; 0: none
    // Dimensions of an open end. 0: not given; collision::make_jaw() then uses the proportions of our models.
    double head_thickness = 0.0;  // m
    double jaw_depth = 0.0;       // m, from the middle of the jaw to its throat
    double jaw_tip = 0.0;         // m, from the middle of the jaw to its tips
    double head_angle = 0.0;      // rad, between jaw and handle; never missing
    double handle_length = 0.0;   // m, from the bolt's axis to the grip
    std::string model;            // path of its .glb; empty: none
    // Click-type torque wrenches only; 0 for other tools.
    double click_swing = 0.0;     // rad that the handle swings when it clicks
    double click_accuracy = 0.0;  // relative error of the click torque
    // m by which an adaptor in line with the handle lengthens its lever, included in handle_length; 0: none.
    double adaptor_length = 0.0;
};

// The torque at the nut, divided by that on the scale of the torque wrench (joint::adaptor_ratio()); 1
// without an adaptor.
double adaptor_ratio(const WrenchDesign& wrench);

// The width across flats that a tool is made for, m; for an open end, its opening.
double nominal_size(const WrenchDesign& wrench);

// Returns true if the tool can grip the part of the joint that is turned, and is made for its size. A jaw may
// be wider than the nut by the usual play between the two.
bool suits(const WrenchDesign& wrench, const joint::JointDesign& joint);

// The name of the tool "tool" of a file. Those of "more_tools" have names of their own.
inline constexpr std::string_view default_tool_name = "wrench";

// A tool that an assembly can be tightened with.
struct Tool {
    std::string name;
    std::map<std::string, std::string> title;  // by language; may be empty
    WrenchDesign wrench;
    // For each joint that it does not reach, by the joint's id: name of the tool that turns the joint
    // instead.
    std::map<std::string, std::string> instead = {};
};

// Largest file of an Instruction::picture, bytes.
inline constexpr std::size_t largest_picture_file = std::size_t{32} << 20U;

// Paths of an assembly's .glb files; empty if the file gives none.
struct ModelFiles {
    std::string model;
    std::string far_level;  // the model with fewer triangles
    std::string contact;    // collision geometry
};

// Selects one of the paths.
using ModelFile = std::string ModelFiles::*;

// The flange through which the joints interact: a plate on an elastic foundation. The model is our own (see
// haptics/joint/group.hpp).
struct FlangeDesign {
    bool joints_interact = false;  // tightening one changes the clamp force of its neighbours
    double thickness = 0.0;        // m
    double E = 0.0;                // Pa
    double poisson = 0.25;
    double interface_stiffness = 0.0;  // Pa/m, of the parting faces
};

// A named point of view.
struct NamedView {
    std::string name;
    Vec3 eye{0.0};               // m
    Vec3 target{0.0};            // m
    double field_of_view = 0.0;  // rad, vertical
};

// A variant of the assembly: other materials or fasteners, or a lesson about some of its joints.
struct AssemblyVariant {
    std::string name;
    std::map<std::string, std::string> title;  // by language; may be empty
};

struct Assembly {
    std::string name;                          // folder name
    std::string file;                          // path of assembly.json
    std::string text;                          // the file's exact bytes: stored in every session
    std::map<std::string, std::string> title;  // by language ("en", "de", "zh")
    // The menu's text about the lesson ("lesson" in the file), by language: the chosen variant's, or else the
    // file's.
    std::map<std::string, std::string> lesson_texts;
    std::string sources;  // source of the file's numbers; may be empty
    joint::Law law = joint::Law::mechanistic;
    std::string variant;                    // name of the chosen variant; empty: none
    std::vector<AssemblyVariant> variants;  // all variants of the file
    std::vector<AssemblyJoint> joints;      // those that the chosen variant works on, in the file's order
    std::vector<Pass> passes;
    // Passes of a loosening lesson. Empty: one pass loosens all joints, in the reverse order of the last of
    // `passes`.
    std::vector<Pass> loosening;
    // The default one first. A variant that chooses joints has only the tools that turn these joints.
    std::vector<Tool> tools;
    std::string tool;     // name of the chosen tool
    WrenchDesign wrench;  // of the chosen tool
    FlangeDesign flange;
    ModelFiles models;
    ModelFiles added_models;  // parts that only the chosen variant shows
    std::vector<NamedView> views;
};

// The paths of a model and of what the chosen variant adds to it; empty if there is none.
std::vector<std::string> model_paths(const Assembly& assembly, ModelFile file);

// An assembly without errors, or the errors of the file, at most 200, in the order of the file. Each error
// has ErrorCode::bad_content, file, line, column and JSON pointer.
struct LoadedAssembly {
    Assembly assembly;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// Parses the text of an assembly file. `file` is used in messages, and paths in the text are relative to its
// folder; no file is accessed. `variant`: which of the file's "variants" to apply; empty: the file's default.
LoadedAssembly parse_assembly(std::string_view text, std::string_view file, std::string_view variant = {});

// Loads an assembly. `where` is a folder with an assembly.json, a file, or one of assembly_names().
// The files that the assembly refers to must exist: models of tools within content/tools, all others within
// content/ or, for an assembly outside content/, within its own folder.
LoadedAssembly load_assembly(const std::filesystem::path& where, std::string_view variant = {});

// The tools that a trainee can choose for the joints that name no tool: the default one, and those that no
// joint names as its own.
std::vector<const Tool*> choosable_tools(const Assembly& assembly);

// Indices in Assembly::tools of the tools that may turn a joint: its own tool if it names one; otherwise each
// tool that a trainee can choose or, if that tool has an `instead` for this joint, the tool named there. The
// first index is the tool of a lesson whose trainee has chosen none. No repetition.
std::vector<std::size_t> tools_of_joint(const Assembly& assembly, std::size_t joint);

// Index in Assembly::tools of the tool that turns a joint if the trainee chooses the tool of this name: the
// joint's own tool, or the chosen one, or the one that the latter names instead.
std::size_t tool_if_chosen(const Assembly& assembly, const AssemblyJoint& joint, std::string_view chosen);

// Selects one of the choosable tools; empty: the default one. Fails if there is none of this name.
Status choose_tool(Assembly& assembly, std::string_view name);

// The tools that a lesson needs. A lesson begins with the first one.
struct LessonTools {
    std::vector<std::size_t> tools;     // indices in Assembly::tools, without repetition
    std::vector<std::size_t> of_joint;  // by joint: index in `tools`
};

// The tools of a lesson, in the order in which the joints of the first pass need them.
LessonTools lesson_tools(const Assembly& assembly);

// The designs of lesson.tools, in their order.
std::vector<const WrenchDesign*> designs_of(const Assembly& assembly, const LessonTools& lesson);

// The tool that turns a joint: its own one, or the chosen one, or the one that the latter names instead.
const WrenchDesign& tool_of(const Assembly& assembly, const AssemblyJoint& joint);

// Creates a new assembly from the template: makes `folder` (fails if it exists and is not empty) and writes a
// valid assembly.json with the title `name` and the models that it refers to. Outside content/assemblies the
// schema is written beside it for editors. A failure leaves no files behind.
Status create_assembly(const std::filesystem::path& folder, std::string_view name);

}  // namespace bolt::content

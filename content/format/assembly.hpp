// An assembly file as a program uses it: plain values in SI, names resolved, defaults filled in.
// Frame: the assembly's own, metres, Y up. Angles in radians.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "haptics/joint/design.hpp"
#include "haptics/joint/published.hpp"
#include "haptics/joint/stage.hpp"

namespace bolt::content {

enum class Strategy : std::uint8_t { torque, torque_angle, yield };
enum class RiskClass : std::uint8_t { A, B, C };  // VDI/VDE 2862: life and limb, breakdown, other

// A value with the window that is judged OK: low ≤ value ≤ high.
struct Window {
    double target = 0.0;
    double low = 0.0;
    double high = 0.0;
};

struct Specification {
    Strategy strategy = Strategy::torque;
    Window torque;             // N·m, at the wrench
    double snug_torque = 0.0;  // N·m, from which the tightening angle is counted
    bool has_angle = false;
    Window angle;               // rad, from snug; judged when has_angle
    double target_clamp = 0.0;  // N; 0: derived from the target torque and the nominal friction
    RiskClass risk = RiskClass::C;
};

// What every joint is tightened to under the published law, whose torques do not depend on the fastener.
struct PublishedTargets {
    Window torque;             // N·m, at the wrench
    double snug_torque = 0.0;  // N·m, from which the tightening angle is counted
};

struct AssemblyJoint {
    std::string type;  // name of its joint type
    joint::JointDesign design;
    Specification spec;
    std::string node;  // unique name in the .glb; may be empty while there is none
};

enum class StepKind : std::uint8_t { run_down, tighten, recheck };

// One round over joints: run the nuts down by hand, tighten to a share of the target, or check at full
// target.
struct Pass {
    StepKind kind = StepKind::tighten;
    double fraction = 1.0;           // of the target torque; tighten only
    std::vector<std::size_t> order;  // indices into joints
};

struct WrenchDesign {
    double jaw = 0.0;             // m, opening
    double head_thickness = 0.0;  // m; 0, also below: not given (contact/jaw.hpp has proportions)
    double jaw_depth = 0.0;       // m, from the jaw's middle to its bottom
    double jaw_tip = 0.0;         // m, and to its tips
    double head_angle = 0.0;      // rad, between jaw and handle
    double handle_length = 0.0;   // m, jaw centre to the grip
    std::string model;            // path of its .glb; empty: none is named
    // Of a click-type torque wrench; 0 of any other.
    double click_swing = 0.0;     // rad that its handle swings when it clicks
    double click_accuracy = 0.0;  // relative, of what it clicks at
};

// One of the tools that an assembly can be tightened with.
struct Tool {
    std::string name;
    std::map<std::string, std::string> title;  // by language; may be empty
    WrenchDesign wrench;
};

// Paths of the .glb files that show an assembly; empty where the file names none.
struct ModelFiles {
    std::string model;
    std::string far_level;  // the same with fewer triangles
    std::string contact;    // what the tool touches
};

// Flange that couples the joints: a plate on an elastic foundation (see haptics/joint/group.hpp). Ours.
struct FlangeDesign {
    bool coupled = false;
    double thickness = 0.0;  // m
    double E = 0.0;          // Pa
    double poisson = 0.25;
    double interface_stiffness = 0.0;  // Pa/m, of the parting faces
};

// A named point of view.
struct View {
    std::string name;
    Vec3 eye{0.0};               // m
    Vec3 target{0.0};            // m
    double field_of_view = 0.0;  // rad, vertical
};

// Another material or fastener of the same assembly.
struct Variant {
    std::string name;
    std::map<std::string, std::string> title;  // by language; may be empty
};

struct Assembly {
    std::string name;                           // folder name
    std::string file;                           // path of assembly.json
    std::string text;                           // the file's exact bytes: stored in every session
    std::map<std::string, std::string> title;   // by language ("en", "de", "zh")
    std::map<std::string, std::string> lesson;  // text by language
    std::string sources;                        // where the file's numbers come from; may be empty
    joint::Law law = joint::Law::mechanistic;
    joint::PublishedParameters published;               // pitch etc. of the paper; used by that law only
    std::optional<PublishedTargets> published_targets;  // none: derived from the joints' (lesson::under_law)
    std::string variant;                                // which material variant was chosen; empty: none
    std::vector<Variant> variants;                      // all that the file has
    std::vector<AssemblyJoint> joints;
    std::vector<Pass> passes;
    std::vector<Tool> tools;  // that there are to choose from, the usual one first
    std::string tool;         // name of the one that was chosen
    WrenchDesign wrench;      // and what it is
    FlangeDesign flange;
    ModelFiles models;
    std::vector<View> views;
};

// Reads an assembly file. Every mistake of the file is reported in one run, in the order of the file.

// Either an assembly and no errors, or errors. Each error has ErrorCode::bad_content, file, line, column,
// pointer.
struct Loaded {
    Assembly assembly;
    std::vector<Error> errors;
    [[nodiscard]] bool ok() const { return errors.empty(); }
};

// `file` is for messages, and what the text names is taken from its folder; no file is looked for. `variant`:
// which of the file's "variants" to apply; empty: the file's default.
Loaded parse_assembly(std::string_view text, std::string_view file, std::string_view variant = {});

// `where` is a folder with an assembly.json, a file, or a name under content/assemblies. The files that it
// names have to be there, within content/ or, for an assembly that lies elsewhere, within its own folder.
Loaded load_assembly(const std::filesystem::path& where, std::string_view variant = {});

// Takes another of the assembly's tools into the hand; empty: the usual one. An error: there is none of this
// name.
Status choose_tool(Assembly& assembly, std::string_view name);

// Folder that holds content/ (schema/, assemblies/): $BOLTWRIGHT_CONTENT, else beside the program or above it
// (build tree), else the source tree that it was built from. Empty if none is there.
std::filesystem::path content_folder();

// Starts a new assembly: a folder whose assembly.json loads without a mistake and is there to be changed.

// Makes `folder` (refused if it is there and not empty) and writes assembly.json into it, titled `name`, with
// the models that it names.
// Outside of content/assemblies the schema is written beside it, so that an editor finds it. What fails
// leaves nothing behind.
Status create_assembly(const std::filesystem::path& folder, std::string_view name);

}  // namespace bolt::content

// The subcommand validate: all checks of an assembly.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/format/json_document.hpp"
#include "engine/base/process.hpp"
#include "engine/base/result.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/pictures/joint_pictures.hpp"

namespace bolt::author {

namespace {

namespace fs = std::filesystem;

tl::unexpected<Error> validator_error(std::string what) {
    return fail(ErrorCode::failed, "the Khronos glTF validator: " + std::move(what),
                "the validator that tools/install-node-tools.sh installs, and node on the path");
}

// Returns the script that runs the Khronos glTF validator; empty if it is not installed.
// $BOLTWRIGHT_GLTF_VALIDATOR names its folder; the default is tools/gltf-validator beside content/.
fs::path find_gltf_validator() {
    const char* given =
        std::getenv("BOLTWRIGHT_GLTF_VALIDATOR");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    const fs::path folder = given != nullptr && *given != '\0'
                                ? fs::path(given)
                                : content::content_folder().parent_path() / "tools" / "gltf-validator";
    std::error_code ignored;
    const bool installed = fs::is_regular_file(folder / "validate.mjs", ignored) &&
                           fs::is_directory(folder / "node_modules" / "gltf-validator", ignored);
    return installed ? folder / "validate.mjs" : fs::path{};
}

// Returns the errors and warnings of the validator, each with its file and JSON pointer.
Result<std::vector<Error>> run_gltf_validator(const fs::path& script, const std::vector<std::string>& files) {
    std::vector<std::string> command{"node", script.string()};
    for (const std::string& file : files) command.push_back(fs::absolute(file).string());
    const Result<ProgramResult> run = run_program(command, Capture::output);
    if (!run) return validator_error(run.error().what);
    if (run->exit_code != 0) return validator_error("it failed");
    const auto reports = nlohmann::json::parse(run->output, nullptr, false);
    if (!reports.is_array() || reports.size() != files.size())
        return validator_error("its output has an unknown format");
    std::vector<Error> errors;
    for (std::size_t i = 0; i < files.size(); ++i)
        for (const nlohmann::json& message : reports[i].value("messages", nlohmann::json::array())) {
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = files[i];
            error.pointer = message.value("pointer", "");
            error.what = fmt::format("{} ({}, {} of the Khronos glTF validator)",
                                     message.value("message", ""), message.value("code", ""),
                                     message.value("severity", 0) == 0 ? "an error" : "a warning");
            error.expected = "none";
            errors.push_back(std::move(error));
        }
    return errors;
}

// Returns each model file of the assembly and of its tools once.
std::vector<std::string> models_of(const content::Assembly& assembly) {
    std::vector<std::string> files;
    const auto add = [&](const std::string& file) {
        if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end())
            files.push_back(file);
    };
    using content::ModelFiles;
    for (const content::ModelFile file : {&ModelFiles::model, &ModelFiles::far_level, &ModelFiles::contact})
        for (const std::string& part : content::model_paths(assembly, file)) add(part);
    for (const content::Tool& tool : assembly.tools) add(tool.wrench.model);
    return files;
}

// A variant to check. Its models and the room for its tools are checked only if no earlier variant has the
// same joints, tools and models.
struct CheckedVariant {
    content::Assembly assembly;
    bool has_own_geometry = true;
    std::optional<geometry::DrawnToolRooms> rooms = {};
};

struct AssemblyReport {
    std::vector<Error> errors;
    std::vector<Error> notes;
    std::vector<std::string> remarks;  // notes without a position, one line each
};

template <class T, class Key>
void add_new(std::vector<T>& all, std::vector<T>&& found, const Key& key) {
    for (T& one : found)
        if (std::none_of(all.begin(), all.end(), [&](const T& known) { return key(known) == key(one); }))
            all.push_back(std::move(one));
}

// Adds the findings that no earlier variant has. Those of a variant name it.
void add_findings(std::vector<Error>& all, std::set<std::string>& known, std::vector<Error>&& found,
                  const content::Assembly& assembly, bool is_first) {
    for (Error& error : found) {
        if (!known.insert(error.message()).second) continue;
        if (!is_first)
            error.what =
                fmt::format("in the variant {}: {}", content::in_quotes(assembly.variant), error.what);
        all.push_back(std::move(error));
    }
}

// Checks the variants of an assembly, which have loaded without errors.
AssemblyReport validate(std::vector<CheckedVariant>& variants) {
    AssemblyReport result;
    std::set<std::string> known;
    std::vector<std::string> files;
    const auto itself = [](const std::string& file) { return file; };
    for (CheckedVariant& variant : variants) {
        const content::Assembly& assembly = variant.assembly;
        const bool is_first = &variant == &variants.front();
        geometry::Findings findings = variant.has_own_geometry
                                          ? geometry::check_geometry(assembly, &variant.rooms)
                                          : geometry::check_tool_choice(assembly);
        if (is_first) {
            geometry::Findings references = geometry::check_references(assembly);
            add_findings(result.errors, known, std::move(references.errors), assembly, true);
            add_findings(result.notes, known, std::move(references.notes), assembly, true);
        }
        add_findings(result.errors, known, std::move(findings.errors), assembly, is_first);
        add_findings(result.notes, known, std::move(findings.notes), assembly, is_first);
        add_new(files, models_of(assembly), itself);
    }
    content::sort_by_position(result.errors);
    content::sort_by_position(result.notes);
    const content::Assembly& first = variants.front().assembly;
    if (first.models.model.empty())
        result.remarks.push_back(fmt::format(
            "note: {}: no model is named, so nodes and room for the wrench are not checked\n", first.file));
    if (files.empty()) return result;
    const std::filesystem::path script = find_gltf_validator();
    if (script.empty()) {
        result.remarks.emplace_back(
            "note: the Khronos glTF validator is not installed, so its checks are left out "
            "(tools/install-node-tools.sh installs it)\n");
        return result;
    }
    auto found = run_gltf_validator(script, files);
    if (found)
        result.errors.insert(result.errors.end(), found->begin(), found->end());
    else
        result.errors.push_back(found.error());
    return result;
}

// The values of a design that the checks of the models depend on.
auto drawn_values(const joint::JointDesign& design) {
    return std::tuple(design.id, design.form, design.head, design.turned, design.thread.size.name,
                      design.thread.thread.pitch, design.thread_direction, design.bolt_length,
                      design.grip_length(), design.washer_under_head, design.washer_under_nut,
                      design.locking_insert, design.start_gap, design.hole.engagement, design.hole.depth,
                      design.members.size());
}

std::tuple<std::string, std::string, std::string> added_files(const content::Assembly& assembly) {
    const content::ModelFiles& added = assembly.added_models;
    return {added.model, added.far_level, added.contact};
}

// Returns true if the checks of the models have the same result for both variants.
bool same_geometry(const content::Assembly& a, const content::Assembly& b) {
    if (a.joints.size() != b.joints.size() || added_files(a) != added_files(b)) return false;
    const auto names_of_tools = [](const content::Assembly& assembly, std::size_t joint) {
        std::vector<std::string> names;
        for (const std::size_t tool : content::tools_of_joint(assembly, joint))
            names.push_back(assembly.tools[tool].name);
        return names;
    };
    for (std::size_t i = 0; i < a.joints.size(); ++i)
        if (drawn_values(a.joints[i].design) != drawn_values(b.joints[i].design) ||
            names_of_tools(a, i) != names_of_tools(b, i))
            return false;
    return true;
}

// The assembly itself, then its other variants. `chosen`: the user has chosen a variant, which is then
// checked alone.
std::vector<CheckedVariant> variants_to_check(content::Assembly assembly, bool chosen) {
    std::vector<CheckedVariant> variants;
    const std::string first = assembly.variant;
    variants.push_back({std::move(assembly)});
    const std::vector<content::AssemblyVariant> all = variants.front().assembly.variants;
    for (const content::AssemblyVariant& variant : all) {
        if (chosen || variant.name == first) continue;
        content::LoadedAssembly other = content::load_assembly(variants.front().assembly.file, variant.name);
        if (!other.ok()) continue;
        const bool is_new = std::none_of(variants.begin(), variants.end(), [&](const CheckedVariant& known) {
            return same_geometry(known.assembly, other.assembly);
        });
        variants.push_back({std::move(other.assembly), is_new});
    }
    return variants;
}

struct ValidateOptions {
    std::vector<std::string> assemblies;
    std::string variant, pictures;
};

// Draws the joints of each variant. If an earlier variant has drawn one of them, all pictures of the variant
// go into a folder of its own.
Status draw_pictures(const std::vector<CheckedVariant>& variants, const std::string& folder) {
    std::set<std::string> drawn;
    for (const CheckedVariant& variant : variants) {
        if (!variant.rooms) continue;
        const std::vector<content::AssemblyJoint>& joints = variant.assembly.joints;
        const bool again = std::any_of(joints.begin(), joints.end(),
                                       [&](const auto& joint) { return drawn.contains(joint.design.id); });
        for (const content::AssemblyJoint& joint : joints) drawn.insert(joint.design.id);
        const fs::path place = again ? fs::path(folder) / variant.assembly.variant : fs::path(folder);
        BOLT_TRY(draw_joint_pictures(variant.assembly, *variant.rooms, place));
    }
    return {};
}

// The last line of the report on a file that could not be read completely.
std::string unchecked_remark(const std::string& file) {
    return fmt::format(
        "note: {}: models, pictures, and strength and room of the tools are checked once the file has none "
        "of these mistakes\n",
        file);
}

// Returns the exit code.
int validate_one(const std::string& where, const ValidateOptions& options) {
    content::LoadedAssembly loaded = content::load_assembly(where, options.variant);
    if (!loaded.ok()) {
        const int code = print_error(loaded.errors);
        const bool was_read = !loaded.assembly.text.empty();
        if (const Status printed = was_read ? print(unchecked_remark(loaded.assembly.file)) : Status{};
            !printed)
            return print_error(printed.error());
        return code;
    }
    std::vector<CheckedVariant> variants =
        variants_to_check(std::move(loaded.assembly), !options.variant.empty());
    const AssemblyReport result = validate(variants);
    std::string text;
    for (const Error& note : result.notes) text += fmt::format("note: {}\n", note.message());
    text += fmt::format("{}", fmt::join(result.remarks, ""));
    for (const auto& [assembly, has_own_geometry, rooms] : variants)
        if (result.errors.empty())
            text += fmt::format("{}: {} joints, {} passes, variant {}: no mistakes\n", assembly.file,
                                assembly.joints.size(), assembly.passes.size(),
                                assembly.variant.empty() ? "-" : assembly.variant);
    const int code = print_error(result.errors);
    if (const Status printed = print(text); !printed) return print_error(printed.error());
    if (options.pictures.empty()) return code;
    const Status drawn = draw_pictures(variants, options.pictures);
    return drawn ? code : print_error(drawn.error());
}

int run_validate(const ValidateOptions& options) {
    if (!options.pictures.empty() && options.assemblies.size() > 1)
        return print_error({ErrorCode::usage, "--pictures draws the joints of one assembly", "one assembly"});
    int worst = 0;
    for (const std::string& where : options.assemblies) worst = std::max(worst, validate_one(where, options));
    return worst;
}

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ValidateOptions>();
    CLI::App* command = app.add_subcommand("validate", "Report all errors of assemblies");
    command->add_option("assembly", options->assemblies, "Folders, files, or names under content/assemblies")
        ->required();
    command->add_option("--variant", options->variant,
                        "Variant to check alone; otherwise the default and all variants");
    command->add_option("--pictures", options->pictures,
                        "Draw each joint with the wrench and its free swing into this folder, JOINT.png");
    command->callback([options, &exit_code] { exit_code = run_validate(*options); });
}

}  // namespace bolt::author

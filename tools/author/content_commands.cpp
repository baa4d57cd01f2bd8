// The subcommands for content: new (a small assembly), words (check of the on-screen texts), views
// (visibility of the nuts) and validate (all checks of an assembly).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "engine/base/process.hpp"
#include "engine/base/result.hpp"
#include "engine/text/fonts.hpp"
#include "engine/text/layout.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/geometry/check.hpp"
#include "tools/author/pictures/joint_pictures.hpp"

namespace bolt::author {

namespace {

int run_new(const std::string& target, const std::string& title) {
    const std::filesystem::path folder = std::filesystem::path(target).lexically_normal();
    const std::filesystem::path last =
        folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    const std::string name = title.empty() ? last.string() : title;
    if (Status made = content::create_assembly(folder, name); !made) return print_error(made.error());
    const Status printed = print(fmt::format("{}\nCheck it with: bolt-author validate {}\n",
                                             (folder / "assembly.json").string(), target));
    return printed ? 0 : print_error(printed.error());
}

}  // namespace

void add_new(CLI::App& app, int& exit_code) {
    struct NewOptions {
        std::string folder, title;
    };
    auto options = std::make_shared<NewOptions>();
    CLI::App* make = app.add_subcommand("new", "Make a folder with a small, valid assembly to start from");
    make->add_option("folder", options->folder, "Folder to make")->required();
    make->add_option("--title", options->title, "Title; the folder's name if not given");
    make->callback([options, &exit_code] { exit_code = run_new(options->folder, options->title); });
}

namespace {

// Reports each text that has a letter in no font; the window would show a box in its place.
std::vector<Error> check_letters(const words::LoadedWords& loaded, const std::string& file,
                                 const text::Fonts& fonts) {
    std::vector<Error> errors;
    for (std::size_t i = 0; i < words::key_count; ++i)
        for (const char32_t point : text::decode(loaded.words.texts[i])) {
            if (text::find_glyph(fonts, point).glyph != 0) continue;
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = file;
            error.line = loaded.lines[i];
            error.pointer = fmt::format("/words/{}", words::key_rows[i].name);
            error.what = fmt::format("no font has the letter \"{}\"", text::encode({&point, 1}));
            error.expected = "letters that the window can show";
            errors.push_back(std::move(error));
            break;
        }
    return errors;
}

int run_words(std::vector<std::string> files) {
    if (files.empty())
        for (const std::string& language : words::languages(words::words_folder()))
            files.push_back((words::words_folder() / (language + ".json")).string());
    const Result<text::Fonts> fonts = text::load_fonts();
    if (!fonts) return print_error(fonts.error());
    int worst = 0;
    for (const std::string& file : files) {
        const words::LoadedWords loaded = words::read_words(file);
        std::vector<Error> errors = loaded.errors;
        if (errors.empty()) errors = check_letters(loaded, file, *fonts);
        if (!errors.empty()) {
            worst = std::max(worst, print_error(errors));
            continue;
        }
        const Status printed =
            print(fmt::format("{}: {}, {} texts\n", file, loaded.words.name, words::key_count));
        if (!printed) return print_error(printed.error());
    }
    return worst;
}

}  // namespace

void add_words(CLI::App& app, int& exit_code) {
    auto files = std::make_shared<std::vector<std::string>>();
    CLI::App* command = app.add_subcommand(
        "words", "Check the on-screen texts of languages: completeness, placeholders and letters");
    command->add_option("files", *files, "Files LANGUAGE.json; those of content/words if not given");
    command->callback([files, &exit_code] { exit_code = run_words(*files); });
}

namespace {

// Visibility of one nut in each view of the assembly.
struct NutVisibility {
    std::string joint;
    std::vector<session::NutView> views;  // in the order of the assembly
    std::optional<std::size_t> best;      // index of the best view; nullopt: no view shows the nut
};

std::string format_table(const content::Assembly& assembly, const std::vector<NutVisibility>& rows) {
    std::size_t width = 0;
    for (const NutVisibility& row : rows) width = std::max(width, row.joint.size());
    std::string text = fmt::format("{:{}}", "", width);
    for (const content::NamedView& view : assembly.views) text += fmt::format("  {:>9}", view.name);
    text += "  best\n";
    for (std::size_t joint = 0; joint < rows.size(); ++joint) {
        const NutVisibility& row = rows[joint];
        text += fmt::format("{:{}}", row.joint, width);
        for (std::size_t i = 0; i < row.views.size(); ++i)
            text += fmt::format(
                "  {:>{}}", row.views[i].framed ? fmt::format("{:.0f} %", 100.0 * row.views[i].share) : "-",
                std::max<std::size_t>(9, assembly.views[i].name.size()));
        text += fmt::format("  {}\n",
                            row.best ? assembly.views[*row.best].name
                                     : fmt::format("none: no view shows this {}",
                                                   lesson::fastener_name(assembly.joints[joint].design)));
    }
    return text + fmt::format(
                      "Visible share of each {0} without wrench and hand; -: outside the picture.\n"
                      "Best: the view with the largest visible area of the {0} in the picture.\n",
                      lesson::fastener_name(assembly));
}

std::string format_json(const content::Assembly& assembly, const std::vector<NutVisibility>& rows) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const NutVisibility& row : rows) {
        nlohmann::ordered_json views = nlohmann::ordered_json::object();
        for (std::size_t i = 0; i < row.views.size(); ++i)
            views[assembly.views[i].name] = {{"share", row.views[i].share}, {"framed", row.views[i].framed}};
        json.push_back({{"id", row.joint}, {"views", views}});
        if (row.best)
            json.back()["best"] = assembly.views[*row.best].name;
        else
            json.back()["best"] = nullptr;
    }
    return json.dump(1) + "\n";
}

int run_views(const std::string& name, const std::string& variant, bool as_json) {
    const content::LoadedAssembly loaded = content::load_assembly(name, variant);
    if (!loaded.ok()) return print_error(loaded.errors.front());
    const content::Assembly& assembly = loaded.assembly;
    const servo::Setup setup = session::make_setup(assembly, assembly.law, {}, 1, 1e-3);
    Result<std::optional<servo::ToolContact>> contact = session::load_tool_contact(assembly, setup);
    if (!contact) return print_error(contact.error());
    if (!*contact)
        return print_error({ErrorCode::bad_content,
                            fmt::format("{} has no contact model, so visibility cannot be computed", name),
                            "\"contact_model\""});
    session::seat_nuts(setup, **contact);
    std::vector<NutVisibility> rows;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        NutVisibility row{assembly.joints[i].design.id, session::nut_views(assembly, **contact, i), {}};
        row.best = session::best_view(row.views);
        rows.push_back(std::move(row));
    }
    const Status printed = print(as_json ? format_json(assembly, rows) : format_table(assembly, rows));
    return printed ? 0 : print_error(printed.error());
}

}  // namespace

void add_views(CLI::App& app, int& exit_code) {
    struct ViewsOptions {
        std::string assembly = "zq350", variant;
        bool json = false;
    };
    auto options = std::make_shared<ViewsOptions>();
    CLI::App* command =
        app.add_subcommand("views", "Print the visible share of each nut in every view of an assembly");
    command->add_option("assembly", options->assembly, "Folder, file or name of an assembly");
    command->add_option("--variant", options->variant, "Variant of the assembly; the default if not given");
    command->add_flag("--json", options->json, "As JSON");
    command->callback(
        [options, &exit_code] { exit_code = run_views(options->assembly, options->variant, options->json); });
}

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

struct AssemblyReport {
    std::vector<Error> errors;
    std::vector<std::string> remarks;             // notes that are not errors, one line each
    std::vector<geometry::DrawnToolRooms> rooms;  // of each checked variant that has a model
};

template <class T, class Key>
void add_new(std::vector<T>& all, std::vector<T>&& found, const Key& key) {
    for (T& one : found)
        if (std::none_of(all.begin(), all.end(), [&](const T& known) { return key(known) == key(one); }))
            all.push_back(std::move(one));
}

// Checks the variants of an assembly, which have loaded without errors.
AssemblyReport validate(const std::vector<content::Assembly>& variants) {
    AssemblyReport result;
    std::vector<Error> notes;
    std::vector<std::string> files;
    const auto message = [](const Error& error) { return error.message(); };
    const auto itself = [](const std::string& file) { return file; };
    for (const content::Assembly& assembly : variants) {
        std::optional<geometry::DrawnToolRooms> rooms;
        geometry::Findings findings = geometry::check_geometry(assembly, &rooms);
        add_new(result.errors, std::move(findings.errors), message);
        add_new(notes, std::move(findings.notes), message);
        add_new(files, models_of(assembly), itself);
        if (rooms) result.rooms.push_back(std::move(*rooms));
    }
    for (const Error& note : notes) result.remarks.push_back(fmt::format("note: {}\n", note.message()));
    const content::Assembly& first = variants.front();
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

bool same_work(const content::Assembly& a, const content::Assembly& b) {
    const auto same_joint = [](const content::AssemblyJoint& x, const content::AssemblyJoint& y) {
        return x.design.id == y.design.id;
    };
    return std::equal(a.joints.begin(), a.joints.end(), b.joints.begin(), b.joints.end(), same_joint) &&
           a.added_models.model == b.added_models.model;
}

// The assembly itself, then its variants that work on other joints or add models. `chosen`: whether the user
// has chosen a variant, which is then checked alone.
std::vector<content::Assembly> variants_to_check(content::Assembly assembly, bool chosen) {
    std::vector<content::Assembly> variants;
    variants.push_back(std::move(assembly));
    const std::vector<content::AssemblyVariant> all = variants.front().variants;
    for (const content::AssemblyVariant& variant : all) {
        if (chosen) break;
        content::LoadedAssembly other = content::load_assembly(variants.front().file, variant.name);
        const auto same = [&](const content::Assembly& known) { return same_work(known, other.assembly); };
        if (other.ok() && std::none_of(variants.begin(), variants.end(), same))
            variants.push_back(std::move(other.assembly));
    }
    return variants;
}

struct ValidateOptions {
    std::vector<std::string> assemblies;
    std::string variant, pictures;
};

int run_validate(const ValidateOptions& options) {
    if (!options.pictures.empty() && options.assemblies.size() > 1)
        return print_error({ErrorCode::usage, "--pictures draws the joints of one assembly", "one assembly"});
    int worst = 0;
    for (const std::string& where : options.assemblies) {
        content::LoadedAssembly loaded = content::load_assembly(where, options.variant);
        if (!loaded.ok()) {
            worst = std::max(worst, print_error(loaded.errors));
            continue;
        }
        const std::vector<content::Assembly> variants =
            variants_to_check(std::move(loaded.assembly), !options.variant.empty());
        const AssemblyReport result = validate(variants);
        std::string text = fmt::format("{}", fmt::join(result.remarks, ""));
        for (const content::Assembly& assembly : variants)
            if (result.errors.empty())
                text += fmt::format("{}: {} joints, {} passes, variant {}: no mistakes\n", assembly.file,
                                    assembly.joints.size(), assembly.passes.size(),
                                    assembly.variant.empty() ? "-" : assembly.variant);
        worst = std::max(worst, print_error(result.errors));
        if (const Status printed = print(text); !printed) return print_error(printed.error());
        for (std::size_t i = 0; i < result.rooms.size() && !options.pictures.empty(); ++i)
            if (const Status drawn = draw_joint_pictures(variants[i], result.rooms[i], options.pictures);
                !drawn)
                return print_error(drawn.error());
    }
    return worst;
}

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ValidateOptions>();
    CLI::App* command = app.add_subcommand("validate", "Report all errors of assemblies");
    command->add_option("assembly", options->assemblies, "Folders, files, or names under content/assemblies")
        ->required();
    command->add_option("--variant", options->variant,
                        "Variant to check alone; otherwise one for each set of joints and of models");
    command->add_option("--pictures", options->pictures,
                        "Draw each joint with the wrench and its free swing into this folder, JOINT.png");
    command->callback([options, &exit_code] { exit_code = run_validate(*options); });
}

}  // namespace bolt::author

#include <fmt/format.h>

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
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tools/author/commands.hpp"
#include "tools/author/geometry/check.hpp"

// The Khronos glTF validator, run as the program that it is (tools/install-node-tools.sh installs it).

namespace bolt::author {

// The script that runs it; empty if it is not installed. $BOLTWRIGHT_GLTF_VALIDATOR names its folder,
// otherwise it is tools/gltf-validator beside content/.
std::filesystem::path gltf_validator();

// What it says of the files, warnings too: each an error with file and JSON pointer.
Result<std::vector<Error>> run_gltf_validator(const std::filesystem::path& script,
                                              const std::vector<std::string>& files);

namespace {

int run_new(const std::string& given, const std::string& title) {
    const std::filesystem::path folder = std::filesystem::path(given).lexically_normal();
    const std::filesystem::path last =
        folder.has_filename() ? folder.filename() : folder.parent_path().filename();
    const std::string name = title.empty() ? last.string() : title;
    if (Status made = content::create_assembly(folder, name); !made) return print_error(made.error());
    const Status said = print(fmt::format("{}\nCheck it with: bolt-author validate {}\n",
                                          (folder / "assembly.json").string(), given));
    return said ? 0 : print_error(said.error());
}

}  // namespace

void add_new(CLI::App& app, int& exit_code) {
    struct Options {
        std::string folder, title;
    };
    auto options = std::make_shared<Options>();
    CLI::App* make =
        app.add_subcommand("new", "Make a folder with a small assembly that is valid and ready to change");
    make->add_option("folder", options->folder, "Folder to make")->required();
    make->add_option("--title", options->title, "Title; the folder's name if not given");
    make->callback([options, &exit_code] { exit_code = run_new(options->folder, options->title); });
}

namespace {

// What no font has would be a box in the window.
std::vector<Error> missing_letters(const words::Loaded& loaded, const std::string& file,
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
        const words::Loaded loaded = words::read_words(file);
        std::vector<Error> errors = loaded.errors;
        if (errors.empty()) errors = missing_letters(loaded, file, *fonts);
        if (!errors.empty()) {
            worst = std::max(worst, print_error(errors));
            continue;
        }
        const Status said =
            print(fmt::format("{}: {}, {} texts\n", file, loaded.words.name, words::key_count));
        if (!said) return print_error(said.error());
    }
    return worst;
}

}  // namespace

void add_words(CLI::App& app, int& exit_code) {
    auto files = std::make_shared<std::vector<std::string>>();
    CLI::App* command = app.add_subcommand(
        "words", "Check what the program says in a language: every text there, with its places and letters");
    command->add_option("files", *files, "Files LANGUAGE.json; those of content/words if not given");
    command->callback([files, &exit_code] { exit_code = run_words(*files); });
}

// bolt-author views: from which of its views each nut of an assembly can be seen.

namespace {

struct Row {
    std::string joint;
    std::vector<session::NutView> views;
    std::optional<std::size_t> best;
};

std::string table_of(const content::Assembly& assembly, const std::vector<Row>& rows) {
    std::size_t wide = 0;
    for (const Row& row : rows) wide = std::max(wide, row.joint.size());
    std::string text = fmt::format("{:{}}", "", wide);
    for (const content::View& view : assembly.views) text += fmt::format("  {:>9}", view.name);
    text += "  best\n";
    for (const Row& row : rows) {
        text += fmt::format("{:{}}", row.joint, wide);
        for (std::size_t i = 0; i < row.views.size(); ++i)
            text += fmt::format(
                "  {:>{}}", row.views[i].framed ? fmt::format("{:.0f} %", 100.0 * row.views[i].share) : "-",
                std::max<std::size_t>(9, assembly.views[i].name.size()));
        text +=
            fmt::format("  {}\n", row.best ? assembly.views[*row.best].name : "none: no view shows this nut");
    }
    return text +
           "Share of each nut that nothing hides, before the wrench and the hand come; -: outside the "
           "picture.\nBest: where most of it is seen, in the picture's size.\n";
}

std::string json_of(const content::Assembly& assembly, const std::vector<Row>& rows) {
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const Row& row : rows) {
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

int run(const std::string& name, bool as_json) {
    const content::Loaded loaded = content::load_assembly(name);
    if (!loaded.ok()) return print_error(loaded.errors.front());
    const content::Assembly& assembly = loaded.assembly;
    const servo::Setup setup = session::make_setup(assembly, assembly.law, {}, 1, 1e-3);
    Result<std::optional<servo::ToolContact>> touch = session::load_tool_contact(assembly, setup);
    if (!touch) return print_error(touch.error());
    if (!*touch)
        return print_error({ErrorCode::bad_content,
                            fmt::format("{} has no contact model, so nothing tells what hides what", name),
                            "\"contact\" under \"models\", and a wrench with a model"});
    session::seat_nuts(setup, **touch);
    std::vector<Row> rows;
    for (std::size_t i = 0; i < assembly.joints.size(); ++i) {
        Row row{assembly.joints[i].design.id, session::views_of_nut(assembly, **touch, i), {}};
        row.best = session::best_view(row.views);
        rows.push_back(std::move(row));
    }
    const Status said = print(as_json ? json_of(assembly, rows) : table_of(assembly, rows));
    return said ? 0 : print_error(said.error());
}

}  // namespace

void add_views(CLI::App& app, int& exit_code) {
    struct Options {
        std::string assembly = "zq350";
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    CLI::App* command =
        app.add_subcommand("views", "Say how much of each nut every view of an assembly shows");
    command->add_option("assembly", options->assembly, "Folder, file or name of an assembly");
    command->add_flag("--json", options->json, "As JSON");
    command->callback([options, &exit_code] { exit_code = run(options->assembly, options->json); });
}

namespace fs = std::filesystem;
using nlohmann::json;

namespace {

tl::unexpected<Error> broken(std::string what) {
    return fail(ErrorCode::failed, "the Khronos glTF validator: " + std::move(what),
                "expected it as tools/install-node-tools.sh installs it, and node on the path");
}

}  // namespace

fs::path gltf_validator() {
    const char* given =
        std::getenv("BOLTWRIGHT_GLTF_VALIDATOR");  // NOLINT(concurrency-mt-unsafe): nothing sets it
    const fs::path folder = given != nullptr && *given != '\0'
                                ? fs::path(given)
                                : content::content_folder().parent_path() / "tools" / "gltf-validator";
    std::error_code ignored;
    const bool there = fs::is_regular_file(folder / "validate.mjs", ignored) &&
                       fs::is_directory(folder / "node_modules" / "gltf-validator", ignored);
    return there ? folder / "validate.mjs" : fs::path{};
}

Result<std::vector<Error>> run_gltf_validator(const fs::path& script, const std::vector<std::string>& files) {
    std::vector<std::string> command{"node", script.string()};
    for (const std::string& file : files) command.push_back(fs::absolute(file).string());
    const Result<ProgramResult> run = run_program(command, Capture::output);
    if (!run) return broken(run.error().what);
    if (run->exit_code != 0) return broken("it failed");
    const json reports = json::parse(run->output, nullptr, false);
    if (!reports.is_array() || reports.size() != files.size()) return broken("it said nothing that we know");
    std::vector<Error> errors;
    for (std::size_t i = 0; i < files.size(); ++i)
        for (const json& message : reports[i].value("messages", json::array())) {
            Error error;
            error.code = ErrorCode::bad_content;
            error.file = files[i];
            error.pointer = message.value("pointer", "");
            error.what = fmt::format("{} ({}, {} of the Khronos glTF validator)",
                                     message.value("message", ""), message.value("code", ""),
                                     message.value("severity", 0) == 0 ? "an error" : "a warning");
            errors.push_back(std::move(error));
        }
    return errors;
}

namespace {

std::vector<std::string> models_of(const content::Assembly& assembly) {
    std::vector<std::string> files;
    for (const std::string& file :
         {assembly.models.model, assembly.models.far_level, assembly.models.contact, assembly.wrench.model})
        if (!file.empty() && std::find(files.begin(), files.end(), file) == files.end())
            files.push_back(file);
    return files;
}

// What is said of an assembly that loads: its mistakes, and what an author should know although it is none.
struct Verdict {
    std::vector<Error> errors;
    std::string remarks;  // a line each
};

Verdict judge(const content::Assembly& assembly) {
    Verdict verdict;
    geometry::Findings findings = geometry::check_geometry(assembly);
    verdict.errors = std::move(findings.errors);
    for (const Error& note : findings.notes) verdict.remarks += fmt::format("note: {}\n", note.message());
    const std::vector<std::string> files = models_of(assembly);
    if (assembly.models.model.empty())
        verdict.remarks += fmt::format(
            "note: {}: no model is named, so nodes and room for the wrench are not checked\n", assembly.file);
    if (files.empty()) return verdict;
    const std::filesystem::path script = gltf_validator();
    if (script.empty()) {
        verdict.remarks +=
            "note: the Khronos glTF validator is not installed, so its checks are left out "
            "(tools/install-node-tools.sh installs it)\n";
        return verdict;
    }
    auto said = run_gltf_validator(script, files);
    if (said)
        verdict.errors.insert(verdict.errors.end(), said->begin(), said->end());
    else
        verdict.errors.push_back(said.error());
    return verdict;
}

int run_validate(const std::vector<std::string>& assemblies, const std::string& variant) {
    int worst = 0;
    for (const std::string& where : assemblies) {
        const content::Loaded loaded = content::load_assembly(where, variant);
        if (!loaded.ok()) {
            worst = std::max(worst, print_error(loaded.errors));
            continue;
        }
        const Verdict verdict = judge(loaded.assembly);
        std::string text = verdict.remarks;
        if (verdict.errors.empty())
            text += fmt::format("{}: {} joints, {} passes, variant {}: no mistakes\n", loaded.assembly.file,
                                loaded.assembly.joints.size(), loaded.assembly.passes.size(),
                                loaded.assembly.variant.empty() ? "-" : loaded.assembly.variant);
        worst = std::max(worst, print_error(verdict.errors));
        if (const Status said = print(text); !said) return print_error(said.error());
    }
    return worst;
}

}  // namespace

void add_validate(CLI::App& app, int& exit_code) {
    struct Options {
        std::vector<std::string> assemblies;
        std::string variant;
    };
    auto options = std::make_shared<Options>();
    CLI::App* validate = app.add_subcommand("validate", "Say everything that is wrong with assemblies");
    validate->add_option("assembly", options->assemblies, "Folders, files, or names under content/assemblies")
        ->required();
    validate->add_option("--variant", options->variant, "Material variant; the default if not given");
    validate->callback(
        [options, &exit_code] { exit_code = run_validate(options->assemblies, options->variant); });
}

}  // namespace bolt::author

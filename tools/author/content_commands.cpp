// The subcommands for content: new (a small assembly), words (check of the on-screen texts) and views
// (visibility of the nuts).
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"
#include "engine/base/result.hpp"
#include "engine/text/fonts.hpp"
#include "engine/text/layout.hpp"
#include "game/lesson/fastener_names.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"
#include "tools/author/commands.hpp"

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

}  // namespace bolt::author

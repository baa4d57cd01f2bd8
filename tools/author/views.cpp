// bolt-author views: from which of its views each nut of an assembly can be seen.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "content/format/assembly.hpp"
#include "engine/base/console.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/nut_views.hpp"
#include "game/session/servo_setup.hpp"
#include "tools/author/commands.hpp"

namespace bolt::author {

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

}  // namespace bolt::author

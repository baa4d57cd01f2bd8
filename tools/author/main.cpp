// bolt-author: the command-line tool for authors of assemblies.
#include "engine/program/program.hpp"
#include "tools/author/commands.hpp"

int main(int argc, char** argv) {
    CLI::App app("Makes and checks Boltwright assemblies.", "bolt-author");
    app.require_subcommand(1);
    app.set_version_flag("--version", "bolt-author " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    bolt::author::add_new(app, exit_code);
    bolt::author::add_validate(app, exit_code);
    bolt::author::add_preview(app, exit_code);
    bolt::author::add_import_step(app, exit_code);
    bolt::author::add_curve(app, exit_code);
    bolt::author::add_torque(app, exit_code);
    bolt::author::add_tool(app, exit_code);
    bolt::author::add_tools(app, exit_code);
    bolt::author::add_views(app, exit_code);
    bolt::author::add_words(app, exit_code);
    return bolt::run_command_line(app, argc, argv, exit_code);
}

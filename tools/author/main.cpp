// bolt-author: the tool of those who make assemblies.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "tools/author/commands.hpp"

int main(int argc, char** argv) {
    CLI::App app("Makes and checks Boltwright assemblies.", "bolt-author");
    app.require_subcommand(1);
    app.set_version_flag("--version", "bolt-author " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    bolt::author::add_new(app, exit_code);
    bolt::author::add_validate(app, exit_code);
    bolt::author::add_curve(app, exit_code);
    bolt::author::add_torque(app, exit_code);
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {  // out of memory, say
        (void)std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
    return exit_code;
}

// boltwright: the trainer. The commands are in game/cli.

#include <CLI/CLI.hpp>
#include <cstdio>

#include "game/cli/commands.hpp"

int main(int argc, char** argv) {
    CLI::App app("Boltwright trains people to assemble bolted joints by feel.", "boltwright");
    app.require_subcommand(1);
    app.set_version_flag("--version", "boltwright " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    bolt::cli::add_train(app, exit_code);
    bolt::cli::add_report(app, exit_code);
    bolt::cli::add_export(app, exit_code);
    bolt::cli::add_compare(app, exit_code);
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

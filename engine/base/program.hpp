// The main() of every command-line program: parses the arguments and catches unexpected exceptions.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace bolt {

// Parses the arguments and runs the subcommand, which stores its result in `exit_code`. Returns 2 for every
// usage error, whatever code CLI11 uses.
inline int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code) {
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? 0 : 2;
    } catch (const std::exception& error) {  // for example out of memory
        (void)std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
    }
    return exit_code;
}

}  // namespace bolt

// What both command-line programs do with their arguments and with what nobody expected.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace bolt::cli {

// Parses and runs; the subcommands leave their result in exit_code. Usage errors are 2, whatever CLI11 calls
// them.
inline int run_program(CLI::App& app, int argc, char** argv, const int& exit_code) {
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

}  // namespace bolt::cli

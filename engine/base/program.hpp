// The common part of every command-line program's main().
#pragma once

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>

namespace bolt {

// Parses the arguments and runs the subcommand, whose callback stores its result in `exit_code`. Returns
// `exit_code`, 2 for every usage error (CLI11's own codes differ), or 1 after an unexpected exception.
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

// The main function of every command-line program, and the texts that are made from its options.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace bolt {

// Parses the arguments and runs the subcommand, whose callback stores its result in `exit_code`. Returns
// `exit_code`, 2 for every usage error (CLI11's own codes differ), or 1 after an unexpected exception.
// `PROGRAM --man-page` and `PROGRAM --bash-completion` print the texts below; packages are made with them.
int run_command_line(CLI::App& app, int argc, char** argv, const int& exit_code);

// The manual page of a program in the language of man(7): its subcommands and options, exit codes and
// environment variables.
std::string man_page(const CLI::App& app);

// A script for bash that completes subcommands, options, and the values of options that accept one of a list;
// anything else is completed as a file name.
std::string bash_completion(const CLI::App& app);

}  // namespace bolt

// The main function of boltwright, and its handling of SIGINT and SIGTERM. The subcommands are in the other
// files of game/cli.

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>
#include <vector>

#include "engine/base/process.hpp"
#include "engine/program/program.hpp"
#include "game/cli/commands.hpp"

namespace bolt::cli {
namespace {

volatile std::sig_atomic_t end_requested = 0;  // written by the signal handler

}  // namespace

void catch_interruption() {
    for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, [](int) { end_requested = 1; });
}

bool interrupted() { return end_requested != 0; }

int report_error(const Error& error) {
    const int exit_code = print_error(error);
    if (isatty(STDERR_FILENO) == 1) return exit_code;
    const std::string text = error.message();
    for (const std::vector<std::string>& window :
         {std::vector<std::string>{"zenity", "--error", "--no-markup", "--title=Boltwright",
                                   "--text=" + text},
          std::vector<std::string>{"kdialog", "--title", "Boltwright", "--error", text},
          std::vector<std::string>{"xmessage", "-center", "-name", "Boltwright", text}}) {
        if (run_program(window, Capture::output_and_errors)) break;  // else it is not installed
    }
    return exit_code;
}

}  // namespace bolt::cli

int main(int argc, char** argv) {
    // Suppresses OpenAL's messages on missing devices; engine/audio reports them once.
    (void)::setenv("ALSOFT_LOGLEVEL", "0", 0);
    // Exceeding the file size limit becomes a write error, as on a full disk.
    (void)std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app("Boltwright trains people to assemble bolted joints by feel.", "boltwright");
    app.footer("Without a command the menu opens in a window.");
    app.require_subcommand(0, 1);
    app.set_version_flag("--version", "boltwright " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    bolt::cli::add_train(app, exit_code);
    bolt::cli::add_open(app, exit_code);
    bolt::cli::add_replay(app, exit_code);
    bolt::cli::add_report(app, exit_code);
    bolt::cli::add_export(app, exit_code);
    bolt::cli::add_compare(app, exit_code);
    bolt::cli::add_measure(app, exit_code);
    bolt::cli::add_render(app, exit_code);
    bolt::cli::add_doctor(app, exit_code);
    bolt::cli::add_glove(app, exit_code);
    bolt::cli::add_devices(app, exit_code);
    bolt::cli::add_station(app, exit_code);
    bolt::cli::add_displays(app, exit_code);
    bolt::cli::add_study(app, exit_code);
    bolt::cli::add_trainees(app, exit_code);
    app.callback([&] {
        if (!app.get_subcommands().empty()) return;
        const bolt::Status done = bolt::cli::train_from_desktop();
        exit_code = done ? 0 : bolt::cli::report_error(done.error());
    });
    return bolt::run_command_line(app, argc, argv, exit_code);
}

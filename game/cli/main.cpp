#include "game/cli/interruption.hpp"

#include <csignal>
#include <cstdlib>

#include "engine/base/program.hpp"
#include "game/cli/commands.hpp"

namespace bolt::cli {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;  // what a signal handler may write

}  // namespace

void catch_interruption() {
    for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, [](int) { asked_to_end = 1; });
}

bool interrupted() { return asked_to_end != 0; }

}  // namespace bolt::cli

// boltwright: the trainer. The commands are in game/cli.

int main(int argc, char** argv) {
    // What OpenAL prints of devices that are not there is said once, in our words (engine/audio).
    (void)::setenv("ALSOFT_LOGLEVEL", "0", 0);
    // A file that may not grow is told by whoever writes it, as a full disk is.
    (void)std::signal(SIGXFSZ, SIG_IGN);
    CLI::App app("Boltwright trains people to assemble bolted joints by feel.", "boltwright");
    app.require_subcommand(1);
    app.set_version_flag("--version", "boltwright " BOLTWRIGHT_VERSION);
    int exit_code = 0;
    bolt::cli::add_train(app, exit_code);
    bolt::cli::add_replay(app, exit_code);
    bolt::cli::add_report(app, exit_code);
    bolt::cli::add_export(app, exit_code);
    bolt::cli::add_compare(app, exit_code);
    bolt::cli::add_render(app, exit_code);
    bolt::cli::add_doctor(app, exit_code);
    bolt::cli::add_glove(app, exit_code);
    bolt::cli::add_devices(app, exit_code);
    return bolt::run_command_line(app, argc, argv, exit_code);
}

// The main function of boltwright, and its handling of SIGINT and SIGTERM. The subcommands are in the other
// files of game/cli.

#include <csignal>
#include <cstdlib>

#include "engine/base/program.hpp"
#include "game/cli/commands.hpp"

namespace bolt::cli {
namespace {

volatile std::sig_atomic_t end_requested = 0;  // written by the signal handler

}  // namespace

void catch_interruption() {
    for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, [](int) { end_requested = 1; });
}

bool interrupted() { return end_requested != 0; }

}  // namespace bolt::cli

int main(int argc, char** argv) {
    // Suppresses OpenAL's messages on missing devices; engine/audio reports them once.
    (void)::setenv("ALSOFT_LOGLEVEL", "0", 0);
    // Exceeding the file size limit becomes a write error, as on a full disk.
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

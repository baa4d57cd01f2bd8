#include "game/cli/interruption.hpp"

#include <csignal>

namespace bolt::cli {
namespace {

volatile std::sig_atomic_t asked_to_end = 0;  // what a signal handler may write

}  // namespace

void catch_interruption() {
    for (const int signal : {SIGINT, SIGTERM}) (void)std::signal(signal, [](int) { asked_to_end = 1; });
}

bool interrupted() { return asked_to_end != 0; }

}  // namespace bolt::cli

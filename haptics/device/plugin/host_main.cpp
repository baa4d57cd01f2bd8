// bolt-arm-host PLUGIN: the process of a plug-in for arms. Boltwright starts it; its standard input is a
// socket.
#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>

#include "engine/base/result.hpp"
#include "haptics/device/plugin/arm_host.hpp"

namespace {

// Moves the socket away from the standard input, where plug-ins expect none. Returns -1 if there is none.
int take_socket() {
    int type = 0;
    socklen_t length = sizeof type;
    if (::getsockopt(STDIN_FILENO, SOL_SOCKET, SO_TYPE, &type, &length) != 0) return -1;
    const int socket = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 3);
    const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
    ::dup2(nothing, STDIN_FILENO);
    ::close(nothing);
    return socket;
}

}  // namespace

int main(int argc, char** argv) {
    const int socket = argc == 2 ? take_socket() : -1;
    if (socket < 0) {
        bolt::Error error;
        error.code = bolt::ErrorCode::usage;
        error.what = "bolt-arm-host was not started by Boltwright";
        error.expected = "`boltwright devices`, which starts it and lists the arms of plug-ins";
        return bolt::print_error(error);
    }
    ::dup2(STDERR_FILENO, STDOUT_FILENO);  // a plug-in's output must not mix with results
    // Ctrl-C also reaches Boltwright, which ends and then closes the arm, so this process ignores it. A crash
    // must end this process by its signal, also under sanitizers, because Boltwright's error message names
    // the signal.
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) (void)std::signal(signal, SIG_IGN);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT}) (void)std::signal(signal, SIG_DFL);
    bolt::device::run_arm_host(argv[1], socket);
}

// Runs other programs in three ways: until they exit, with captured output; with a stream of bytes to their
// standard input; with an exchange of packets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

struct ProgramResult {
    int exit_code = 0;   // -1: a signal ended the program
    std::string output;  // the captured streams
};

enum class Capture : std::uint8_t { output, output_and_errors };

// Runs a program until it exits and captures its output. The program is searched for on the PATH and inherits
// our standard input. Fails if the program cannot be started.
Result<ProgramResult> run_program(const std::vector<std::string>& command, Capture capture);

// A running program that reads bytes from its standard input, such as FFmpeg, which encodes pictures.
class ChildStdin {
  public:
    // The program is searched for on the PATH and inherits our output streams. Fails if it cannot be started.
    static Result<ChildStdin> start(const std::vector<std::string>& command);
    ChildStdin(ChildStdin&& other) noexcept;
    ChildStdin& operator=(ChildStdin&& other) noexcept;
    ~ChildStdin();  // calls finish()

    // Fails if the program no longer reads its input. Our own process must ignore SIGPIPE.
    Status write(std::span<const std::uint8_t> bytes);

    // Closes the input and waits for the program to exit. Returns its exit code; -1 if a signal ended it or
    // if finish() was called before.
    int finish();

  private:
    ChildStdin(int pipe, int child, std::string name) : pipe_(pipe), child_(child), name_(std::move(name)) {}
    int pipe_ = -1, child_ = -1;
    std::string name_;
};

struct ProgramEnd {
    int exit_code = 0;
    int signal = 0;       // the signal that ended the program; 0: it exited
    bool killed = false;  // by us, because it did not exit in time
};

// A running program that exchanges packets with us. Its standard input is a socket (SOCK_SEQPACKET), on which
// it receives and sends.
class ChildSocket {
  public:
    // The program is searched for on the PATH and inherits our output streams. Fails if it cannot be started.
    static Result<ChildSocket> start(const std::vector<std::string>& command);
    ChildSocket(ChildSocket&& other) noexcept;
    ChildSocket& operator=(ChildSocket&& other) noexcept;
    ~ChildSocket();  // kills the program unless end() was called

    // Never waits. Fails if the program has ended, or if its queue is full because it does not read.
    Status send(std::span<const std::byte> packet);

    // Waits at most `timeout` s for a packet and returns its length; nullopt on timeout. A length above the
    // size of `packet` means that the end of the packet was lost. Fails if the program has ended.
    Result<std::optional<std::size_t>> receive(std::span<std::byte> packet, double timeout);

    // Closes the program's input, waits at most `patience` s for it to exit, and then kills it. Later calls
    // return the same result.
    ProgramEnd end(double patience);

  private:
    ChildSocket(int socket, int child, std::string name)
        : socket_(socket), child_(child), name_(std::move(name)) {}
    int socket_ = -1, child_ = -1;
    std::string name_;
    ProgramEnd end_;
};

}  // namespace bolt

// Runs other programs: until they exit, with captured output, or with a stream of bytes on their standard
// input.
#pragma once

#include <cstdint>
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

    // Fails if the program no longer reads its input. The process must ignore SIGPIPE.
    Status write(std::span<const std::uint8_t> bytes);

    // Closes the input and waits for the program to exit. Returns its exit code; -1 if a signal ended it or
    // if finish() was called before.
    int finish();

  private:
    ChildStdin(int pipe, int child, std::string name) : pipe_(pipe), child_(child), name_(std::move(name)) {}
    int pipe_ = -1, child_ = -1;
    std::string name_;
};

}  // namespace bolt

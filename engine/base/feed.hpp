// Another program that is fed through its standard input: FFmpeg with pictures.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt {

class Feed {
  public:
    // The program is looked for on the path; what it prints is ours. An error: it cannot be started.
    static Result<Feed> start(const std::vector<std::string>& command);
    Feed(Feed&& other) noexcept;
    Feed& operator=(Feed&& other) noexcept;
    ~Feed();  // ends its input and waits for it

    // An error: the program takes no more. SIGPIPE has to be ignored by whoever runs this.
    Status write(std::span<const std::uint8_t> bytes);

    // Ends its input and waits; the exit code, −1: a signal ended it.
    int finish();

  private:
    Feed(int pipe, int child, std::string name) : pipe_(pipe), child_(child), name_(std::move(name)) {}
    int pipe_ = -1, child_ = -1;
    std::string name_;
};

}  // namespace bolt

// An emulated glove at one end of a pseudo-terminal; the other end is a port that any driver can open.
#pragma once

#include <filesystem>
#include <memory>

#include "tools/emulate/glove.hpp"

namespace bolt::emulate {

class SerialGlove {
  public:
    // A thread plays the glove from now on. The hand in it opens and closes once in `period` seconds; 0: it
    // stays as it is.
    static Result<SerialGlove> start(const GloveOptions& design, double period = 0.0);

    SerialGlove(SerialGlove&&) noexcept;
    SerialGlove& operator=(SerialGlove&&) noexcept;
    ~SerialGlove();  // pulls the plug: the port is gone

    [[nodiscard]] const std::filesystem::path& port() const;
    // What the hand in it does from the next moment on, unless it opens and closes by itself. One thread at a
    // time.
    void show(const hand::PerSensor<std::uint8_t>& raw);
    void stall(bool stalled);  // from the next moment on it neither sends nor hears

  private:
    struct Shared;
    explicit SerialGlove(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate

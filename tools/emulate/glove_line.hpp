// An emulated glove at one end of a pseudo-terminal; the other end is a port that any driver can open.
#pragma once

#include <filesystem>
#include <memory>

#include "tools/emulate/glove.hpp"

namespace bolt::emulate {

class GloveLine {
  public:
    // A thread plays the glove from now on. The hand in it opens and closes once in `period` seconds; 0: it
    // stays as it is.
    static Result<GloveLine> start(const GloveDesign& design, double period = 0.0);

    GloveLine(GloveLine&&) noexcept;
    GloveLine& operator=(GloveLine&&) noexcept;
    ~GloveLine();  // pulls the plug: the port is gone

    [[nodiscard]] const std::filesystem::path& port() const;
    // What the hand in it does from the next moment on, unless it opens and closes by itself. One thread at a
    // time.
    void show(const glove::BySensor<std::uint8_t>& raw);
    void stall(bool stalled);  // from the next moment on it neither sends nor hears

  private:
    struct Shared;
    explicit GloveLine(std::unique_ptr<Shared> shared);
    std::unique_ptr<Shared> shared_;
};

}  // namespace bolt::emulate

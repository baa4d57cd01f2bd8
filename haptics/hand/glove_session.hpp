// The whole communication with a glove: handshake, stream, and a new handshake after silence. Pure: bytes and
// time in, bytes and frames out; glove_driver.hpp adds the port and the thread.
#pragma once

#include <string>

#include "haptics/hand/glove_handshake.hpp"

namespace bolt::hand {

enum class GloveState : std::uint8_t {
    handshake,  // identifying the glove
    streaming,
    silent,    // streamed before, sends nothing now
    rejected,  // the device on the line is not a supported glove; retried later
};

struct GloveSessionOptions {
    GloveHandshakeOptions handshake;
    double silence = 0.25;  // s without a frame until a new handshake
    double pause = 1.0;     // s until a rejected device is tried again
};

class GloveSession {
  public:
    explicit GloveSession(const GloveSessionOptions& options = {});

    // `received`: bytes since the last call; `now`: s. Returns the bytes to send; calls `on_frame` for each
    // frame.
    std::vector<std::uint8_t> update(std::span<const std::uint8_t> received, double now,
                                     FunctionRef<void(const GloveFrame&)> on_frame);

    [[nodiscard]] GloveState state() const { return state_; }
    [[nodiscard]] const GloveIdentity& identity() const {
        return identity_;
    }  // from the last successful handshake
    [[nodiscard]] const std::string& trouble() const { return trouble_; }  // empty: none
    [[nodiscard]] std::uint64_t frames() const { return frames_; }
    [[nodiscard]] std::uint64_t lost_bytes() const { return lost_ + reader_.lost; }
    [[nodiscard]] std::uint64_t handshakes() const { return handshakes_; }  // that succeeded

  private:
    std::vector<std::uint8_t> start_handshake(double now, GloveState meanwhile);

    GloveSessionOptions options_;
    GloveState state_ = GloveState::handshake;
    GloveHandshake handshake_;
    GloveFrameReader reader_;
    GloveIdentity identity_;
    std::string trouble_;
    double since_ = 0.0;
    bool started_ = false;
    std::uint64_t frames_ = 0, lost_ = 0, handshakes_ = 0;
};

}  // namespace bolt::hand

// The simulated headset and controllers of the OpenXR runtime Monado, whose poses a program sets by messages:
// driver "remote" of Monado 25 (P_OVERRIDE_ACTIVE_CONFIG=remote), which listens on TCP port 4242.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "engine/base/math.hpp"
#include "engine/base/result.hpp"
#include "engine/xr/input.hpp"

namespace bolt::test {

// A message sets the whole state. Little-endian; offsets in bytes.
inline constexpr std::size_t remote_message_size = 376;
using RemoteMessage = std::array<std::byte, remote_message_size>;

// Writes head and hands into a message. An inactive hand becomes a controller that is switched off. The
// runtime takes a controller's pose for both grip and aim. With `joints` it simulates fingers, as closed as
// `grasp` says.
void write_poses(RemoteMessage& message, const Pose& head, const xr::Hands& hands);

class RemoteHeadset {
  public:
    // Connects to the runtime on this computer, and receives its initial state.
    static Result<RemoteHeadset> connect(std::uint16_t port = 4242);
    RemoteHeadset(RemoteHeadset&& other) noexcept;
    RemoteHeadset& operator=(RemoteHeadset&&) = delete;
    RemoteHeadset(const RemoteHeadset&) = delete;
    RemoteHeadset& operator=(const RemoteHeadset&) = delete;
    ~RemoteHeadset();

    // Fails if the runtime has closed the connection.
    Status send(const Pose& head, const xr::Hands& hands);

  private:
    explicit RemoteHeadset(int socket) : socket_(socket) {}

    int socket_ = -1;
    RemoteMessage message_{};
};

}  // namespace bolt::test

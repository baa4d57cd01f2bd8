// Receives DTrack's packets on a UDP port, without waiting and without a thread.
#pragma once

#include <cstdint>
#include <optional>

#include "engine/base/result.hpp"
#include "engine/tracking/dtrack.hpp"

namespace bolt::tracking {

struct DtrackCounts {
    std::uint64_t good_packets = 0;       // late packets included
    std::uint64_t malformed_packets = 0;  // damaged or too long, or of other programs
    std::uint64_t late_packets = 0;       // good packets that arrived after a newer one, or twice
    std::uint64_t invalid_bodies = 0;     // bodies and flysticks whose values are no pose
};

class DtrackReceiver {
  public:
    // Binds to the port on all IPv4 addresses; 0: a free port, for tests. Fails with ErrorCode::no_device if
    // another program has the port.
    static Result<DtrackReceiver> open(int port);
    DtrackReceiver(DtrackReceiver&& other) noexcept;
    DtrackReceiver& operator=(DtrackReceiver&& other) noexcept;
    ~DtrackReceiver();

    // The newest frame that has arrived since the last call; nullopt if there is none. Reads at most
    // max_packets_per_poll packets, so that a flood of packets cannot stop the caller.
    std::optional<DtrackFrame> poll();

    [[nodiscard]] const DtrackCounts& counts() const { return counts_; }
    [[nodiscard]] int port() const { return port_; }

  private:
    DtrackReceiver(int socket, int port) : socket_(socket), port_(port) {}
    bool is_newer(std::uint32_t number);

    int socket_ = -1;
    int port_ = 0;
    std::optional<std::uint32_t> newest_;  // number of the newest frame
    DtrackCounts counts_;
};

inline constexpr std::size_t max_dtrack_packet = 16384;  // bytes; a longer packet is malformed
inline constexpr int max_packets_per_poll = 256;

}  // namespace bolt::tracking

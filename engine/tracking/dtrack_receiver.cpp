#include "engine/tracking/dtrack_receiver.hpp"

#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

namespace bolt::tracking {

namespace {

// A frame number that is less than this behind the newest one belongs to a late packet. A larger step back
// means that the measurement was restarted.
constexpr std::uint32_t max_late_frames = 100;

Result<int> bound_port(int socket) {
    sockaddr_in address{};
    socklen_t size = sizeof address;
    if (::getsockname(socket, reinterpret_cast<sockaddr*>(&address), &size) != 0)
        return fail(ErrorCode::failed, fmt::format("cannot read the UDP port: {}", std::strerror(errno)),
                    "a usable network interface");
    return ntohs(address.sin_port);
}

}  // namespace

Result<DtrackReceiver> DtrackReceiver::open(int port) {
    if (port < 0 || port > 65535)
        return fail(ErrorCode::usage, fmt::format("{} is not a UDP port", port), "1 to 65535");
    const int socket = ::socket(AF_INET, SOCK_DGRAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
    if (socket < 0)
        return fail(ErrorCode::failed, fmt::format("cannot open a UDP socket: {}", std::strerror(errno)),
                    "fewer open files");
    DtrackReceiver receiver(socket, port);  // closes the socket, also after an error
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_ANY);
    if (::bind(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return fail(ErrorCode::no_device, fmt::format("UDP port {}: {}", port, std::strerror(errno)),
                    "a port that no other program uses");
    BOLT_TRY_ASSIGN(receiver.port_, bound_port(socket));
    return receiver;
}

DtrackReceiver::DtrackReceiver(DtrackReceiver&& other) noexcept { *this = std::move(other); }

DtrackReceiver& DtrackReceiver::operator=(DtrackReceiver&& other) noexcept {
    std::swap(socket_, other.socket_);
    std::swap(port_, other.port_);
    std::swap(newest_, other.newest_);
    std::swap(counts_, other.counts_);
    return *this;
}

DtrackReceiver::~DtrackReceiver() {
    if (socket_ >= 0) ::close(socket_);
}

bool DtrackReceiver::is_newer(std::uint32_t number) {
    // Modulo 2³²: huge for a newer number.
    const std::uint32_t behind = newest_ ? *newest_ - number : max_late_frames;
    if (behind < max_late_frames) return false;
    newest_ = number;
    return true;
}

std::optional<DtrackFrame> DtrackReceiver::poll() {
    std::optional<DtrackFrame> newest;
    std::array<char, max_dtrack_packet> buffer;
    for (int i = 0; i < max_packets_per_poll; ++i) {
        const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), MSG_TRUNC);
        if (size < 0 && errno == EINTR) continue;
        if (size < 0) break;  // no more packets
        const auto length =
            static_cast<std::size_t>(size);  // of the packet, which may be longer than the buffer
        auto frame = length <= buffer.size() ? parse_dtrack({buffer.data(), length}) : std::nullopt;
        if (!frame) {
            ++counts_.malformed_packets;
            continue;
        }
        ++counts_.good_packets;
        counts_.invalid_bodies += static_cast<std::uint64_t>(frame->invalid_bodies);
        if (is_newer(frame->number))
            newest = std::move(frame);
        else
            ++counts_.late_packets;
    }
    return newest;
}

}  // namespace bolt::tracking

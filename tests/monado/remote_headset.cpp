#include "tests/monado/remote_headset.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

namespace bolt::test {

namespace {

constexpr char magic[8] = "mndrmt3";  // the runtime's own messages begin with zeros
constexpr std::size_t head_at = 104, own_views_at = 132;
constexpr std::array<std::size_t, 2> hands_at{136, 256};
// In a hand: after the pose and six velocities the curl of five fingers, trigger, squeeze, and further on the
// stick; then single bytes.
constexpr std::size_t curl_at = 52, trigger_at = 72, squeeze_at = 76, stick_at = 84, joints_at = 104,
                      active_at = 105, secondary_at = 108, menu_at = 110;

void put(RemoteMessage& message, std::size_t at, float value) {
    std::memcpy(message.data() + at, &value, sizeof value);
}

void put(RemoteMessage& message, std::size_t at, const Pose& pose) {
    const double values[] = {pose.orientation.x, pose.orientation.y, pose.orientation.z, pose.orientation.w,
                             pose.position.x,    pose.position.y,    pose.position.z};
    for (const double value : values) {
        put(message, at, static_cast<float>(value));
        at += sizeof(float);
    }
}

Error socket_error(const char* what) {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("Monado's remote driver: {}: {}", what, std::strerror(errno));
    error.expected = "monado-service with P_OVERRIDE_ACTIVE_CONFIG=remote on this computer";
    return error;
}

}  // namespace

void write_poses(RemoteMessage& message, const Pose& head, const xr::Hands& hands) {
    std::memcpy(message.data(), magic, sizeof magic);
    put(message, head_at, head);
    message[own_views_at] = std::byte{0};
    for (std::size_t side = 0; side < hands_at.size(); ++side) {
        const xr::HandInput& hand = hands.sides[side];
        const std::size_t at = hands_at[side];
        if (hand.grip) put(message, at, hand.grip->pose);
        for (std::size_t finger = 0; finger < 5; ++finger)
            put(message, at + curl_at + 4 * finger, hand.grasp);
        put(message, at + trigger_at, hand.select);
        put(message, at + squeeze_at, hand.grasp);
        put(message, at + stick_at, hand.stick.x);
        put(message, at + stick_at + 4, hand.stick.y);
        message[at + joints_at] = hand.joints ? std::byte{1} : std::byte{0};
        message[at + active_at] = hand.active ? std::byte{1} : std::byte{0};
        message[at + secondary_at] = hand.secondary ? std::byte{1} : std::byte{0};
        message[at + menu_at] = hand.menu ? std::byte{1} : std::byte{0};
    }
}

Result<RemoteHeadset> RemoteHeadset::connect(std::uint16_t port) {
    RemoteHeadset remote(::socket(AF_INET, SOCK_STREAM, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (remote.socket_ < 0 ||
        ::connect(remote.socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        return fail(socket_error("no connection"));
    const int on = 1;  // a message is small, and is to arrive before the next frame
    (void)::setsockopt(remote.socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (::recv(remote.socket_, remote.message_.data(), remote_message_size, MSG_WAITALL) !=
        static_cast<ssize_t>(remote_message_size))
        return fail(socket_error("no initial state"));
    return remote;
}

RemoteHeadset::RemoteHeadset(RemoteHeadset&& other) noexcept
    : socket_(std::exchange(other.socket_, -1)), message_(other.message_) {}

RemoteHeadset::~RemoteHeadset() {
    if (socket_ >= 0) (void)::close(socket_);
}

Status RemoteHeadset::send(const Pose& head, const xr::Hands& hands) {
    write_poses(message_, head, hands);
    if (::send(socket_, message_.data(), message_.size(), MSG_NOSIGNAL) !=
        static_cast<ssize_t>(remote_message_size))
        return fail(socket_error("no message could be sent"));
    return {};
}

}  // namespace bolt::test

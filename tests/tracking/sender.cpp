#include "tests/tracking/sender.hpp"

#include <doctest/doctest.h>
#include <sys/socket.h>
#include <unistd.h>

namespace bolt::test {

UdpSender::UdpSender(int port) : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    address_.sin_family = AF_INET;
    address_.sin_port = htons(static_cast<std::uint16_t>(port));
    address_.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
}

UdpSender::~UdpSender() { ::close(socket_); }

void UdpSender::send(const std::string& packet) const {
    const ssize_t sent = ::sendto(socket_, packet.data(), packet.size(), 0,
                                  reinterpret_cast<const sockaddr*>(&address_), sizeof address_);
    REQUIRE(sent == static_cast<ssize_t>(packet.size()));
}

}  // namespace bolt::test

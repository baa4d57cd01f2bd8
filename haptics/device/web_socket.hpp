// A WebSocket client for a service on this computer or its network. Each call has a time limit, so one thread
// can exchange messages and still check for a stop request.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "engine/base/result.hpp"

namespace bolt::device {

struct SocketAddress {
    std::string host = "127.0.0.1";  // an IP address; names are not resolved, because that has no time limit
    std::uint16_t port = 0;

    [[nodiscard]] std::string text() const;  // "127.0.0.1:10001"
};

inline constexpr std::size_t max_message_size = 65536;  // bytes; a larger message is an error

// Each call times out after `timeout` s. All errors have ErrorCode::no_device, and name the address.
class WebSocket {
  public:
    static Result<WebSocket> connect(const SocketAddress& address, double timeout);

    WebSocket(WebSocket&&) noexcept;
    WebSocket& operator=(WebSocket&&) noexcept;
    ~WebSocket();  // closes the connection at once, without a closing handshake

    // Sends a text message. After an error the connection cannot be used any more.
    Status send(std::string_view message, double timeout);

    // Waits for the next message; nullopt if none comes in time. An error means that the connection has
    // ended.
    Result<std::optional<std::string>> receive(double timeout);

  private:
    struct Connection;
    explicit WebSocket(std::unique_ptr<Connection> connection);
    std::unique_ptr<Connection> connection_;
};

// Returns the text at `path`, for example /version, over HTTP.
Result<std::string> http_get(const SocketAddress& address, std::string_view path, double timeout);

}  // namespace bolt::device

#include "haptics/device/web_socket.hpp"

#include <fmt/format.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>

namespace bolt::device {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using ErrorOfBoost = boost::system::error_code;
using Clock = std::chrono::steady_clock;

Clock::time_point in(double seconds) {
    return Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

// Runs the operation that start(handler) begins, and returns its error. After `end` it is cancelled by
// closing `stream`; the error is then asio::error::timed_out.
template <class Start>
ErrorOfBoost run_until(asio::io_context& io, beast::tcp_stream& stream, Clock::time_point end, Start start) {
    std::optional<ErrorOfBoost> result;
    start([&result](ErrorOfBoost error, auto&&...) { result = error; });
    io.restart();
    while (!result && io.run_one_until(end) > 0) {
    }
    if (result) return *result;
    stream.close();
    // The handler still refers to `result`, so it has to run before this function returns.
    io.restart();
    while (!result && io.run_one() > 0) {
    }
    return asio::error::timed_out;
}

Error socket_error(const SocketAddress& address, const ErrorOfBoost& error) {
    Error result;
    result.code = ErrorCode::no_device;
    result.what = fmt::format("{}: {}", address.text(), error.message());
    result.expected = "a service that answers at this address";
    return result;
}

ErrorOfBoost connect_stream(asio::io_context& io, beast::tcp_stream& stream, const SocketAddress& address,
                            Clock::time_point end) {
    ErrorOfBoost error;
    const asio::ip::address host = asio::ip::make_address(address.host, error);
    if (error) return error;
    error = run_until(io, stream, end, [&](auto handler) {
        stream.async_connect(asio::ip::tcp::endpoint(host, address.port), std::move(handler));
    });
    if (error) return error;
    // Small messages leave at once.
    stream.socket().set_option(asio::ip::tcp::no_delay(true), error);
    return error;
}

// The answer to the request, in at most `max_message_size` bytes.
ErrorOfBoost exchange(asio::io_context& io, beast::tcp_stream& stream,
                      http::request<http::empty_body>& request,
                      http::response_parser<http::string_body>& response, Clock::time_point end) {
    if (const ErrorOfBoost error = run_until(
            io, stream, end, [&](auto handler) { http::async_write(stream, request, std::move(handler)); }))
        return error;
    response.body_limit(max_message_size);
    beast::flat_buffer buffer(max_message_size);
    return run_until(io, stream, end,
                     [&](auto handler) { http::async_read(stream, buffer, response, std::move(handler)); });
}

}  // namespace

std::string SocketAddress::text() const { return fmt::format("{}:{}", host, port); }

struct WebSocket::Connection {
    explicit Connection(SocketAddress a) : address(std::move(a)) {}

    SocketAddress address;
    asio::io_context io{1};
    beast::websocket::stream<beast::tcp_stream, false> stream{io};  // without compression
    beast::flat_buffer buffer;
    bool reading = false;  // a read is in progress, possibly since an earlier call
    std::optional<ErrorOfBoost> read;

    beast::tcp_stream& tcp() { return beast::get_lowest_layer(stream); }
};

WebSocket::WebSocket(std::unique_ptr<Connection> connection) : connection_(std::move(connection)) {}
WebSocket::WebSocket(WebSocket&&) noexcept = default;
WebSocket& WebSocket::operator=(WebSocket&&) noexcept = default;
WebSocket::~WebSocket() = default;

Result<WebSocket> WebSocket::connect(const SocketAddress& address, double timeout) {
    try {
        auto connection = std::make_unique<Connection>(address);
        Connection& c = *connection;
        const Clock::time_point end = in(timeout);
        if (const ErrorOfBoost error = connect_stream(c.io, c.tcp(), address, end))
            return fail(socket_error(address, error));
        c.stream.read_message_max(max_message_size);
        if (const ErrorOfBoost error = run_until(c.io, c.tcp(), end, [&](auto handler) {
                c.stream.async_handshake(address.text(), "/", std::move(handler));
            }))
            return fail(socket_error(address, error));
        return WebSocket(std::move(connection));
    } catch (const boost::system::system_error& error) {  // no more file descriptors
        return fail(socket_error(address, error.code()));
    }
}

Status WebSocket::send(std::string_view message, double timeout) {
    Connection& c = *connection_;
    if (const ErrorOfBoost error = run_until(c.io, c.tcp(), in(timeout), [&](auto handler) {
            c.stream.async_write(asio::buffer(message.data(), message.size()), std::move(handler));
        }))
        return fail(socket_error(c.address, error));
    return {};
}

Result<std::optional<std::string>> WebSocket::receive(double timeout) {
    Connection& c = *connection_;
    if (!c.reading) {
        c.reading = true;
        c.read.reset();
        c.stream.async_read(c.buffer, [&c](ErrorOfBoost error, std::size_t) { c.read = error; });
    }
    const Clock::time_point end = in(timeout);
    c.io.restart();
    // poll_one() first reads what has arrived, because run_one_until() does nothing once `end` has passed.
    while (!c.read && (c.io.poll_one() > 0 || c.io.run_one_until(end) > 0)) {
    }
    if (!c.read) return std::optional<std::string>{};
    c.reading = false;
    if (*c.read) return fail(socket_error(c.address, *c.read));
    std::string message = beast::buffers_to_string(c.buffer.data());
    c.buffer.clear();
    return std::optional<std::string>(std::move(message));
}

Result<std::string> http_get(const SocketAddress& address, std::string_view path, double timeout) {
    try {
        asio::io_context io(1);
        beast::tcp_stream stream(io);
        const Clock::time_point end = in(timeout);
        if (const ErrorOfBoost error = connect_stream(io, stream, address, end))
            return fail(socket_error(address, error));
        http::request<http::empty_body> request(http::verb::get, {path.data(), path.size()}, 11);
        request.set(http::field::host, address.text());
        request.set(http::field::connection, "close");
        http::response_parser<http::string_body> response;
        if (const ErrorOfBoost error = exchange(io, stream, request, response, end))
            return fail(socket_error(address, error));
        if (response.get().result() != http::status::ok)
            return fail(
                ErrorCode::no_device,
                fmt::format("{}: {}: HTTP status {}", address.text(), path, response.get().result_int()),
                "200");
        return std::move(response.get().body());
    } catch (const boost::system::system_error& error) {
        return fail(socket_error(address, error.code()));
    }
}

}  // namespace bolt::device

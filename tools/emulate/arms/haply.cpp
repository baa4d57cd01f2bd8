#include "tools/emulate/arms/haply.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core/buffers_to_string.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <cmath>
#include <list>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "engine/base/steady_seconds.hpp"
#include "tools/emulate/arms/haply_model.hpp"

namespace bolt::emulate {

namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using ErrorOfBoost = boost::system::error_code;
using Json = nlohmann::json;
using Request = http::request<http::empty_body>;
using Tcp = asio::ip::tcp;
using SocketStream = websocket::stream<Tcp::socket, false>;  // without compression

constexpr double longest_advance = 0.1;  // s; limits the step after the computer was suspended
constexpr int event_port_offset = 19;
constexpr auto event_interval = std::chrono::milliseconds(2);

// A socket that listens at `port` of this computer; 0: any.
Tcp::acceptor listen_at(asio::io_context& io, int port, ErrorOfBoost& error) {
    Tcp::acceptor acceptor(io);
    const Tcp::endpoint endpoint(asio::ip::address_v4::loopback(), static_cast<std::uint16_t>(port));
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (!error) acceptor.non_blocking(true, error);  // a client may vanish before it is accepted
    return acceptor;
}

}  // namespace

// One thread accepts connections, and each connection has a thread.
struct EmulatedHaply::Service {
    explicit Service(const EmulatedHaplyOptions& o) : options(o), model(o) {}
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;
    ~Service() {
        accepting.request_stop();
        if (accepting.joinable()) accepting.join();
        {
            const std::lock_guard lock(mutex);
            for (const int socket : sockets) ::shutdown(socket, SHUT_RDWR);
        }
        connections.clear();  // joins
    }

    EmulatedHaplyOptions options;
    std::uint16_t port = 0;
    asio::io_context io;
    std::vector<Tcp::acceptor> acceptors;  // states, events, /version of old services
    mutable std::mutex mutex;              // guards the next four members
    HaplyArmModel model;
    double followed = steady_seconds();  // s, time of the model
    std::set<int> sockets;               // of open connections
    std::list<std::jthread> connections;
    std::jthread accepting;

    ErrorOfBoost listen(int first_port) {
        ErrorOfBoost error;
        acceptors.clear();
        acceptors.push_back(listen_at(io, first_port, error));
        if (error) return error;
        port = acceptors.front().local_endpoint(error).port();
        for (const int offset : {event_port_offset, -1})
            if (!error) acceptors.push_back(listen_at(io, port + offset, error));
        return error;
    }

    // Calls use(model) with the model at the present time.
    template <class Use>
    auto with_model(const Use& use) {
        const std::lock_guard lock(mutex);
        const double now = steady_seconds();
        model.advance(std::min(now - followed, longest_advance));
        followed = now;
        return use(model);
    }

    void accept_until(const std::stop_token& stop) {
        while (!stop.stop_requested()) {
            std::vector<pollfd> wait;
            for (Tcp::acceptor& acceptor : acceptors) wait.push_back({acceptor.native_handle(), POLLIN, 0});
            if (poll(wait.data(), wait.size(), 20) <= 0) continue;
            for (std::size_t i = 0; i < wait.size(); ++i) {
                ErrorOfBoost error;
                if ((wait[i].revents & POLLIN) == 0) continue;
                auto socket = std::make_shared<Tcp::socket>(acceptors[i].accept(io, error));
                if (error) continue;
                const std::lock_guard lock(mutex);
                sockets.insert(socket->native_handle());
                connections.emplace_back(
                    [this, socket, i](const std::stop_token& end) { serve(std::move(*socket), i, end); });
            }
        }
    }

    void serve(Tcp::socket socket, std::size_t acceptor, const std::stop_token& stop) {
        const int handle = socket.native_handle();
        ErrorOfBoost error;
        socket.set_option(Tcp::no_delay(true), error);
        beast::flat_buffer buffer;
        Request request;
        http::read(socket, buffer, request, error);
        SocketStream stream(std::move(socket));
        if (!error && websocket::is_upgrade(request)) {
            stream.accept(request, error);
            if (!error && acceptor == 0) serve_states(stream);
            if (!error && acceptor == 1) serve_events(stream, stop);
        } else if (!error) {
            serve_http(stream.next_layer(), request, acceptor);
        }
        const std::lock_guard lock(mutex);
        sockets.erase(handle);
        stream.next_layer().close(error);
    }

    void serve_http(Tcp::socket& socket, const Request& request, std::size_t acceptor) {
        const bool old = std::strtod(options.version.c_str(), nullptr) < 3.5;
        const bool known =
            request.target() == "/version" && !options.version.empty() && acceptor == (old ? 2U : 0U);
        http::response<http::string_body> response(known ? http::status::ok : http::status::not_found, 11);
        if (known) response.body() = Json{{"project_version", options.version}}.dump();
        response.prepare_payload();
        response.keep_alive(false);
        ErrorOfBoost error;
        http::write(socket, response, error);
    }

    void serve_states(SocketStream& stream) {
        ErrorOfBoost error;
        const std::string inventory = with_model([](HaplyArmModel& m) { return m.inventory(); });
        stream.write(asio::buffer(inventory), error);
        while (!error) {
            beast::flat_buffer buffer;
            stream.read(buffer, error);
            if (error) return;
            const std::string message = beast::buffers_to_string(buffer.data());
            const auto answer = with_model([&](HaplyArmModel& m) { return m.answer(message); });
            if (!answer) return;
            if (options.answer_delay > 0.0)
                std::this_thread::sleep_for(std::chrono::duration<double>(options.answer_delay));
            if (!answer->empty()) stream.write(asio::buffer(*answer), error);
        }
    }

    void serve_events(SocketStream& stream, const std::stop_token& stop) {
        ErrorOfBoost error;
        std::size_t sent = with_model([](HaplyArmModel& m) { return m.events.size(); });
        while (!error && !stop.stop_requested()) {
            std::this_thread::sleep_for(event_interval);
            const std::string event = with_model(
                [&](HaplyArmModel& m) { return sent < m.events.size() ? m.events[sent] : std::string(); });
            if (event.empty()) continue;
            ++sent;
            stream.write(asio::buffer(event), error);
        }
    }
};

EmulatedHaply::EmulatedHaply(std::unique_ptr<Service> service) : service_(std::move(service)) {}
EmulatedHaply::~EmulatedHaply() = default;

Result<std::unique_ptr<EmulatedHaply>> EmulatedHaply::start(const EmulatedHaplyOptions& options) {
    auto service = std::make_unique<Service>(options);
    ErrorOfBoost error = service->listen(options.port);
    // The neighbours of the port that the system has chosen may be in use: try others.
    for (int i = 0; i < 50 && error && options.port == 0; ++i) error = service->listen(0);
    if (error)
        return fail(
            ErrorCode::failed, fmt::format("127.0.0.1:{} cannot be used: {}", options.port, error.message()),
            fmt::format("a port with the port before it and that {} after it free", event_port_offset));
    service->accepting =
        std::jthread([s = service.get()](const std::stop_token& stop) { s->accept_until(stop); });
    return std::unique_ptr<EmulatedHaply>(new EmulatedHaply(std::move(service)));
}

std::uint16_t EmulatedHaply::port() const { return service_->port; }
void EmulatedHaply::intend(const Vec3& position) {
    service_->with_model([&](HaplyArmModel& m) { m.intention = position; });
}
void EmulatedHaply::turn(const Quat& orientation) {
    service_->with_model([&](HaplyArmModel& m) { m.orientation = orientation; });
}
void EmulatedHaply::press(std::uint32_t buttons) {
    service_->with_model([&](HaplyArmModel& m) { m.buttons = buttons; });
}
void EmulatedHaply::set_fault(HaplyFault fault) {
    service_->with_model([&](HaplyArmModel& m) { m.set_fault(fault); });
}
Vec3 EmulatedHaply::position() const {
    return service_->with_model([](HaplyArmModel& m) { return m.position(); });
}
Vec3 EmulatedHaply::force() const {
    return service_->with_model([](HaplyArmModel& m) { return m.force(); });
}
std::uint64_t EmulatedHaply::commands() const {
    return service_->with_model([](HaplyArmModel& m) { return m.commands; });
}
std::uint64_t EmulatedHaply::rejected() const {
    return service_->with_model([](HaplyArmModel& m) { return m.rejected; });
}
bool EmulatedHaply::fault_shown() const {
    return service_->with_model([](HaplyArmModel& m) { return m.fault_shown(); });
}
double EmulatedHaply::force_after_fault() const {
    return service_->with_model([](HaplyArmModel& m) { return m.force_after_fault(); });
}

}  // namespace bolt::emulate

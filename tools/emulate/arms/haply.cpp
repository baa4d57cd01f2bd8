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
#include <nlohmann/json.hpp>
#include <set>
#include <thread>
#include <vector>

#include "engine/base/steady_seconds.hpp"

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

constexpr double encoder_step = 10e-6;    // m
constexpr double dt = 25e-6;              // s
constexpr double longest_advance = 0.1;   // s; a computer that was suspended does not throw the arm
constexpr double max_force = 10.0;        // N
constexpr Vec3 middle{0.0, -0.12, 0.15};  // m, of the reach, from the arm's base
constexpr const char* arm_id = "049D";
constexpr const char* grip_id = "61576";
constexpr int event_port_offset = 19;
constexpr auto event_interval = std::chrono::milliseconds(2);

Json to_json(const Vec3& v) { return {{"x", v.x}, {"y", v.y}, {"z", v.z}}; }

// The arm, the hand, and what the service says of them. Not safe for threads.
class HaplyArmModel {
  public:
    explicit HaplyArmModel(const EmulatedHaplyOptions& options) : options_(options) {}

    Vec3 intention{0.0};
    Quat orientation{1.0, 0.0, 0.0, 0.0};
    std::uint32_t buttons = 0;
    std::uint64_t commands = 0, rejected = 0;
    std::vector<std::string> events;

    [[nodiscard]] Vec3 position() const { return position_; }
    [[nodiscard]] Vec3 force() const { return time_ < force_until_ ? force_ : Vec3(0.0); }
    [[nodiscard]] bool fault_shown() const { return fault_time_.has_value(); }
    [[nodiscard]] double force_after_fault() const {
        return fault_time_ ? std::max(force_until_ - *fault_time_, 0.0) : 0.0;
    }

    void follow_clock() {
        const double now = steady_seconds();
        const double end = time_ + std::min(now - clock_, longest_advance);
        clock_ = now;
        for (; time_ + 0.5 * dt < end; time_ += dt) step();
    }

    void set_fault(HaplyFault fault) {
        fault_ = fault;
        fault_time_.reset();
        const bool gone = fault == HaplyFault::missing || fault == HaplyFault::disconnected ||
                          fault == HaplyFault::brake || fault == HaplyFault::stall;
        renders_ = !gone;
        if (gone) force_until_ = std::min(force_until_, time_);
        switch (fault) {
            case HaplyFault::disconnected:
                return add_event("device-disconnected", nullptr);
            case HaplyFault::brake:
                return add_event("device-safety-triggered", "ebrake_triggered");
            case HaplyFault::stall:
                return add_event("device-safety-triggered", "stall_detected");
            default:
                return;
        }
    }

    [[nodiscard]] std::string inventory() const { return devices(true).dump(); }

    // nullopt: the connection is to be closed. Empty: no answer.
    std::optional<std::string> answer(const std::string& message) {
        if (command(message)) {
            ++commands;
        } else {
            ++rejected;
        }
        if (fault_ == HaplyFault::none) return devices(false).dump();
        if (!fault_time_) fault_time_ = time_;
        switch (fault_) {
            case HaplyFault::close:
                return {};
            case HaplyFault::silence:
                return "";
            case HaplyFault::nonsense:
                return R"({"inverse3":[{"device_id":"049D","state":{"cursor_pos)";
            case HaplyFault::array:
                return "[1, 2, 3]";
            case HaplyFault::huge:
                return devices(false).dump() + std::string(200'000, ' ');
            case HaplyFault::overflow:
                return R"({"inverse3":[{"device_id":"049D","state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})";
            default:
                return devices(false).dump();
        }
    }

  private:
    void step() {
        const Vec3 spring = options_.stiffness * (intention - position_);
        // Implicit in the friction.
        velocity_ = (velocity_ + dt / options_.mass * (spring + force())) /
                    (1.0 + dt / options_.mass * options_.friction);
        position_ += dt * velocity_;
    }

    void add_event(const char* name, const char* safety_type) {
        Json data{{"device_family", "inverse"}, {"device_id", arm_id}};
        if (safety_type != nullptr) data["safety_type"] = safety_type;
        events.push_back(
            Json{{"name", name}, {"category", "device"}, {"level", "warning"}, {"data", data}}.dump());
        fault_time_ = time_;
    }

    [[nodiscard]] bool is_old() const {
        return !options_.version.empty() && std::strtod(options_.version.c_str(), nullptr) < 3.5;
    }

    // Takes the force of a message; false if it has none in the form of this version.
    bool command(const std::string& message) {
        const Json json = Json::parse(message, nullptr, false);
        const Json::json_pointer at(std::string("/inverse3/0/commands/set_cursor_force/") +
                                    (is_old() ? "values" : "vector"));
        const Json::json_pointer id("/inverse3/0/device_id");
        if (!json.is_object() || !json.contains(at) || !json.contains(id) || json[id] != arm_id) return false;
        Vec3 force{json[at].value("x", NAN), json[at].value("y", NAN), json[at].value("z", NAN)};
        if (!finite(force)) return false;
        if (const double length = glm::length(force); length > max_force) force *= max_force / length;
        if (!renders_) return true;
        force_ = force;
        force_until_ = force == Vec3(0.0) ? std::min(force_until_, time_) : time_ + options_.command_lifetime;
        return true;
    }

    [[nodiscard]] Json position_json() const {
        const Vec3 from_origin = options_.centred ? position_ : position_ + middle;
        Json json = to_json(encoder_step * glm::round(from_origin / encoder_step));
        if (fault_ == HaplyFault::millimetres) json = to_json(1000.0 * from_origin);
        if (fault_ == HaplyFault::null_position) json["y"] = nullptr;  // as a service writes NaN
        if (fault_ == HaplyFault::text_position) json["z"] = "0.1";
        return json;
    }

    [[nodiscard]] Json arm_json(bool with_config) const {
        Json arm{{"device_id", arm_id}};
        if (with_config) {
            arm["config"] = {{"preset", options_.centred ? "arm_front_centered" : "defaults"},
                             {"basis", {{"permutation", options_.basis}}},
                             {"handedness", "right"}};
            if (!options_.type.empty()) arm["config"]["type"] = options_.type;
        }
        arm["state"] = {{"cursor_velocity", to_json(velocity_)}, {"current_cursor_force", to_json(force())}};
        if (fault_ != HaplyFault::no_position) arm["state"]["cursor_position"] = position_json();
        arm["status"] = {{"calibrated", options_.calibrated && fault_ != HaplyFault::uncalibrated}};
        return arm;
    }

    [[nodiscard]] Json grip_json() const {
        const double length = fault_ == HaplyFault::turn ? 0.5 : 1.0;
        const Quat q = orientation * length;
        Json state{{"orientation", {{"w", q.w}, {"x", q.x}, {"y", q.y}, {"z", q.z}}}};
        const auto pressed = [&](unsigned bit) { return (buttons >> bit & 1U) != 0; };
        if (options_.grip == HaplyGrip::wired) {
            state["button"] = pressed(0);
        } else {
            state["buttons"] = {{"a", pressed(0)}, {"b", pressed(1)}, {"c", pressed(2)}};
        }
        return {{"device_id", grip_id}, {"state", state}, {"status", Json::object()}};
    }

    [[nodiscard]] Json devices(bool with_config) const {
        Json message{{"session_id", 1}, {"inverse3", Json::array()}};
        if (options_.arm && fault_ != HaplyFault::missing)
            message["inverse3"].push_back(arm_json(with_config));
        message["verse_grip"] = Json::array();
        message["wireless_verse_grip"] = Json::array();
        if (options_.grip == HaplyGrip::wired) message["verse_grip"].push_back(grip_json());
        if (options_.grip == HaplyGrip::wireless) message["wireless_verse_grip"].push_back(grip_json());
        return message;
    }

    EmulatedHaplyOptions options_;
    Vec3 position_{0.0}, velocity_{0.0}, force_{0.0};
    double time_ = 0.0, force_until_ = 0.0, clock_ = steady_seconds();
    HaplyFault fault_ = HaplyFault::none;
    std::optional<double> fault_time_;
    bool renders_ = true;
};

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
    mutable std::mutex mutex;              // of the next two
    HaplyArmModel model;
    std::set<int> sockets;  // of open connections
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
        model.follow_clock();
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
        websocket::stream<Tcp::socket> stream(std::move(socket));
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

    void serve_states(websocket::stream<Tcp::socket>& stream) {
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

    void serve_events(websocket::stream<Tcp::socket>& stream, const std::stop_token& stop) {
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
    // The ports beside any port may be in use.
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

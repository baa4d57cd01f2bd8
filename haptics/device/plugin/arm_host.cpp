#include "haptics/device/plugin/arm_host.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <thread>

#include "engine/base/file.hpp"
#include "haptics/device/vendor_library.hpp"

namespace bolt::device {

namespace {

constexpr int release_after = 50;              // ms without a request until the force is released
constexpr int time_to_close = 2;               // s, after the program has ended
constexpr std::size_t max_config_size = 4095;  // bytes

template <std::size_t size>
void copy_text(char (&to)[size], const char* from) {
    const std::size_t length = from != nullptr ? ::strnlen(from, size - 1) : 0;
    std::copy_n(from, length, to);
    to[length] = '\0';
}

// Accepts a larger table, because later versions of the header append members.
Result<bw_arm_v1> read_table(const bw_arm_v1* table) {
    if (table == nullptr)
        return fail(ErrorCode::failed, fmt::format("bw_arm_entry({}) returns no functions", BW_ARM_ABI),
                    "a plug-in made with this version of boltwright_arm.h");
    bw_arm_v1 functions{};
    if (table->size < sizeof functions)
        return fail(ErrorCode::failed, fmt::format("its bw_arm_v1 has a size of {} bytes", table->size),
                    fmt::format("{} or more", sizeof functions));
    functions = *table;
    const auto& f = functions;
    if (!f.count || !f.open || !f.info || !f.calibrate || !f.enable || !f.exchange || !f.last_error ||
        !f.close)
        return fail(ErrorCode::failed, "its bw_arm_v1 lacks a function", "all eight of boltwright_arm.h");
    return functions;
}

Result<bw_arm_v1> load_plugin(const std::filesystem::path& plugin) {
    Result<VendorLibrary> library = VendorLibrary::open({&plugin, 1});
    const bw_arm_v1* (*entry)(std::uint32_t) = nullptr;
    if (library) library->find("bw_arm_entry", entry);
    Status loaded = library ? library->check() : Status(fail(library.error()));
    if (!loaded) {
        Error error = loaded.error();
        error.expected = "a plug-in for this kind of computer, as boltwright_arm.h describes it";
        return fail(std::move(error));
    }
    return read_table(entry(BW_ARM_ABI));
}

// The text of NAME.conf beside the plug-in; empty if there is no such file.
Result<std::string> read_config(std::filesystem::path plugin) {
    const std::filesystem::path file = plugin.replace_extension(".conf");
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return std::string();
    const std::string name = file.filename().string();
    const Result<std::string> text = read_file(file, std::size_t{1} << 20U, ErrorCode::failed);
    if (!text) return fail(ErrorCode::failed, name + ' ' + text.error().what, "a text file that can be read");
    if (text->size() <= max_config_size && text->find('\0') == std::string::npos) return *text;
    return fail(ErrorCode::failed, fmt::format("{} has {} bytes", name, text->size()),
                fmt::format("a text of {} at most, without NUL", max_config_size));
}

class PluginServer {
  public:
    PluginServer(Result<bw_arm_v1> functions, Result<std::string> config, int socket)
        : functions_(std::move(functions)), config_(std::move(config)), socket_(socket) {}

    void serve() {
        for (PluginRequest request; receive(request);) {
            const PluginReply reply = answer(request);
            if (::send(socket_, &reply, sizeof reply, MSG_NOSIGNAL) < 0) break;
        }
        if (arm_ == nullptr) return;
        release();
        if (enabled_) functions_->enable(arm_, 0);
        functions_->close(arm_);
    }

  private:
    // Returns false if the program has closed its end.
    bool receive(PluginRequest& request) {
        for (;;) {
            pollfd events{socket_, POLLIN, 0};
            const int ready = ::poll(&events, 1, enabled_ ? release_after : -1);
            if (ready == 0) release();
            if (ready <= 0) continue;
            const ssize_t length = ::recv(socket_, &request, sizeof request, 0);
            if (length == 0 || (length < 0 && errno != EINTR)) return false;
            if (length == sizeof request) return true;
        }
    }

    void release() {
        if (!enabled_) return;
        bw_arm_state_v1 state = blank_state();
        const bw_arm_command_v1 nothing{sizeof nothing, 0, {}, {}};
        functions_->exchange(arm_, &nothing, &state);
    }

    static bw_arm_state_v1 blank_state() {
        return {sizeof(bw_arm_state_v1), 0, {}, {1.0, 0.0, 0.0, 0.0}, 1.0};
    }

    PluginReply answer(const PluginRequest& request) {
        PluginReply reply;
        reply.call = request.call;
        const Error* unusable = !functions_ ? &functions_.error() : !config_ ? &config_.error() : nullptr;
        if (unusable != nullptr) {
            reply.result = BW_ARM_ERROR;
            copy_text(reply.text, unusable->what.c_str());
            copy_text(reply.expected, unusable->expected.c_str());
            return reply;
        }
        reply.result = call(request, reply);
        if (reply.result < 0 || reply.result == BW_ARM_NEEDS_USER)
            copy_text(reply.text, functions_->last_error(arm_));
        return reply;
    }

    int call(const PluginRequest& request, PluginReply& reply) {
        const bw_arm_v1& f = *functions_;
        switch (request.call) {
            case PluginCall::count:
                return f.count();
            case PluginCall::open:
                arm_ = f.open(request.argument, config_->c_str());
                return arm_ != nullptr ? BW_ARM_DONE : BW_ARM_ERROR;
            case PluginCall::info:
                reply.info.size = sizeof reply.info;
                return f.info(arm_, &reply.info);
            case PluginCall::calibrate:
                return f.calibrate(arm_, request.argument);
            case PluginCall::enable: {
                const int result = f.enable(arm_, request.argument);
                enabled_ = result == BW_ARM_DONE && request.argument != 0;
                return result;
            }
            case PluginCall::exchange:
                reply.state = blank_state();
                return f.exchange(arm_, &request.command, &reply.state);
        }
        return BW_ARM_ERROR;
    }

    Result<bw_arm_v1> functions_;
    Result<std::string> config_;
    int socket_;
    bw_arm* arm_ = nullptr;
    bool enabled_ = false;
};

// Ends the process if a function of the plug-in does not return after the program has ended.
void end_after_program(int socket) {
    std::thread([socket] {
        pollfd events{socket, POLLRDHUP, 0};
        while (::poll(&events, 1, -1) <= 0) {
        }
        std::this_thread::sleep_for(std::chrono::seconds(time_to_close));
        ::_exit(1);
    }).detach();
}

}  // namespace

void run_arm_host(const std::filesystem::path& plugin, int socket) {
    end_after_program(socket);
    PluginServer(load_plugin(plugin), read_config(plugin), socket).serve();
    // Skips the plug-in's destructors and ends its threads, so that neither can fail here.
    ::_exit(0);
}

}  // namespace bolt::device

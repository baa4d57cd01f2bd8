#include "haptics/device/plugin/arm_process.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstring>

#include "engine/base/steady_seconds.hpp"

namespace bolt::device {

namespace {

// s until a function counts as hanging; boltwright_arm.h promises these.
constexpr double time_to_count = 2.0, time_to_call = 10.0, time_to_exchange = 0.5, time_to_end = 1.0;

constexpr std::array function_names{"count", "open", "info", "calibrate", "enable", "exchange"};

const char* function_name(PluginCall function) { return function_names[static_cast<std::size_t>(function)]; }

Result<std::filesystem::path> find_arm_host() {
    namespace fs = std::filesystem;
    std::error_code ignored;
    const fs::path folder = fs::read_symlink("/proc/self/exe", ignored).parent_path();
    for (const fs::path& host : {folder / "bolt-arm-host", folder / "../lib/boltwright/bolt-arm-host"})
        if (fs::exists(host, ignored)) return host;
    return fail(ErrorCode::no_device, "bolt-arm-host, which runs plug-ins for arms, is missing",
                fmt::format("it in {}", folder.string()));
}

// Length of the UTF-8 character at the start of `text`; 0 if it is invalid, as overlong forms and surrogates
// are.
std::size_t character_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned first = byte(0);
    const std::size_t length = first < 0x80                    ? 1
                               : first >= 0xc2 && first < 0xe0 ? 2
                               : first >= 0xe0 && first < 0xf0 ? 3
                               : first >= 0xf0 && first < 0xf5 ? 4
                                                               : 0;
    if (length == 0 || length > text.size()) return 0;
    for (std::size_t i = 1; i < length; ++i)
        if ((byte(i) & 0xc0U) != 0x80U) return 0;
    if ((first == 0xe0 && byte(1) < 0xa0) || (first == 0xed && byte(1) >= 0xa0)) return 0;
    if ((first == 0xf0 && byte(1) < 0x90) || (first == 0xf4 && byte(1) >= 0x90)) return 0;
    return length;
}

}  // namespace

std::string plugin_name(const std::filesystem::path& plugin) { return clean_text(plugin.stem().string()); }

std::string clean_text(std::string_view text) {
    std::string clean;
    while (!text.empty()) {
        const std::size_t length = character_length(text);
        const bool control = length == 1 && (static_cast<unsigned char>(text[0]) < 0x20 || text[0] == 0x7f);
        if (length == 0 || control)
            clean += '?';
        else
            clean += text.substr(0, length);
        text.remove_prefix(std::max<std::size_t>(length, 1));
    }
    return clean;
}

Result<ArmProcess> ArmProcess::start(const std::filesystem::path& plugin) {
    BOLT_TRY_ASSIGN(const std::filesystem::path host, find_arm_host());
    // Absolute, because dlopen() searches its own folders for a name without a slash.
    const std::string path = std::filesystem::absolute(plugin).string();
    BOLT_TRY_ASSIGN(ChildSocket child, ChildSocket::start({host.string(), path}));
    return ArmProcess(std::move(child), plugin_name(plugin));
}

ArmProcess::~ArmProcess() {
    if (child_) child_->end(hangs_ ? 0.0 : time_to_end);
}

Result<PluginReply> ArmProcess::call(PluginCall function, int argument) {
    BOLT_TRY(request(function, argument, {}));
    const double time = function == PluginCall::count ? time_to_count : time_to_call;
    BOLT_TRY_ASSIGN(const std::optional<PluginReply> replied, reply(time));
    if (!replied) return fail(late(time));
    return *replied;
}

Status ArmProcess::begin_exchange(const bw_arm_command_v1& command) {
    return request(PluginCall::exchange, 0, command);
}

Result<std::optional<PluginReply>> ArmProcess::finish_exchange(double timeout) {
    BOLT_TRY_ASSIGN(std::optional<PluginReply> replied, reply(timeout));
    if (!replied && steady_seconds() - began_ > time_to_exchange) return fail(late(time_to_exchange));
    return replied;
}

Status ArmProcess::request(PluginCall function, int argument, const bw_arm_command_v1& command) {
    const PluginRequest request{function, argument, command};
    function_ = function;
    if (!child_ || !child_->send(std::as_bytes(std::span(&request, 1)))) return fail(ended());
    waiting_ = true;
    began_ = steady_seconds();
    return {};
}

Result<std::optional<PluginReply>> ArmProcess::reply(double timeout) {
    PluginReply replied;
    const auto received = child_->receive(std::as_writable_bytes(std::span(&replied, 1)), timeout);
    if (!received) return fail(ended());
    if (!*received) return std::optional<PluginReply>{};
    waiting_ = false;
    if (**received != sizeof replied || replied.call != function_)
        return fail(error("its process has sent an invalid reply (the plug-in may have overwritten memory)",
                          fmt::format("{} bytes for the function that was called", sizeof replied)));
    if (replied.result >= 0) return std::optional(replied);
    // The plug-in can have overwritten any byte of its process.
    const std::string text = clean_text({replied.text, ::strnlen(replied.text, sizeof replied.text)});
    const std::string expected =
        clean_text({replied.expected, ::strnlen(replied.expected, sizeof replied.expected)});
    if (!expected.empty()) return fail(error(text, expected));
    return fail(
        error(fmt::format("{}: {}", function_name(function_), text.empty() ? "no reason given" : text),
              "an arm that is switched on and connected"));
}

Error ArmProcess::error(std::string what, std::string expected) const {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = fmt::format("the plug-in {}: {}", name_, what);
    error.expected = std::move(expected);
    return error;
}

Error ArmProcess::ended() {
    const ProgramEnd end = child_->end(0.2);
    waiting_ = false;
    const char* const function = function_name(function_);
    Error ended =
        error(fmt::format("it has ended its process in {} with exit code {}", function, end.exit_code),
              "a version of the plug-in without this fault");
    if (end.signal != 0)
        ended.what = fmt::format("the plug-in {} crashed in {} (signal {}, {})", name_, function, end.signal,
                                 ::strsignal(end.signal));
    if (end.killed)
        ended.what = fmt::format("the plug-in {} has closed its connection in {}", name_, function);
    return ended;
}

Error ArmProcess::late(double time) {
    hangs_ = true;
    return error(fmt::format("{} has not returned for {:g} s", function_name(function_), time),
                 "an arm that is switched on, and a plug-in that does not wait for it");
}

}  // namespace bolt::device

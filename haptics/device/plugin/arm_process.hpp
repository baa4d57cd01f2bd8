// The program's side of a plug-in that runs in a process of its own. Each call is a request and a reply. A
// late reply, a crash and an exit are errors that name the plug-in and the function.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "engine/base/process.hpp"
#include "engine/base/result.hpp"
#include "haptics/device/plugin/arm_host.hpp"

namespace bolt::device {

class ArmProcess {
  public:
    // Starts bolt-arm-host, which lies beside this program or in ../lib/boltwright.
    static Result<ArmProcess> start(const std::filesystem::path& plugin);

    // Calls a function and waits for its reply. Fails if it reports an error.
    Result<PluginReply> call(PluginCall function, int argument = 0);

    // The two halves of exchange(): begin_exchange() never waits, finish_exchange() waits at most `timeout`
    // s; nullopt on timeout. Begin the next exchange only after this one has a reply.
    Status begin_exchange(const bw_arm_command_v1& command);
    Result<std::optional<PluginReply>> finish_exchange(double timeout);
    [[nodiscard]] bool exchanging() const { return waiting_; }

    // An error of this plug-in: "the plug-in NAME: WHAT".
    [[nodiscard]] Error error(std::string what, std::string expected) const;

    ArmProcess(ArmProcess&&) noexcept = default;
    ArmProcess& operator=(ArmProcess&&) noexcept = default;
    ~ArmProcess();  // closes the arm; kills the process if this takes longer than 1 s

  private:
    ArmProcess(ChildSocket child, std::string name) : child_(std::move(child)), name_(std::move(name)) {}
    Status request(PluginCall function, int argument, const bw_arm_command_v1& command);
    // nullopt if there is no reply within `timeout` s
    Result<std::optional<PluginReply>> reply(double timeout);
    [[nodiscard]] Error ended();
    [[nodiscard]] Error late(double time);

    std::optional<ChildSocket> child_;
    std::string name_;
    PluginCall function_ = PluginCall::count;  // the latest called function
    bool waiting_ = false;                     // its reply is outstanding
    bool hangs_ = false;                       // its reply was late
    double began_ = 0.0;                       // s, time of its call
};

// The file's name without .so; it is part of the arms' ids.
std::string plugin_name(const std::filesystem::path& plugin);

// Text of a plug-in on one line: invalid UTF-8 and control characters are replaced by "?".
std::string clean_text(std::string_view text);

}  // namespace bolt::device

// Questions on the terminal before an arm moves or pushes.
#include <fmt/format.h>
#include <unistd.h>

#include <iostream>
#include <string>

#include "game/cli/commands.hpp"

namespace bolt::cli {

namespace {

std::string request_text(const device::Preparation& needed) {
    switch (needed.need) {
        case device::DeviceNeed::inkwell:
            return "Put the arm's handle into its inkwell, and wait until it is calibrated.";
        case device::DeviceNeed::user:
            return "The arm waits for you: " + needed.instruction;
        case device::DeviceNeed::wait:
            return "The arm is calibrating.";
        case device::DeviceNeed::none:
        case device::DeviceNeed::permission:
            break;
    }
    return {};
}

}  // namespace

bool has_terminal() { return isatty(STDIN_FILENO) == 1 && isatty(STDERR_FILENO) == 1; }

bool ask(std::string_view question, bool yes) {
    if (yes) {
        fmt::print(stderr, "{} yes (--yes)\n", question);
        return true;
    }
    if (!has_terminal()) return false;
    fmt::print(stderr, "{} [y/N] ", question);
    std::string answer;
    if (!std::getline(std::cin, answer)) return false;
    return answer == "y" || answer == "Y" || answer == "yes";
}

device::ArmDialog terminal_dialog(bool yes) {
    device::ArmDialog questions;
    questions.permission = std::make_shared<device::MovePermission>();
    questions.on_preparation = [yes, permission = questions.permission,
                                shown = device::Preparation()](const device::Preparation& needed) mutable {
        if (needed.need == device::DeviceNeed::none || permission->active()) return true;
        if (needed.need == device::DeviceNeed::permission) {
            if (!ask(
                    "The arm moves by itself to find its position. Keep hands and things clear. May it move?",
                    yes))
                return false;
            permission->grant();
            return true;
        }
        if (needed.need == device::DeviceNeed::wait) return true;
        if (!has_terminal()) return false;
        if (needed != shown) fmt::print(stderr, "{}\n", request_text(needed));
        shown = needed;
        return true;
    };
    return questions;
}

}  // namespace bolt::cli

// Questions on the terminal before an arm moves or pushes, and what to do about an arm that must be prepared.
#pragma once

#include <string_view>

#include "haptics/device/preparation.hpp"

namespace bolt::cli {

// True if a person sees the standard error output and can answer.
bool has_terminal();

// Asks `question`, which ends with a question mark, and waits for the answer. `yes`: the option --yes, which
// answers it. False without a terminal and without --yes.
bool ask(std::string_view question, bool yes);

// For a station or a device thread. Without a terminal an arm that needs more than permission is an error at
// once, because nobody is there to put its handle into the inkwell.
device::ArmDialog terminal_dialog(bool yes);

}  // namespace bolt::cli

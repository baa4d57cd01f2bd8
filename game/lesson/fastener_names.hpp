// Names of the turned part of a joint ("screw" if its head is turned, else "nut") and of the direction of its
// thread.
#pragma once

#include <string_view>

#include "content/format/assembly.hpp"
#include "content/words/words.hpp"

namespace bolt::lesson {

// English, for records and reports: "nut" or "screw".
std::string_view fastener_name(const joint::JointDesign& design);
// "joint" if the assembly has both.
std::string_view fastener_name(const content::Assembly& assembly);

// The choices {fastener: ...} of one joint and {fasteners: ...} of all joints (content/words/key_rows.hpp).
words::TextArgument fastener_argument(const joint::JointDesign& design);
words::TextArgument fasteners_argument(const content::Assembly& assembly);
// The choices {thread: ...} of one joint and {threads: ...} of all joints.
words::TextArgument thread_argument(const joint::JointDesign& design);
words::TextArgument threads_argument(const content::Assembly& assembly);

}  // namespace bolt::lesson

// The thread size that an author wrote.
#pragma once

#include <string_view>

#include "engine/base/result.hpp"
#include "haptics/joint/fastener.hpp"

namespace bolt::content {

// Only the exact name is taken ("M12", "M12x1.75"), but the error knows other ways of writing it ("M12 ×
// 1,75"). It never proposes another diameter than the one that was written: that would be another bolt.
Result<joint::ThreadSize> read_thread(std::string_view text);

}  // namespace bolt::content

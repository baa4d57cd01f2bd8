// The style sheet of every page and drawing: light, dark and paper, one accent, figures in columns.
#pragma once

#include <string_view>

namespace bolt::plot {

std::string_view style_sheet();

}  // namespace bolt::plot

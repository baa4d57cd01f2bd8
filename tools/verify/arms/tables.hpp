// The tables of the validation in Markdown. docs/performance.md has them between two marks.
#pragma once

#include <string>
#include <string_view>

#include "tools/verify/arms/validation.hpp"

namespace bolt::arm_validation {

inline constexpr std::string_view tables_begin = "<!-- bolt-arm-validation begins -->";
inline constexpr std::string_view tables_end = "<!-- bolt-arm-validation ends -->";

// The rows of one arm: its facts, contact, the nut, and its feel at the announced limits.
std::vector<std::string> rows_of(const ArmResult& result);
std::vector<std::string> rows_of(const ApproachResult& result);
std::string to_markdown(const ValidationResult& result);

// The text with everything between the marks replaced. Fails if a mark is missing.
Result<std::string> replace_tables(std::string_view text, std::string_view tables);

}  // namespace bolt::arm_validation

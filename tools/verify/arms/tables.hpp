// The tables of the validation in Markdown. docs/performance.md has them between two marks.
#pragma once

#include <string>
#include <string_view>

#include "tools/verify/arms/validation.hpp"

namespace bolt::arm_validation {

inline constexpr std::string_view tables_begin = "<!-- bolt-arm-validation begins -->";
inline constexpr std::string_view tables_end = "<!-- bolt-arm-validation ends -->";

// The rows of one arm, one for each of the first four tables: its facts, contact, the nut, and its feel at
// the announced limits. Deterministic; tests/feel compares them with the page.
std::vector<std::string> rows_of(const ArmResult& result);
// The two rows of one arm in the table of approaches: without and with the guiding force.
std::vector<std::string> rows_of(const ApproachResult& result);

std::string to_markdown(const ValidationResult& result);

// Returns the text with everything between the marks replaced by the tables. Fails if a mark is missing.
Result<std::string> replace_tables(std::string_view text, std::string_view tables);

}  // namespace bolt::arm_validation

// Names of nodes: cleaning, uniqueness and pattern matching.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace bolt::step_import {

// Removes control characters and outer blanks; replaces invalid UTF-8 by U+FFFD.
std::string clean_name(std::string_view text);

// Returns false for a name that an exporter generated ("NAUO12", "=>[0:1:1:2]", "SOLID", "7").
bool is_meaningful_name(std::string_view name);

class UniqueNames {
  public:
    // Reserves and returns the name, or name_2, name_3 … if it is in use. An empty name becomes "part".
    std::string claim(std::string_view name);
    [[nodiscard]] bool taken(const std::string& name) const { return used_.contains(name); }
    [[nodiscard]] int renamed() const { return renamed_; }

  private:
    std::set<std::string> used_;
    int renamed_ = 0;
};

// Matches a pattern such as "*casing*": a star matches any characters; ASCII case is ignored.
bool matches(std::string_view pattern, std::string_view name);

}  // namespace bolt::step_import

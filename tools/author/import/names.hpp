// Names of nodes: what the author wrote, and unique.
#pragma once

#include <set>
#include <string>
#include <string_view>

namespace bolt::step_import {

// Without control characters and outer blanks; what is not UTF-8 becomes U+FFFD.
std::string clean_name(std::string_view text);

// A person's name for something, not one that an exporter made up ("NAUO12", "=>[0:1:1:2]", "SOLID", "7").
bool telling(std::string_view name);

class UniqueNames {
  public:
    // The name, or name_2, name_3 … where it is taken. Empty names become "part".
    std::string take(std::string_view name);
    [[nodiscard]] bool taken(const std::string& name) const { return used_.contains(name); }
    [[nodiscard]] int renamed() const { return renamed_; }

  private:
    std::set<std::string> used_;
    int renamed_ = 0;
};

// "*casing*": a star stands for any characters; ASCII case does not matter.
bool matches(std::string_view pattern, std::string_view name);

}  // namespace bolt::step_import

// The people that a report shows.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace bolt::people {

// The codes or typed names of the people on a page of `boltwright report` or `train`; an empty text stands
// for a person without a name. Pages of older programs do not list them: there the facts of their sessions
// count. None: this is no such page, or an overview of an older program, which does not list them.
std::optional<std::vector<std::string>> page_trainees(std::string_view html);

}  // namespace bolt::people

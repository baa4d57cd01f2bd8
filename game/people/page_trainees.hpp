// The people that a report shows, listed in the head of the page. Export and erasure of a person's files find
// the page by them:
//
//   <meta name="boltwright-person" content="T-7K3M9Q"/>
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace bolt::people {

// The elements of the head for the codes or typed names of these people; an empty text stands for a person
// without a name.
std::string people_list(const std::set<std::string>& people);

// The inverse, for a page of `boltwright report` or `train`. Pages of older programs have no list: for them,
// returns the trainees shown in their sections, without simulated ones. An empty text also stands for a
// trainee of unknown kind. Returns none for another page, and for one that names nobody, such as an old
// overview.
std::optional<std::vector<std::string>> page_trainees(std::string_view html);

}  // namespace bolt::people

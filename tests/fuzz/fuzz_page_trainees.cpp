// The people of a page: any bytes give a list that is not longer than the page, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "game/people/page_trainees.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const auto people =
        bolt::people::page_trainees(std::string_view(reinterpret_cast<const char*>(data), size));
    std::size_t length = 0;
    if (people)
        for (const std::string& person : *people) length += person.size() + 1;
    if (length > size) std::abort();
    // A list that is written is read again, whatever the names are, if they are printable.
    const std::set<std::string> listed{std::string(1, static_cast<char>(size % 0x5F + 0x20)), "T-7K3M9Q"};
    const auto again =
        bolt::people::page_trainees("training report</title>" + bolt::people::people_list(listed));
    if (!again || std::set<std::string>(again->begin(), again->end()) != listed) std::abort();
    return 0;
}

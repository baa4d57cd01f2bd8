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
    return 0;
}

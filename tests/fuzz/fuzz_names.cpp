// The file of names: any bytes give people with different codes and names that survive a write and read, or
// an error with a position, never a crash.

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string_view>

#include "content/trainee/people.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bolt::content;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    if (const auto code = typed_person_code(text); code && !is_person_code(*code)) std::abort();
    const auto read = parse_names(text, "names.json");
    if (!read) {
        if (read.error().line < 1 || read.error().what.empty()) std::abort();
        return 0;
    }
    std::set<std::string> codes, names;
    for (const Person& person : *read) {
        if (!is_person_code(person.code) || !codes.insert(person.code).second) std::abort();
        if (person.name.empty() || trim_blanks(person.name) != person.name) std::abort();
        if (typed_person_code(person.name) || !names.insert(person.name).second) std::abort();
    }
    const auto again = parse_names(names_text(*read), "names.json");
    if (!again || *again != *read) std::abort();
    return 0;
}

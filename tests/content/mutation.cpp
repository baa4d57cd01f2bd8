// Randomly edited files: the loader always ends, and either accepts the file or reports errors with valid
// positions.
#include <doctest/doctest.h>

#include "engine/base/random.hpp"
#include "support.hpp"

namespace content_mutation_test {

using namespace content_test;

namespace {

std::size_t below(bolt::Random& random, std::size_t n) { return random.bits() % n; }

std::string mutated(std::string text, std::uint64_t seed) {
    bolt::Random random(seed);
    const auto pieces = std::string_view("{}[],:\"\\0123456789.-+eE \n\ttrufalsn/~_\xC3\xFF");
    const std::size_t edits = 1 + below(random, 4);
    for (std::size_t i = 0; i < edits; ++i) {
        const std::size_t at = below(random, text.size());
        switch (below(random, 5)) {
            case 0:
                text[at] = pieces[below(random, pieces.size())];
                break;
            case 1:
                text.insert(at, 1, pieces[below(random, pieces.size())]);
                break;
            case 2:
                text.erase(at, 1 + below(random, 3));
                break;
            case 3: {  // delete or move a line
                const std::size_t begin = text.rfind('\n', at), end = text.find('\n', at);
                if (begin == std::string::npos || end == std::string::npos) break;
                const std::string line = text.substr(begin, end - begin);
                text.erase(begin, end - begin);
                if (random.chance(0.5)) text.insert(below(random, text.size()), line);
                break;
            }
            default: {  // duplicate a piece
                const std::string piece = text.substr(at, below(random, 200));
                text.insert(below(random, text.size()), piece);
            }
        }
    }
    return text;
}

}  // namespace

TEST_CASE("Errors: a damaged file loads or gives errors that point into it") {
    const std::string good = shipped("zq350");
    int refused = 0;
    for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
        CAPTURE(seed);
        const std::string text = mutated(good, seed);
        const auto loaded = bolt::content::parse_assembly(text, "f");
        if (loaded.ok()) {
            REQUIRE(!loaded.assembly.joints.empty());
            for (const auto& pass : loaded.assembly.passes)
                REQUIRE(pass.order.size() == loaded.assembly.joints.size());
            continue;
        }
        ++refused;
        int line = 1;
        for (const bolt::Error& error : loaded.errors) {
            REQUIRE(error.line >= line);  // in the order of the file
            line = error.line;
            REQUIRE(error.line <= count_lines(text));
            REQUIRE(error.column >= 1);
            REQUIRE(!error.what.empty());
            const std::string message = error.message();
            for (const char c : message) REQUIRE(static_cast<unsigned char>(c) >= 0x20);
        }
    }
    CHECK(refused > 800);
}

TEST_CASE("Errors: loading the same bytes gives the same messages") {
    const std::string text = mutated(shipped("zq350"), 7);
    CHECK(messages(text) == messages(text));
}

TEST_CASE("Errors: a file cut at any byte gives one error near its end") {
    const std::string good = cover();
    const std::size_t end = good.find_last_not_of("\n");
    for (std::size_t size = 0; size < end; size += 7) {
        CAPTURE(size);
        const std::string text = good.substr(0, size);
        const auto loaded = bolt::content::parse_assembly(text, "f");
        REQUIRE(loaded.errors.size() == 1);
        REQUIRE(loaded.errors[0].line >= 1);
        REQUIRE(loaded.errors[0].line <= count_lines(text));
    }
}

}  // namespace content_mutation_test

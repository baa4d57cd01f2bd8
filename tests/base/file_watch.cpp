#include "engine/base/file.hpp"

#include <doctest/doctest.h>

#include "tests/support/folder.hpp"

using namespace bolt;
namespace fs = std::filesystem;
using test::Folder;

namespace {

void write(const fs::path& file, std::string_view text) { REQUIRE(write_file(file, text).has_value()); }

}  // namespace

TEST_CASE("FileWatch: a change is reported once, after the file has stayed unchanged for a while") {
    const Folder folder;
    const fs::path a = folder / "a.json", b = folder / "b.glb";
    write(a, "one");
    write(b, "one");
    FileWatch watch(0.2);
    watch.watch({b, a, b});
    CHECK(watch.changed(0.0).empty());
    write(a, "three");
    CHECK(watch.changed(1.0).empty());  // detected now
    CHECK(watch.changed(1.1).empty());  // the file has not settled
    CHECK(watch.changed(1.25) == std::vector{a});
    CHECK(watch.changed(1.3).empty());
    // Continuous writing delays the report.
    for (int i = 0; i < 10; ++i) {
        write(a, std::string(static_cast<std::size_t>(10 + i), 'x'));
        CHECK(watch.changed(2.0 + 0.1 * i).empty());
    }
    CHECK(watch.changed(3.1) == std::vector{a});
    write(a, "1");
    write(b, "2");
    (void)watch.changed(4.0);
    CHECK(watch.changed(5.0) == std::vector{a, b});
}

TEST_CASE("FileWatch: replacing, removing and creating a file are changes, even with the same size") {
    const Folder folder;
    const fs::path a = folder / "a.json", late = folder / "late.json";
    write(a, "same");
    FileWatch watch(0.0);
    watch.watch({a, late});
    CHECK(watch.changed(0.0).empty());
    const auto old = fs::last_write_time(a);
    write(folder / "new", "SAME");
    fs::rename(folder / "new", a);
    fs::last_write_time(a, old);  // as some tools preserve it
    CHECK(watch.changed(1.0) == std::vector{a});
    fs::remove(a);
    CHECK(watch.changed(2.0) == std::vector{a});
    CHECK(watch.changed(3.0).empty());
    write(a, "same");
    write(late, "first");
    CHECK(watch.changed(4.0) == std::vector{a, late});
    // The file returned to its reported state before it had settled: no change.
    FileWatch slow(1.0);
    slow.watch({a});
    fs::rename(a, folder / "aside");
    CHECK(slow.changed(5.0).empty());
    fs::rename(folder / "aside", a);
    CHECK(slow.changed(7.0).empty());
}

TEST_CASE("FileWatch: a new list keeps the state of files that were watched before") {
    const Folder folder;
    const fs::path a = folder / "a", b = folder / "b";
    write(a, "1");
    FileWatch watch(0.0);
    watch.watch({a});
    write(a, "22");
    write(b, "1");
    watch.watch({a, b});
    CHECK(watch.changed(0.0) == std::vector{a});
    watch.watch({b});
    write(a, "333");
    CHECK(watch.changed(1.0).empty());
}

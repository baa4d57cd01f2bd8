#include <doctest/doctest.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <future>

#include "engine/base/file.hpp"
#include "engine/base/hash.hpp"
#include "engine/base/math.hpp"
#include "engine/base/nearest.hpp"
#include "engine/base/random.hpp"
#include "engine/base/result.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;

TEST_CASE("Error: the message has file, line, column, pointer, what and expected, without unknown parts") {
    Error error;
    error.what = "is wrong";
    CHECK(error.message() == "is wrong");
    error.expected = "a number";
    CHECK(error.message() == "is wrong; expected a number");
    error.file = "a.json";
    CHECK(error.message() == "a.json: is wrong; expected a number");
    error.line = 3;
    error.column = 7;
    error.pointer = "/joints/0/id";
    CHECK(error.message() == "a.json:3:7: /joints/0/id: is wrong; expected a number");
    error.expected = "expected a number";  // complete texts are not prefixed
    CHECK(error.message() == "a.json:3:7: /joints/0/id: is wrong; expected a number");
    error.expected = "did you mean \"name\"?";
    CHECK(error.message() == "a.json:3:7: /joints/0/id: is wrong; did you mean \"name\"?");
}

TEST_CASE("Edit distance: known values") {
    CHECK(edit_distance("", "abc") == 3);
    CHECK(edit_distance("kitten", "sitting") == 3);
    CHECK(edit_distance("M16", "m16") == 0);
    CHECK(edit_distance("pitch", "ptich") == 1);  // a transposition counts once
}

TEST_CASE("Nearest name: finds a typing error, and nothing if no name is near") {
    const std::vector<std::string> names = {"friction_thread", "friction_bearing", "size"};
    CHECK(nearest("frction_thread", names) == "friction_thread");
    CHECK(nearest("sise", names) == "size");
    CHECK(nearest("gasket", names).empty());
    const std::vector<std::string> sizes = {"M4", "M5", "M8"};
    CHECK(nearest("M9", sizes).empty());  // a tie
    CHECK(nearest(std::string(10'000, 'x'), names).empty());
    // A duplicate is not a tie, and does not hide one.
    const std::vector<std::string> repeated = {"size", "size", "pitch"}, tie_repeated = {"M4", "M5", "M5"};
    CHECK(nearest("sise", repeated) == "size");
    CHECK(nearest("M9", tie_repeated).empty());
}

TEST_CASE("Random: the first outputs are those published for PCG32") {
    // pcg32-demo of the reference implementation, seed 42, stream 54, round 1.
    Random random(42, 54);
    const std::uint32_t published[] = {0xa15c02b7, 0x7b47f409, 0xba1d3330,
                                       0x83d2f293, 0xbfa4784b, 0xcbed606e};
    for (const std::uint32_t value : published) CHECK(random.bits() == value);
}

TEST_CASE("Random: vectors and rotations draw their values in the same order with every compiler") {
    Random random(7), drawn(7);
    const double z = drawn.normal(), y = drawn.normal(), x = drawn.normal();
    CHECK(normal_vector(random) == Vec3(x, y, z));
    const double c = drawn.normal(), b = drawn.normal(), a = drawn.normal(), w = drawn.normal();
    CHECK(random_turn(random) == glm::normalize(Quat(w, a, b, c)));
}

TEST_CASE("Random: uniform and normal have the expected moments") {
    Random random(1);
    double sum = 0.0, squares = 0.0;
    constexpr int n = 200'000;
    for (int i = 0; i < n; ++i) {
        const double x = random.normal();
        sum += x;
        squares += x * x;
        REQUIRE(std::abs(x) <= 3.0);
    }
    CHECK(std::abs(sum / n) < 0.01);
    CHECK(std::sqrt(squares / n) == doctest::Approx(1.0).epsilon(0.01));
    double least = 1.0, most = 0.0;
    for (int i = 0; i < n; ++i) {
        const double x = random.uniform(-2.0, 3.0);
        least = std::min(least, x);
        most = std::max(most, x);
    }
    CHECK(least >= -2.0);
    CHECK(least < -1.99);
    CHECK(most < 3.0);
    CHECK(most > 2.99);
}

TEST_CASE("Files: written completely or not at all, and errors give the reason") {
    const test::Folder temporary;
    const std::filesystem::path& folder = temporary.path();
    REQUIRE(write_file(folder / "a", "one\n").has_value());
    CHECK(read_file(folder / "a", 100, ErrorCode::failed).value() == "one\n");
    CHECK_FALSE(read_file(folder / "a", 2, ErrorCode::failed).has_value());
    CHECK_FALSE(read_file(folder, 100, ErrorCode::failed).has_value());
    const auto missing = read_file(folder / "b", 100, ErrorCode::bad_content);
    REQUIRE_FALSE(missing.has_value());
    CHECK(missing.error().code == ErrorCode::bad_content);
    CHECK(missing.error().file == (folder / "b").string());
    CHECK_FALSE(write_file(folder / "none" / "c", "x").has_value());
    // Overwriting leaves no temporary file.
    REQUIRE(write_file(folder / "a", "two\n").has_value());
    CHECK_FALSE(std::filesystem::exists(folder / "a.part"));
    // A device is written to and not replaced.
    std::filesystem::create_symlink("/dev/null", folder / "null");
    CHECK(write_file(folder / "null", "x").has_value());
    CHECK(std::filesystem::is_symlink(folder / "null"));
    CHECK_FALSE(require_different_files(folder / "a", folder / "." / "a").has_value());
    CHECK(require_different_files(folder / "a", folder / "b").has_value());
}

TEST_CASE("Files: a private file is readable by its user alone, also if an earlier one was not") {
    const test::Folder folder;
    const auto mode = [](const std::filesystem::path& path) {
        struct stat status {};
        REQUIRE(::stat(path.c_str(), &status) == 0);
        return status.st_mode & 0777U;
    };
    const std::filesystem::path path = folder / "names";
    REQUIRE(write_file(path, "old"));
    REQUIRE(write_file(folder / "names.part", "left by a killed program"));
    REQUIRE(write_private_file(path, "new"));
    CHECK(mode(path) == 0600);
    CHECK(read_file(path, 100, ErrorCode::failed).value() == "new");
    CHECK_FALSE(std::filesystem::exists(folder / "names.part"));
    const Status failed = write_private_file(folder / "none" / "names", "x");
    REQUIRE_FALSE(failed);
    CHECK(failed.error().message().find("none/names: cannot be written: No such file") != std::string::npos);
}

TEST_CASE("Files: a failed rename leaves the target and no temporary file") {
    const test::Folder temporary;
    const std::filesystem::path target = temporary.path() / "a", part = temporary.path() / "a.part";
    // A pipe in place of the temporary file delays the write until the target has become a folder.
    REQUIRE(::mkfifo(part.c_str(), 0600) == 0);
    const int reader = ::open(part.c_str(), O_RDONLY | O_NONBLOCK);
    REQUIRE(reader >= 0);
    std::future<Status> written = std::async(
        std::launch::async, [&] { return write_file(target, std::string(std::size_t{1} << 20U, 'x')); });
    pollfd ready{reader, POLLIN, 0};
    REQUIRE(::poll(&ready, 1, 10'000) == 1);
    std::filesystem::create_directories(target / "b");
    REQUIRE(::fcntl(reader, F_SETFL, 0) == 0);  // reads wait for the writer
    std::array<char, 65536> block{};
    while (::read(reader, block.data(), block.size()) > 0) continue;
    CHECK_FALSE(written.get().has_value());
    (void)::close(reader);
    CHECK(std::filesystem::is_directory(target / "b"));
    CHECK_FALSE(std::filesystem::exists(part));
}

TEST_CASE("Fnv1a: the published test values") {
    // Noll's test vectors of the 64-bit FNV-1a hash.
    const auto hash = [](std::string_view text) {
        Fnv1a fnv;
        fnv.add(text);
        return fnv.value();
    };
    CHECK(hash("") == 0xcbf29ce484222325ULL);
    CHECK(hash("a") == 0xaf63dc4c8601ec8cULL);
    CHECK(hash("foobar") == 0x85944171f73967e8ULL);
    const std::byte bytes[] = {std::byte{'a'}};
    Fnv1a fnv;
    fnv.add(bytes);
    CHECK(fnv.value() == hash("a"));
}

TEST_CASE("Wrap: reduces an angle to half a period on either side") {
    CHECK(wrap(7.0 * pi / 2.0, 2.0 * pi) == doctest::Approx(-pi / 2.0));
    CHECK(wrap(to_radians(50.0), pi / 3.0) == doctest::Approx(to_radians(-10.0)));
}

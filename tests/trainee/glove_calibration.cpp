#include "content/trainee/glove_calibration.hpp"

#include <doctest/doctest.h>
#include <sys/resource.h>

#include <csignal>

#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/oracle.hpp"
#include "tests/support/replaced.hpp"

using namespace bolt;
using namespace bolt::content;
namespace fs = std::filesystem;
using test::Folder;
using test::replaced;

namespace {

GloveCalibration example(std::uint64_t seed, std::size_t sensors) {
    Random random(seed);
    GloveCalibration c;
    c.trainee = "Ada Lovelace";
    c.glove = "/dev/serial/by-id/usb-FTDI";
    c.hand = seed % 2 == 0 ? hand::Side::left : hand::Side::right;
    c.sensors = sensors;
    c.date = "2026-11-22";
    c.quality = random.uniform();
    c.hand_length = random.uniform(0.16, 0.21);
    for (const hand::Sensor s : hand::sensors_of(sensors))
        if (random.chance(0.9))
            c.calibration.fits[hand::index(s)] =
                hand::LinearFit{random.uniform(-0.02, 0.02), random.uniform(0.0, 255.0)};
    return c;
}

bool same(const hand::Calibration& a, const hand::Calibration& b) {
    for (std::size_t i = 0; i < hand::sensor_count; ++i) {
        if (a.fits[i].has_value() != b.fits[i].has_value()) return false;
        if (a.fits[i] && (a.fits[i]->gain != b.fits[i]->gain || a.fits[i]->offset != b.fits[i]->offset))
            return false;
    }
    return true;
}

}  // namespace

TEST_CASE("GloveCalibrationFile: writing and reading round-trips to the last bit") {
    for (std::uint64_t seed = 1; seed <= 40; ++seed) {
        const GloveCalibration c = example(seed, seed % 3 == 0 ? 22 : 18);
        const std::string text = glove_calibration_text(c);
        const auto read = parse_glove_calibration(text, "a.json");
        REQUIRE_MESSAGE(read, (read ? "" : read.error().message()));
        CHECK(read->trainee == c.trainee);
        CHECK(read->glove == c.glove);
        CHECK(read->hand == c.hand);
        CHECK(read->sensors == c.sensors);
        CHECK(read->date == c.date);
        CHECK(read->quality == c.quality);
        CHECK(std::abs(read->hand_length - c.hand_length) < 0.6e-6);
        CHECK(same(read->calibration, c.calibration));
        CHECK(glove_calibration_text(c) == text);
    }
}

TEST_CASE("GloveCalibrationFile: errors name file, line, column and what was expected") {
    const std::string good = glove_calibration_text(example(1, 18));
    const auto message = [&](const std::string& from, const std::string& to) {
        const auto read = parse_glove_calibration(replaced(good, from, to), "ada.json");
        REQUIRE(!read);
        CHECK(read.error().code == ErrorCode::bad_content);
        return read.error().message();
    };
    CHECK(message("calibration 1", "calibration 7").find("ada.json:2:13: ") == 0);
    CHECK(message("\"right\"", "\"rihgt\"").find("ada.json:5:11: /hand: a hand cannot be \"rihgt\"") == 0);
    CHECK(message("\"sensors\": 18", "\"sensors\": 20").find("ada.json:6:14: ") == 0);
    CHECK(message("2026-11-22", "2026-13-22").find("is not a date") != std::string::npos);
    CHECK(message("\"offset\"", "\"ofset\"").find("did you mean \"offset\"") != std::string::npos);
    CHECK(message("\"thumb_roll\"", "\"thumb_rool\"").find("thumb_roll") != std::string::npos);
    CHECK(message("\"quality\": ", "\"quality\": 4").find("from 0 to 1") != std::string::npos);
    CHECK(message("\"glove\"", "\"glvoe\"").find("did you mean \"glove\"") != std::string::npos);
    CHECK(message("\"offset\": ", "\"offset\": 4e9, \"gain\": ").find("given twice") != std::string::npos);
    CHECK(message("  \"glove\": \"/dev/serial/by-id/usb-FTDI\",\n", "").find("\"glove\" is missing") !=
          std::string::npos);
    // A truncated file is an error with a line, never a partial calibration.
    for (std::size_t cut = 0; cut + 3 < good.size(); cut += 5) {
        const auto read = parse_glove_calibration(good.substr(0, cut), "ada.json");
        REQUIRE(!read);
        CHECK(read.error().line >= 1);
    }
    CHECK(!parse_glove_calibration("[]", "x"));
    CHECK(!parse_glove_calibration("{\"format\": 3}", "x"));
}

TEST_CASE("GloveCalibrationFile: one file per trainee and hand, and a failed write keeps the old one") {
    const Folder folder;
    const GloveCalibration first = example(1, 22);
    const fs::path path = glove_calibration_path(folder.path(), first.trainee, first.hand);
    CHECK(path != glove_calibration_path(folder.path(), "ada lovelace", first.hand));
    CHECK(path != glove_calibration_path(folder.path(), first.trainee, hand::Side::left));
    CHECK(glove_calibration_path(folder.path(), "../../etc/x", first.hand).parent_path() == folder.path());
    REQUIRE(save_glove_calibration(path, first));
    CHECK(same(load_glove_calibration(path)->calibration, first.calibration));

    // Simulates a full disk with a limit on the file size.
    GloveCalibration second = example(2, 22);
    std::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    REQUIRE(getrlimit(RLIMIT_FSIZE, &before) == 0);
    rlimit little = before;
    little.rlim_cur = 200;
    REQUIRE(setrlimit(RLIMIT_FSIZE, &little) == 0);
    const Status failed = save_glove_calibration(path, second);
    REQUIRE(setrlimit(RLIMIT_FSIZE, &before) == 0);
    REQUIRE(!failed);
    CHECK(failed.error().message().find(path.string()) == 0);
    const auto kept = load_glove_calibration(path);
    REQUIRE(kept);
    CHECK(same(kept->calibration, first.calibration));
    CHECK(std::distance(fs::directory_iterator(folder.path()), fs::directory_iterator()) == 1);

    // A calibration that could not be read back is not written.
    second.date = "yesterday";
    CHECK(!save_glove_calibration(path, second));
    CHECK(same(load_glove_calibration(path)->calibration, first.calibration));
    CHECK(load_glove_calibration(folder / "none.json").error().message().find("none.json") !=
          std::string::npos);
}

TEST_CASE("GloveCalibrationFile: a calibration from the vendor's file is stored like any other") {
    const std::string text =
        read_file(test::test_file("fuzz/corpus/hand.cal"), 4096, ErrorCode::failed).value_or("");
    REQUIRE(!text.empty());
    const auto imported = hand::parse_cal(text, "hand.cal");
    REQUIRE(imported);
    GloveCalibration c = example(1, 22);
    c.calibration = *imported;
    c.quality = 0.0;
    const Folder folder;
    REQUIRE(save_glove_calibration(folder / "x.json", c));
    CHECK(same(load_glove_calibration(folder / "x.json")->calibration, *imported));
}

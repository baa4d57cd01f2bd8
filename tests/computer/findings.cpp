// Findings about this computer: the severity of each, in words of every language, and what is really found
// here.
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>

#include "game/computer/computer.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::computer;

namespace {

Error error_of(const char* what) {
    Error error;
    error.what = what;
    return error;
}

device::ListedDevice device_of(const char* name, device::DeviceKind kind, const char* what = nullptr) {
    device::ListedDevice listed;
    listed.name = name;
    listed.kind = kind;
    if (what != nullptr) listed.error = error_of(what);
    return listed;
}

ServoTiming timing_of(bool adequate) {
    ServoTiming timing;
    timing.assessment.adequate = adequate;
    timing.assessment.reasons = {"late by 3 ms"};
    return timing;
}

// A computer without faults, with everything connected.
ComputerFacts good_facts() {
    ComputerFacts facts;
    facts.gpu = GpuFacts{"a graphics card", false};
    facts.sound = "a sound card";
    facts.devices = {device_of("a puck", device::DeviceKind::puck),
                     device_of("a wheel", device::DeviceKind::wheel),
                     device_of("a keyboard", device::DeviceKind::other)};
    facts.timing = Result<ServoTiming>(timing_of(true));
    facts.sessions = "/sessions";
    facts.free_space = 5e9;
    facts.films = true;
    return facts;
}

const Finding* find(const std::vector<Finding>& all, words::TextKey text) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const Finding& f) { return f.text == text; });
    return found == all.end() ? nullptr : &*found;
}

Severity severity_of(const ComputerFacts& facts, words::TextKey text) {
    const std::vector<Finding> all = findings(facts);
    const Finding* found = find(all, text);
    REQUIRE(found != nullptr);
    return found->severity;
}

}  // namespace

TEST_CASE("Findings: a computer without faults has only good ones, each with its name, and no remedies") {
    const std::vector<Finding> all = findings(good_facts());
    CHECK(all.size() == 7);
    for (const Finding& finding : all) {
        CAPTURE(finding.text.row().name);
        CHECK(finding.severity == Severity::good);
        CHECK_FALSE(finding.remedy);
    }
}

TEST_CASE("Findings: each fault is found, alone") {
    ComputerFacts facts = good_facts();
    SUBCASE("nothing can draw") {
        facts.gpu = fail(error_of("no driver"));
        CHECK(severity_of(facts, "finding.gpu_none") == Severity::bad);
    }
    SUBCASE("the processor draws") {
        facts.gpu->software = true;
        CHECK(severity_of(facts, "finding.gpu_software") == Severity::limited);
    }
    SUBCASE("no sound") {
        facts.sound = fail(error_of("no card"));
        CHECK(severity_of(facts, "finding.no_sound") == Severity::limited);
    }
    SUBCASE("a puck renders no force") {
        facts.devices.erase(facts.devices.begin() + 1);
        CHECK(severity_of(facts, "finding.no_force") == Severity::limited);
    }
    SUBCASE("no device") {
        facts.devices.clear();
        CHECK(severity_of(facts, "finding.no_device") == Severity::limited);
    }
    SUBCASE("a device may not be opened") {
        facts.devices.push_back(device_of("another wheel", device::DeviceKind::wheel, "no permission"));
        CHECK(severity_of(facts, "finding.device_refused") == Severity::limited);
    }
    SUBCASE("ticks are late") {
        facts.timing = Result<ServoTiming>(timing_of(false));
        CHECK(severity_of(facts, "finding.timing_bad") == Severity::limited);
    }
    SUBCASE("the timing failed") {
        facts.timing = Result<ServoTiming>(fail(error_of("no thread")));
        CHECK(severity_of(facts, "finding.timing_failed") == Severity::limited);
    }
    SUBCASE("a right is missing") {
        (*facts.timing)->privileges.refused = {"no real-time priority"};
        CHECK(severity_of(facts, "finding.privilege") == Severity::limited);
    }
    SUBCASE("the disk is almost full") {
        facts.free_space = 0.99 * min_free_space;
        CHECK(severity_of(facts, "finding.disk_low") == Severity::bad);
    }
    SUBCASE("sessions cannot be written") {
        facts.folder_error = "Read-only file system";
        CHECK(severity_of(facts, "finding.folder") == Severity::bad);
    }
    SUBCASE("no films") {
        facts.films = false;
        CHECK(severity_of(facts, "finding.no_films") == Severity::limited);
    }
    const std::vector<Finding> all = findings(facts);
    CHECK(std::count_if(all.begin(), all.end(),
                        [](const Finding& f) { return f.severity != Severity::good; }) == 1);
    CHECK(all.front().severity != Severity::good);  // the worst comes first
    for (const std::string& code : words::languages(words::words_folder())) {
        const words::LoadedWords loaded = words::load_words(words::words_folder(), code);
        REQUIRE(loaded.ok());
        const std::string text = describe(loaded.words, all);
        CAPTURE(text);
        CHECK(text.find('{') == std::string::npos);  // every placeholder has its argument
    }
}

TEST_CASE(
    "Computer facts: the folder of the sessions need not exist; its disk is found, and nothing is written") {
    const test::Folder folder;
    FactsRequest request;
    request.sessions = folder / "not" / "there";
    request.gpu = GpuFacts{"none", false};
    request.open_sound = []() -> Result<std::unique_ptr<audio::Sink>> { return fail(error_of("no card")); };
    const ComputerFacts facts = gather_facts(request);
    CHECK(facts.folder_error.empty());
    const double available = static_cast<double>(std::filesystem::space(folder.path()).available);
    CHECK(std::abs(facts.free_space - available) < 0.2 * available);  // others write meanwhile
    CHECK(std::filesystem::is_empty(folder.path()));
    CHECK(facts.sound.error().what == "no card");
    CHECK_FALSE(facts.timing);

    request.sessions = "/proc/sessions";  // even root may not write there
    const ComputerFacts elsewhere = gather_facts(request);
    CHECK((elsewhere.folder_error.empty() && elsewhere.free_space >= min_free_space) == false);
}

TEST_CASE("Timing: the servo ran at the given rate, and an unknown assembly is an error") {
    const auto timings = time_servo("first-nut", {500.0}, 0.2);
    REQUIRE(timings);
    REQUIRE(timings->size() == 1);
    const servo::Timing& timing = timings->front().timing;
    CHECK(timing.ticks > 0);
    CHECK(static_cast<double>(timing.ticks + timing.missed) <= 1.1 * 500.0 * 0.2 + 500.0);
    CHECK_FALSE(time_servo("nothing", {1000.0}, 0.1));
}

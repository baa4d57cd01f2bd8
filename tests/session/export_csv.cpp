#include "game/session/export.hpp"

#include <doctest/doctest.h>
#include <signal.h>
#include <unistd.h>

#include <charconv>
#include <memory>
#include <sstream>

#include "engine/base/math.hpp"
#include "tests/session/support.hpp"

namespace session_export_csv_test {

using namespace bolt;
using namespace bolt::session;
using namespace bolt::session::test;

namespace {

struct Close {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, Close>;
using Rows = std::vector<std::vector<std::string>>;

std::vector<TickRecord> finite_ticks(std::size_t count) {
    Random random(5);
    std::vector<TickRecord> ticks(count);
    const auto any = [&] { return static_cast<float>(random.normal() * std::exp(10.0 * random.normal())); };
    for (TickRecord& tick : ticks) {
        tick = random_tick(random);
        for (float& value : tick.commanded_tool.position) value = any();
        for (float& value : tick.commanded_tool.orientation) value = any();
        for (float& value : tick.force) value = any();
        for (float& value : tick.torque) value = any();
        tick.wrench_torque = any(), tick.nut_angle = any(), tick.clamp = any();
        tick.joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 4) - 1);
        tick.guided_joint = static_cast<std::int16_t>(static_cast<int>(random.bits() % 4) - 1);
        tick.touched = obstacle_of_number(static_cast<std::int16_t>(static_cast<int>(random.bits() % 4) - 1));
    }
    return ticks;
}

// Joints 0 and 1 have results, with ids that need quoting; joint 2 has none.
SessionReader recorded(const std::filesystem::path& path, const std::vector<TickRecord>& ticks) {
    auto writer = SessionWriter::create(path, sample_header(0.001));
    REQUIRE(writer);
    for (const char* id : {"A,1", "the \"second\""}) {
        lesson::JointResult joint;
        joint.id = id;
        REQUIRE(writer->update(joint));
    }
    for (const TickRecord& tick : ticks) REQUIRE(writer->append(tick));
    REQUIRE(writer->finish({}));
    auto reader = SessionReader::open(path);
    REQUIRE(reader);
    return std::move(*reader);
}

// Splits a line as in RFC 4180, without newlines inside fields.
Rows parsed(const std::string& text) {
    Rows rows;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        REQUIRE(line.ends_with('\r'));
        line.pop_back();
        auto& row = rows.emplace_back(1);
        bool quoted = false;
        for (std::size_t i = 0; i < line.size(); ++i) {
            if (line[i] == '"' && quoted && i + 1 < line.size() && line[i + 1] == '"')
                row.back() += line[i++];
            else if (line[i] == '"')
                quoted = !quoted;
            else if (line[i] == ',' && !quoted)
                row.emplace_back();
            else
                row.back() += line[i];
        }
    }
    return rows;
}

Rows exported(const SessionReader& reader, const std::filesystem::path& csv, std::uint64_t every_n) {
    const File out(std::fopen(csv.c_str(), "wb"));
    REQUIRE(out);
    REQUIRE(export_csv(reader, out.get(), {every_n, csv.string()}));
    return parsed(bytes_of(csv));
}

float number(const std::string& text) {
    float value = 0.0F;
    const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
    CHECK(status == std::errc{});
    CHECK(end == text.data() + text.size());
    return value;
}

}  // namespace

TEST_CASE("CSV export: an exported session reads back to the same ticks") {
    const Folder folder;
    const std::vector<TickRecord> ticks = finite_ticks(2345);
    const SessionReader reader = recorded(folder / "a.session", ticks);
    const Rows rows = exported(reader, folder / "a.csv", 1);
    REQUIRE(rows.size() == ticks.size() + 1);
    CHECK(rows[0].front() == "time_s");
    CHECK(rows[0][13] == "wrench_torque_Nm");
    CHECK(rows[0].back() == "fault");
    const std::string joints[] = {"", "A,1", "the \"second\"", "#2"};
    for (std::size_t i = 0; i < ticks.size(); ++i) {
        const auto& row = rows[i + 1];
        const TickRecord& tick = ticks[i];
        REQUIRE(row.size() == rows[0].size());
        CHECK(std::abs(std::stod(row[0]) - static_cast<double>(i) * 0.001) < 1.0e-9);
        TickRecord read = tick;
        for (std::size_t k = 0; k < 3; ++k) read.commanded_tool.position[k] = number(row[1 + k]);
        for (std::size_t k = 0; k < 4; ++k) read.commanded_tool.orientation[k] = number(row[4 + k]);
        read.wrench_torque = number(row[13]);
        read.clamp = number(row[15]);
        for (std::size_t k = 0; k < 3; ++k) read.force[k] = number(row[16 + k]);
        for (std::size_t k = 0; k < 3; ++k) read.torque[k] = number(row[19 + k]);
        CHECK(same(read, tick));
        CHECK(number(row[14]) == static_cast<float>(to_degrees(static_cast<double>(tick.nut_angle))));
        const char* const grips[] = {"none", "fingers", "wrench"};
        CHECK(row[8] == grips[tick.grip]);
        CHECK(row[9] == ((tick.flags & flag_dead_man) != 0 ? "1" : "0"));
        CHECK(row[10] == joints[tick.guided_joint + 1]);
        CHECK(row[11] == joints[tick.joint + 1]);
        const char* const obstacles[] = {"", "housing", "a \"lid\", 盖", "#2"};
        CHECK(row[22] == std::to_string(tick.contacts));
        CHECK(row[23] == obstacles[*file_number(tick.touched) + 1]);
        CHECK(row[24] == force::message_for(static_cast<force::Fault>(tick.fault)));
        CHECK(row[12] == name(static_cast<joint::Stage>(tick.stage)));
    }
}

TEST_CASE("CSV export: every n-th tick is exported, also across chunks") {
    const Folder folder;
    const SessionReader reader = recorded(folder / "a.session", finite_ticks(3100));
    for (const std::uint64_t every_n : {2U, 7U, 1000U, 1300U, 4000U}) {
        CAPTURE(every_n);
        const Rows rows = exported(reader, folder / "a.csv", every_n);
        REQUIRE(rows.size() == 1 + (3100 + every_n - 1) / every_n);
        for (std::size_t i = 1; i < rows.size(); ++i)
            CHECK(std::abs(std::stod(rows[i][0]) - static_cast<double>((i - 1) * every_n) * 0.001) < 1.0e-9);
    }
    const Status none = export_csv(reader, stdout, {0, "stdout"});
    REQUIRE_FALSE(none);
    CHECK(none.error().code == ErrorCode::usage);
}

TEST_CASE("CSV export: a session without ticks is exported as the header row") {
    const Folder folder;
    CHECK(exported(recorded(folder / "a.session", {}), folder / "a.csv", 1).size() == 1);
}

TEST_CASE("CSV export: the error for a failed write names the destination") {
    const Folder folder;
    std::size_t count = 0;
    SUBCASE("more than one buffer") { count = 3000; }
    SUBCASE("so little data that only the flush fails") { count = 1; }
    const SessionReader reader = recorded(folder / "a.session", finite_ticks(count));
    const File full(std::fopen("/dev/full", "wb"));
    REQUIRE(full);
    const Status to_full = export_csv(reader, full.get(), {1, "/dev/full"});
    REQUIRE_FALSE(to_full);
    CHECK(to_full.error().code == ErrorCode::failed);
    CHECK(to_full.error().message() ==
          "/dev/full: cannot be written: No space left on device; expected a destination that accepts more "
          "data");

    int ends[2];
    REQUIRE(::pipe(ends) == 0);
    ::close(ends[0]);
    const auto before = ::signal(SIGPIPE, SIG_IGN);
    const File broken(::fdopen(ends[1], "wb"));
    const Status to_broken = export_csv(reader, broken.get(), {});
    ::signal(SIGPIPE, before);
    REQUIRE_FALSE(to_broken);
    CHECK(
        to_broken.error().message() ==
        "the standard output: cannot be written: Broken pipe; expected a destination that accepts more data");
}

TEST_CASE("CSV export: a damaged session is exported up to the damage, followed by an error") {
    const Folder folder;
    const std::vector<TickRecord> ticks = finite_ticks(1000);
    { const SessionReader reader = recorded(folder / "a.session", ticks); }
    std::string bytes = bytes_of(folder / "a.session");
    // The last page of a one-second chunk holds no other data, so zeros there damage only the chunk.
    bytes.replace(bytes.size() - 2000, 1000, 1000, '\0');
    put_bytes(folder / "a.session", bytes);
    const auto reader = SessionReader::open(folder / "a.session");
    REQUIRE(reader);
    const File out(std::fopen("/dev/null", "wb"));
    const Status done = export_csv(*reader, out.get(), {1, "/dev/null"});
    REQUIRE_FALSE(done);
    CHECK(done.error().file == (folder / "a.session").string());
    CHECK(done.error().what.find("damaged") != std::string::npos);
}

}  // namespace session_export_csv_test

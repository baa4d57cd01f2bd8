// Helpers for tests of session files: a temporary folder, ticks to record, and a scripted lesson whose file
// can be verified up to any tick.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/base/random.hpp"
#include "game/session/session_file.hpp"
#include "tests/support/folder.hpp"

namespace bolt::session::test {

// In memory if possible, because the tests create thousands of sessions.
class Folder : public bolt::test::Folder {
  public:
    Folder() : bolt::test::Folder(bolt::test::place_in_memory()) {}
};

TickRecord random_tick(Random& random);  // random bits, NaNs too
std::vector<TickRecord> random_ticks(std::size_t count, std::uint64_t seed);
bool same(const TickRecord& a, const TickRecord& b);  // bit for bit
bool same(std::span<const TickRecord> a, std::span<const TickRecord> b);
bool same(const Header& a, const Header& b);
bool same(const lesson::LessonEvent& a, const lesson::LessonEvent& b);
bool same(const lesson::LessonResult& a, const lesson::LessonResult& b);

Header sample_header(double dt);
lesson::LessonResult sample_result();

std::vector<TickRecord> all_ticks(const SessionReader& reader);  // empty if there is an error

std::string bytes_of(const std::filesystem::path& path);
void put_bytes(const std::filesystem::path& path, const std::string& bytes);

// The script: a lesson of 10 ticks a second. Every tick, event and result follows from the tick's number.
inline constexpr std::size_t script_second = 10;
std::filesystem::path script_session(const std::filesystem::path& path,
                                     std::size_t ticks);  // recorded and finished
// Writes a session of 20 ticks as a killed process leaves it: with the files of a recording in progress.
void leave_cut_short(const std::filesystem::path& path, bool with_index);
// Records up to `ticks` ticks and calls `after` with the number of appended ticks. Stops at the first error.
Status play_script(SessionWriter& writer, std::size_t ticks,
                   const std::function<void(std::size_t)>& after = {});
Result<SessionWriter> create_script(const std::filesystem::path& path);
// Empty if `reader` returns exactly the script up to its last tick; otherwise the first difference.
std::string script_mismatch(const SessionReader& reader);

}  // namespace bolt::session::test

// What the tests of the session file share: a folder that goes away, ticks to record, and a lesson whose file
// can be checked wherever it was cut.
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

// In memory if there is such a place: thousands of sessions are made.
class Folder : public bolt::test::Folder {
  public:
    Folder() : bolt::test::Folder(bolt::test::place_in_memory()) {}
};

TickRecord random_tick(Random& random);  // any bits, NaNs too
std::vector<TickRecord> random_ticks(std::size_t count, std::uint64_t seed);
bool same(const TickRecord& a, const TickRecord& b);  // bit for bit
bool same(std::span<const TickRecord> a, std::span<const TickRecord> b);
bool same(const Header& a, const Header& b);
bool same(const lesson::Event& a, const lesson::Event& b);
bool same(const lesson::LessonResult& a, const lesson::LessonResult& b);

Header sample_header(double dt);
lesson::LessonResult sample_result();

std::vector<TickRecord> all_ticks(const Reader& reader);  // empty if there is an error

std::string bytes_of(const std::filesystem::path& path);
void put_bytes(const std::filesystem::path& path, const std::string& bytes);

// A lesson of 10 ticks a second in which every tick, event and result follows from the number of the tick.
inline constexpr std::size_t script_second = 10;
std::filesystem::path script_session(const std::filesystem::path& path,
                                     std::size_t ticks);  // recorded and finished
// A session of 20 ticks as a killed process leaves it: the files of one that is still being recorded.
void leave_cut_short(const std::filesystem::path& path, bool with_index);
// Records up to `ticks` ticks and calls `after` with the number of those that are in; the first error ends
// it.
Status play_script(Writer& writer, std::size_t ticks, const std::function<void(std::size_t)>& after = {});
Result<Writer> create_script(const std::filesystem::path& path);
// Whether what `reader` gives is exactly what was recorded up to its last tick; the reason if not.
std::string script_mismatch(const Reader& reader);

}  // namespace bolt::session::test

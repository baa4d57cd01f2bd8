// Where a program keeps what belongs to its user.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

// By the XDG base directory specification; it need not be there yet. An error: the environment names none.
Result<std::filesystem::path> data_folder();

// A trainee's name as a file's: another for every name, of letters that every file system takes.
std::string file_name_of(std::string_view trainee);

// How a trainee wants the program to be, kept as a JSON file:
//
//   {"format": "boltwright settings 1", "trainee": "Ada", "language": "de", "volume": 0.8, "captions": true,
//    "palette": "distinct", "left_handed": false, "force_scale": 0.5, "seated_height_m": 1.2,
//    "law": "published", "keys": {"tool": "T", "hint": "F1"}}
//
// "law" is left out while the trainee has chosen none.

// `distinct`: colours that stay apart for those who do not tell red from green.
enum class PaletteKind : std::uint8_t { usual, distinct };

inline constexpr double least_force_scale = 0.1;
inline constexpr double lowest_seat = 0.9, highest_seat = 1.5;  // m, of the eyes above the floor

struct Settings {
    std::string trainee;
    std::string language;  // ISO 639; empty: the desktop's
    double volume = 1.0;   // 0 … 1
    bool captions = false;
    PaletteKind palette = PaletteKind::usual;
    bool left_handed = false;
    double force_scale = 1.0;                 // least_force_scale … 1, of what device and assembly allow
    std::optional<double> seated_height;      // m, of the eyes above the floor; none: whoever works stands
    std::string law;                          // "mechanistic", "published"; empty: the assembly's own
    std::map<std::string, std::string> keys;  // by action; what is not in here has its usual key
};

// What can stand in a file: languages, and the actions and keys that the program knows. Nobody but `reserved`
// has the key of that name, which nothing can take from its action.
struct SettingsVocabulary {
    std::vector<std::string> languages, actions, keys;
    std::map<std::string, std::string> reserved;  // key to action
};

// Errors name `file`, line and column of what is wrong.
Result<Settings> parse_settings(std::string_view text, const std::string& file,
                                const SettingsVocabulary& known);
// The same bytes for the same settings.
std::string settings_text(const Settings& settings);

Result<Settings> load_settings(const std::filesystem::path& path, const SettingsVocabulary& known);
// What stood there stays whole if this fails. A file that was there and cannot be read is kept beside it,
// with
// ".unread" after its name.
Status save_settings(const std::filesystem::path& path, const Settings& settings,
                     const SettingsVocabulary& known);

// Where a trainee's settings are kept in a folder.
std::filesystem::path settings_path(const std::filesystem::path& folder, std::string_view trainee);

}  // namespace bolt::content

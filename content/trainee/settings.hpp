// A trainee's settings, stored as a JSON file. `trainee` is the person's code (people.hpp).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/result.hpp"

namespace bolt::content {

// A file name for a trainee: the code itself. For a name, as files of older programs have it: unique for each
// name, with characters that every file system accepts.
std::string file_name_of(std::string_view trainee);
// The inverse; empty if no trainee has this file name.
std::string trainee_of_file_name(std::string_view file_name);

// Limits of the files of a trainee.
inline constexpr std::size_t max_trainee_file_size = 1U << 16U;  // bytes
inline constexpr std::size_t max_trainee_name_size = 64;         // bytes

// The settings file:
//
//   {"format": "boltwright settings 1", "trainee": "T-7K3M9Q", "language": "de", "volume": 0.8,
//    "vibration": 0.5, "captions": true, "palette": "distinct", "left_handed": false, "force_scale": 0.5,
//    "seated_height_m": 1.2, "force_arrow": false, "surroundings": true, "vignette": false,
//    "law": "published",
//    "keys": {"tool": "T", "hint": "F1"}}
//
// "arm_reach_m" is omitted while it is the usual one, "law" until the trainee has chosen one, "force_arrow"
// and "vignette" while they are true, "surroundings" while it is false, and "vibration" while it is 1.

// `distinct`: colours that people with red-green colour blindness can distinguish.
enum class PaletteKind : std::uint8_t { usual, distinct };

inline constexpr double min_force_scale = 0.1;
inline constexpr double min_seated_eye_height = 0.9,
                        max_seated_eye_height = 1.5;  // m, of the eyes above the floor
// m, from the shoulder to the grip of the stretched arm. The usual one is about the median of adults (DIN
// 33402-2).
inline constexpr double min_arm_reach = 0.45, usual_arm_reach = 0.69, max_arm_reach = 0.9;

struct TraineeSettings {
    std::string trainee;     // the person's code; in files of older programs the typed name
    std::string language;    // ISO 639; empty: the desktop's
    double volume = 1.0;     // 0 … 1
    double vibration = 1.0;  // 0 … 1, of hand controllers (servo::VibrationOptions::gain)
    bool captions = false;
    PaletteKind palette = PaletteKind::usual;
    bool left_handed = false;
    double force_scale = 1.0;  // min_force_scale … 1, share of the force that device and assembly permit
    bool force_arrow = true;   // an arrow shows the force on a hand that the mouse moves freely
    // "surroundings": headsets with passthrough show the real room in place of the workshop.
    bool passthrough = false;
    bool vignette = true;                     // a headset darkens the edge of the view while the scene moves
    std::optional<double> seated_eye_height;  // m, of the eyes above the floor; none: the trainee stands
    double arm_reach = usual_arm_reach;       // m; in a room the workpiece stands as far away as it reaches
    std::string law;                          // "mechanistic", "published"; empty: the assembly's own
    std::map<std::string, std::string> keys;  // by action; other actions have their default keys
};

// Valid values of a file: languages, and the program's actions and keys. A key in `reserved` belongs to its
// action and cannot be assigned to another.
struct SettingsVocabulary {
    std::vector<std::string> languages, actions, keys;
    std::map<std::string, std::string> reserved;  // key to action
};

// Errors name `file`, line and column.
Result<TraineeSettings> parse_settings(std::string_view text, const std::string& file,
                                       const SettingsVocabulary& known);
// Deterministic: equal settings give equal bytes.
std::string settings_text(const TraineeSettings& settings);

Result<TraineeSettings> load_settings(const std::filesystem::path& path, const SettingsVocabulary& known);
// An existing file is unchanged if this fails. An existing file that cannot be parsed is renamed with the
// suffix ".unread".
Status save_settings(const std::filesystem::path& path, const TraineeSettings& settings,
                     const SettingsVocabulary& known);

// Path of a trainee's settings in a folder.
std::filesystem::path settings_path(const std::filesystem::path& folder, std::string_view trainee);

}  // namespace bolt::content

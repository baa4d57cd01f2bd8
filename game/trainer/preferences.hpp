// The settings of whoever is at the window: read when they have said who they are, kept when they have
// changed them. What cannot be read or written is told and lets everything else go on.
#pragma once

#include <filesystem>

#include "content/trainee/settings.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::trainer {

struct Preferences {
    std::filesystem::path folder;  // with a file a trainee; empty: nothing is kept by name
    std::filesystem::path file;    // this one instead, whoever it is; empty: by name
    content::SettingsVocabulary known;

    content::Settings settings;
    KeyMap keys;  // of the settings
    std::string whose;
    std::string kept;  // as the file has them, or as they would be without one
    enum class Trouble : std::uint8_t { none, unread, unwritten } trouble = Trouble::none;
    std::string why;  // with file, line and column
};

// The file that these are kept in; empty: in none, because nobody has said a name.
std::filesystem::path kept_in(const Preferences& preferences);

// Those of that trainee. Who has none yet begins with the usual ones, or with what was changed before
// anybody's name was said.
void take(Preferences& preferences, const std::string& trainee);

// Writes what has changed since it was read; false: that is not on the disk. Nothing is written of what is as
// usual and was never kept.
bool keep(Preferences& preferences);

}  // namespace bolt::trainer

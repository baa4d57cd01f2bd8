// The settings of the trainee at the window: loaded when the trainee enters a name, saved when they change. A
// file that cannot be read or written is reported and does not stop the program.
#pragma once

#include <filesystem>

#include "content/trainee/settings.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::trainer {

struct Preferences {
    std::filesystem::path folder;       // one file per trainee; empty: nothing is saved by name
    std::filesystem::path file;         // used for all trainees instead of `folder`, unless empty
    content::SettingsVocabulary known;  // the values that a settings file may contain

    content::TraineeSettings settings;
    KeyMap keys;               // parsed from settings.keys
    std::string trainee;       // the person's code; empty: no name was entered
    std::string display_name;  // the person's name for the screen; empty: the code is shown
    std::string file_text;     // the file's content; without a file, that of the default settings
    enum class FileError : std::uint8_t { none, read_failed, write_failed } file_error = FileError::none;
    std::string file_error_message;  // with file, line and column
};

// The file of the current settings; empty if they are not saved.
std::filesystem::path settings_file(const Preferences& preferences);

// Loads the settings of a trainee. Without a file the trainee starts with the default settings, or keeps
// those that were changed before the first name was entered. Sets `file_error` if the file cannot be read.
void load_preferences(Preferences& preferences, const std::string& trainee);

// Saves the settings if they differ from the file. Returns false and sets `file_error` if that fails. Default
// settings without a file are not written.
bool save_preferences(Preferences& preferences);

}  // namespace bolt::trainer

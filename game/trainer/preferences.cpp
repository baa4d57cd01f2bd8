#include "game/trainer/preferences.hpp"

namespace bolt::trainer {

namespace {

namespace fs = std::filesystem;

void use(Preferences& p, content::TraineeSettings settings) {
    p.keys = keys_of(settings.keys);
    p.settings = std::move(settings);
    p.settings.keys = names_of(p.keys);
}

content::TraineeSettings default_settings(const std::string& trainee) {
    content::TraineeSettings settings;
    settings.trainee = trainee;
    settings.keys = names_of(KeyMap{});
    return settings;
}

}  // namespace

fs::path settings_file(const Preferences& p) {
    if (!p.file.empty()) return p.file;
    if (p.folder.empty() || p.trainee.empty()) return {};
    return content::settings_path(p.folder, p.trainee);
}

void load_preferences(Preferences& p, const std::string& trainee) {
    const bool had_trainee = !p.trainee.empty();
    p.trainee = trainee;
    p.file_error = Preferences::FileError::none;
    p.file_error_message.clear();
    const fs::path path = settings_file(p);
    const content::TraineeSettings defaults = default_settings(trainee);
    p.file_text = content::settings_text(defaults);
    std::error_code problem;
    if (path.empty() || !fs::exists(path, problem)) {
        if (had_trainee && p.file.empty()) use(p, defaults);
        p.settings.trainee = trainee;
        return;
    }
    auto read = content::load_settings(path, p.known);
    use(p, read ? *read : defaults);
    p.settings.trainee = trainee;  // a file for all trainees may have another's, or an older program's name
    p.file_text = content::settings_text(p.settings);
    if (read) return;
    p.file_error = Preferences::FileError::read_failed;
    p.file_error_message = read.error().message();
}

bool save_preferences(Preferences& p) {
    const fs::path path = settings_file(p);
    p.settings.keys = names_of(p.keys);
    const std::string text = content::settings_text(p.settings);
    if (path.empty() || text == p.file_text) return true;
    const Status written = content::save_settings(path, p.settings, p.known);
    p.file_error = written ? Preferences::FileError::none : Preferences::FileError::write_failed;
    p.file_error_message = written ? std::string() : written.error().message();
    if (written) p.file_text = text;
    return written.has_value();
}

}  // namespace bolt::trainer

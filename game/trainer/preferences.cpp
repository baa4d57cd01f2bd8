#include "game/trainer/preferences.hpp"

namespace bolt::trainer {

namespace {

namespace fs = std::filesystem;

void use(Preferences& p, content::Settings settings) {
    p.keys = keys_of(settings.keys);
    p.settings = std::move(settings);
    p.settings.keys = names_of(p.keys);
}

content::Settings usual_of(const std::string& trainee) {
    content::Settings usual;
    usual.trainee = trainee;
    usual.keys = names_of(KeyMap{});
    return usual;
}

}  // namespace

fs::path kept_in(const Preferences& p) {
    if (!p.file.empty()) return p.file;
    if (p.folder.empty() || p.whose.empty()) return {};
    return content::settings_path(p.folder, p.whose);
}

void take(Preferences& p, const std::string& trainee) {
    const bool somebody_before = !p.whose.empty();
    p.whose = trainee;
    p.trouble = Preferences::Trouble::none;
    p.why.clear();
    const fs::path path = kept_in(p);
    const content::Settings usual = usual_of(trainee);
    p.kept = content::settings_text(usual);
    std::error_code problem;
    if (path.empty() || !fs::exists(path, problem)) {
        if (somebody_before && p.file.empty()) use(p, usual);
        p.settings.trainee = trainee;
        return;
    }
    auto read = content::load_settings(path, p.known);
    use(p, read ? *read : usual);
    p.kept = content::settings_text(p.settings);
    if (read) return;
    p.trouble = Preferences::Trouble::unread;
    p.why = read.error().message();
}

bool keep(Preferences& p) {
    const fs::path path = kept_in(p);
    p.settings.keys = names_of(p.keys);
    const std::string text = content::settings_text(p.settings);
    if (path.empty() || text == p.kept) return true;
    const Status written = content::save_settings(path, p.settings, p.known);
    p.trouble = written ? Preferences::Trouble::none : Preferences::Trouble::unwritten;
    p.why = written ? std::string() : written.error().message();
    if (written) p.kept = text;
    return written.has_value();
}

}  // namespace bolt::trainer

// The part of App that follows the trainee: the person, the settings and the language.
#include <fmt/format.h>

#include "game/trainer/app.hpp"

namespace bolt::trainer {

Status App::select_language(const std::string& code) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), code);
    if (!loaded.ok()) return fail(loaded.errors.front());
    words_ = std::move(loaded.words);
    options_.choice.language = code;
    apply_preferences();
    return {};
}

// Identifies the person of the text, shows the person's name instead of a code, and loads the settings.
void App::load_trainee() {
    std::string& text = options_.choice.trainee;
    content::IdentifiedPerson identified = content::identify_person(
        {options_.people_folder, options_.settings_folder, options_.gloves_folder}, text);
    const content::Person& person = identified.person;
    if (identified.names_error) log(identified.names_error->message());
    if (!identified.similar_code.empty())
        log(fmt::format("{} is new here; did you mean {}?", person.code, identified.similar_code));
    for (const Error& error : identified.adoption_errors) log(error.message());
    load_preferences(preferences_, person.code);
    preferences_.display_name = person.name;
    if (preferences_.file_error != Preferences::FileError::none) log(preferences_.file_error_message);
    if (!person.name.empty())
        text = person.name;
    else if (person.code.empty() || content::typed_person_code(text))
        text = person.code;
    menu_.trainee = {text, std::move(identified)};
}

// Loads the settings of the trainee whose name was entered, after saving those of the previous one.
void App::select_trainee() {
    if (options_.choice.trainee == menu_.trainee.text) return;
    save_preferences();
    load_trainee();
    const std::string& language = preferences_.settings.language;
    if (!language.empty() && language != words_.language) selected_language_ = language;
    apply_preferences();
}

void App::save_preferences() {
    if (!trainer::save_preferences(preferences_)) log(preferences_.file_error_message);
}

void App::apply_preferences() {
    const StationClient* station = active_ && active_->station ? &*active_->station : nullptr;
    controls_ = control_names(words_, preferences_.keys, options_.choice.equipment, station);
    if (!active_) return;
    const content::TraineeSettings& settings = preferences_.settings;
    ActiveLesson& active = *active_;
    active.input.keys = preferences_.keys;
    active.sound.volume = settings.volume;
    active.force.enabled = settings.force_arrow;
    active.vibration.options.gain = settings.vibration;
    active.palette = view::palette_of(settings.palette);
    if (settings.captions != active.sound.captions.has_value())
        active.sound.captions = settings.captions ? std::optional(Captions{}) : std::nullopt;
}

}  // namespace bolt::trainer

#include "game/trainer/preferences.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <algorithm>

#include "game/trainer/app.hpp"

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

// The screen of a trainee's own settings, from the menu and from the pause. What is changed holds at once,
// but for hand, seat and strength, which are those of a whole lesson.

namespace {

constexpr ImGuiWindowFlags panel = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar;
constexpr double usual_seat = 1.2;  // m

void wrapped(const std::string& line, const ImVec4& color = {0.75F, 0.8F, 0.85F, 1.0F}) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextWrapped("%s", line.c_str());
    ImGui::PopStyleColor();
}

words::Key term(Action action) {
    constexpr words::Key keys[] = {"action.tool",         "action.find_view",  "action.whole_view",
                                   "action.hint",         "action.flange_map", "action.pause",
                                   "action.full_screen",  "action.quiet",      "action.undo",
                                   "action.restart_step", "action.recentre",   "action.close_up"};
    static_assert(std::size(keys) == action_count);
    return keys[static_cast<std::size_t>(action)];
}

// Whole hundredths: what a hand means by a slider, and what is short in a file.
bool slider(const char* label, double& value, double low, double high, const char* format, double shown_as) {
    auto shown = static_cast<float>(value * shown_as);
    const bool moved =
        ImGui::SliderFloat(label, &shown, static_cast<float>(low * shown_as),
                           static_cast<float>(high * shown_as), format, ImGuiSliderFlags_AlwaysClamp);
    if (moved)
        value = std::clamp(std::round(100.0 * static_cast<double>(shown) / shown_as) / 100.0, low, high);
    return moved;
}

}  // namespace

void App::remember_place(words::Key key) {
    const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
    buttons_.push_back({key, {0.5F * (low.x + high.x), 0.5F * (low.y + high.y)}, high.x - low.x});
}

void App::open_settings() {
    meet_trainee();
    settings_.emplace();
}

void App::close_settings() {
    settings_.reset();
    keep_preferences();
}

// Of whoever has said a name: what they kept; what the one before has changed is kept first.
void App::meet_trainee() {
    if (options_.choice.trainee == preferences_.whose) return;
    keep_preferences();
    take(preferences_, options_.choice.trainee);
    if (preferences_.trouble != Preferences::Trouble::none) tell(preferences_.why);
    const std::string& language = preferences_.settings.language;
    if (!language.empty() && language != words_.language) language_wished_ = language;
    apply_preferences();
}

void App::keep_preferences() {
    if (!keep(preferences_)) tell(preferences_.why);
}

void App::apply_preferences() {
    name_controls();
    if (!playing_) return;
    const content::Settings& settings = preferences_.settings;
    ActiveLesson& p = *playing_;
    p.controls.keys = preferences_.keys;
    p.sound.volume = settings.volume;
    p.palette = view::palette_of(settings.palette);
    if (settings.captions != p.sound.captions.has_value())
        p.sound.captions = settings.captions ? std::optional(Captions{}) : std::nullopt;
}

void App::bind_key(platform::Key key) {
    const Action action = *settings_->awaits;
    const Binding bound = bind(preferences_.keys, action, key);
    const std::string pressed(platform::name(key));
    if (bound.how == Bound::refused) {
        settings_->said = words::say(words_, "settings.key_refused", {{"key", pressed}});
        return;
    }
    settings_->awaits.reset();
    settings_->said.clear();
    if (bound.how == Bound::swapped)
        settings_->said = words::say(words_, "settings.key_swapped",
                                     {{"key", pressed},
                                      {"action", words_[term(bound.with)]},
                                      {"other", key_name(preferences_.keys, bound.with)}});
    apply_preferences();
}

std::vector<platform::Event> App::take_settings_keys(std::span<const platform::Event> events) {
    std::vector<platform::Event> left;
    for (const platform::Event& event : events) {
        const auto* key = std::get_if<platform::KeyEvent>(&event);
        const bool waits = settings_ && settings_->awaits;
        const bool pressed = key != nullptr && key->down && !key->repeated;
        if (settings_ && pressed && key->key == platform::Key::escape) {
            // First it leaves the question for a key, then the screen.
            if (waits)
                settings_->awaits.reset();
            else
                close_settings();
        } else if (waits && pressed) {
            bind_key(key->key);
        } else if (!waits || (key == nullptr || !key->down)) {
            left.push_back(event);
        }
    }
    return left;
}

void App::draw_languages() {
    for (const words::Words& language : languages_)
        if (ImGui::RadioButton(language.name.c_str(), language.language == words_.language)) {
            language_wished_ = language.language;
            preferences_.settings.language = language.language;
        } else {
            ImGui::SameLine();
        }
    ImGui::NewLine();
}

void App::draw_people() {
    content::Settings& settings = preferences_.settings;
    draw_languages();
    slider(words_["menu.sound"].c_str(), settings.volume, 0.0, 1.0, "%.0f %%", 100.0);
    remember_place("menu.sound");
    ImGui::Checkbox(words_["menu.captions"].c_str(), &settings.captions);
    remember_place("menu.captions");
    ImGui::AlignTextToFramePadding();
    ImGui::TextUnformatted(words_["menu.palette"].c_str());
    for (const auto& [key, kind] :
         {std::pair{words::Key("menu.palette.usual"), content::PaletteKind::usual},
          std::pair{words::Key("menu.palette.distinct"), content::PaletteKind::distinct}}) {
        ImGui::SameLine();
        if (ImGui::RadioButton(words_[key].c_str(), settings.palette == kind)) settings.palette = kind;
        remember_place(key);
    }
    ImGui::Separator();
    ImGui::Checkbox(words_["menu.left_handed"].c_str(), &settings.left_handed);
    remember_place("menu.left_handed");
    bool seated = settings.seated_height.has_value();
    if (ImGui::Checkbox(words_["menu.seated"].c_str(), &seated))
        settings.seated_height = seated ? std::optional(usual_seat) : std::nullopt;
    remember_place("menu.seated");
    if (settings.seated_height) {
        slider(words_["settings.seated_height"].c_str(), *settings.seated_height, content::lowest_seat,
               content::highest_seat, "%.2f m", 1.0);
        remember_place("settings.seated_height");
    }
    slider(words_["menu.force_scale"].c_str(), settings.force_scale, content::least_force_scale, 1.0,
           "%.0f %%", 100.0);
    remember_place("menu.force_scale");
    if (playing_ && shows_ == Shows::lesson) wrapped(words_["settings.next_lesson"]);
}

void App::draw_keys() {
    ImGui::TextUnformatted(words_["menu.keys"].c_str());
    ImGui::Columns(2, "keys", false);
    for (std::size_t i = 0; i < action_count; ++i) {
        const auto action = static_cast<Action>(i);
        const bool waits = settings_->awaits == action;
        ImGui::PushID(static_cast<int>(i));
        if (ImGui::Button(waits ? "…" : key_name(preferences_.keys, action).c_str(),
                          {80.0F * input_.scale, 0.0F})) {
            settings_->awaits = waits ? std::nullopt : std::optional(action);
            settings_->said.clear();
        }
        remember_place(term(action));
        ImGui::PopID();
        ImGui::SameLine();
        ImGui::TextUnformatted(words_[term(action)].c_str());
        if (i + 1 == action_count / 2) ImGui::NextColumn();
    }
    ImGui::Columns(1);
    if (settings_->awaits)
        wrapped(words::say(words_, "settings.press_key", {{"action", words_[term(*settings_->awaits)]}}),
                {1.0F, 0.85F, 0.4F, 1.0F});
    if (!settings_->said.empty()) wrapped(settings_->said, {1.0F, 0.85F, 0.4F, 1.0F});
    wrapped(words_["settings.escape"]);
    if (button("settings.usual_keys")) {
        preferences_.keys = KeyMap{};
        *settings_ = {};
    }
}

// Where they are kept, and what is wrong about it.
void App::draw_kept() {
    const ImVec4 warm(1.0F, 0.55F, 0.45F, 1.0F);
    switch (preferences_.trouble) {
        case Preferences::Trouble::unread:
            return wrapped(words::say(words_, "settings.unread", {{"why", preferences_.why}}), warm);
        case Preferences::Trouble::unwritten:
            return wrapped(words::say(words_, "settings.unwritten", {{"why", preferences_.why}}), warm);
        case Preferences::Trouble::none:
            break;
    }
    if (kept_in(preferences_).empty())
        wrapped(words_["settings.not_kept"]);
    else if (!preferences_.whose.empty())
        wrapped(words::say(words_, "settings.kept", {{"trainee", preferences_.whose}}));
}

void App::draw_settings(const glm::dvec2& size) {
    const float scale = input_.scale, width = 720.0F * scale;
    ImGui::SetNextWindowPos({static_cast<float>(0.5 * size.x), static_cast<float>(0.5 * size.y)},
                            ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(size.y)});
    ImGui::SetNextWindowBgAlpha(0.96F);
    ImGui::Begin("##settings", nullptr, panel);
    ImGui::TextUnformatted(words_["menu.settings"].c_str());
    ImGui::Separator();
    draw_people();
    ImGui::Separator();
    draw_keys();
    ImGui::Separator();
    draw_kept();
    const bool back = button("menu.back");
    ImGui::End();
    apply_preferences();
    if (back) close_settings();
}

}  // namespace bolt::trainer

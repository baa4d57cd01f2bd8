// The trainer but for its window: a menu, a lesson, how it came out; each a screen. People's doings come in
// as events, a picture goes out; what is on the GPU can be lost and made again without losing the lesson.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "engine/ui/ui.hpp"
#include "game/lesson/hints.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/preferences.hpp"
#include "game/trainer/screens.hpp"
#include "game/trainer/station_client.hpp"
#include "game/view/pictures.hpp"

namespace bolt::trainer {

struct Choice {
    std::string assembly = "zq350";
    std::string variant;  // empty: the assembly's default
    lesson::Mode mode = lesson::Mode::guided;
    lesson::Task task = lesson::Task::tighten;
    std::string trainee;
    std::string language;  // empty: that of the desktop, if there is one
    std::string tool;      // empty: the assembly's first
    Equipment with;        // none: mouse and keyboard
};

struct AppOptions {
    Choice choice;
    bool sound = false;
    bool menu = true;  // false: the lesson begins at once
    session::CourseOptions course;
    std::optional<joint::Law>
        law;                    // until another is chosen in the menu; none: the trainee's or the assembly's
    std::filesystem::path out;  // where sessions go
    std::filesystem::path settings_folder, settings_file;  // as Preferences has them; empty: nothing is kept
    std::function<void()> begins;  // a lesson: what an earlier one left would speak of another
    // After a lesson, whole or broken off: what is left of it beside the session.
    std::function<Status(const content::Assembly&, const session::CourseOptions&, const session::Played&)>
        ended;
    std::function<void(const std::string&)> tell;  // a line of what happens, for a log
    // Where somebody plays who has chosen devices.
    std::function<Result<std::unique_ptr<station_setup::Bench>>(const content::Assembly&,
                                                                const session::CourseOptions&,
                                                                const Equipment&, const std::string& trainee)>
        station = start_station;
};

enum class Shows : std::uint8_t { menu, lesson, result };

// A menu's entry.
struct Listed {
    std::string name, usual;                           // and its usual variant
    std::map<std::string, std::string> title, lesson;  // by language
    std::vector<content::Variant> variants;
    std::vector<content::Tool> tools;
    joint::Law law = joint::Law::mechanistic;
};

// A button as it was drawn last: for whoever presses it without eyes.
struct ButtonPlace {
    words::Key label;
    glm::vec2 middle{0.0F};  // px
    float width = 0.0F;      // px
};

// The settings as they are being changed.
struct SettingsScreen {
    std::optional<Action> awaits;  // the key for this is to be pressed
    std::string said;              // about the key that was pressed last
};

class App {
  public:
    explicit App(AppOptions options);
    App(const App&) = delete;
    App& operator=(const App&) = delete;
    ~App();

    // What is on the GPU; again after it was lost.
    Status start(view::Painter& painter);
    void drop();  // before the painter goes

    // Records a picture into the frame: it is the renderer's picture 0 afterwards.
    Status frame(gpu::FrameContext& frame, std::span<const platform::Event> events, VkExtent2D size,
                 float scale, double seconds);

    [[nodiscard]] bool closed() const { return closed_; }
    [[nodiscard]] Shows shows() const { return shows_; }
    [[nodiscard]] bool wants_full_screen() { return std::exchange(full_screen_, false); }
    [[nodiscard]] const ActiveLesson* playing() const { return playing_ ? &*playing_ : nullptr; }
    // What stands behind the menu.
    [[nodiscard]] const Backdrop& backdrop() const { return backdrop_; }
    [[nodiscard]] std::span<const ButtonPlace> buttons() const { return buttons_; }
    [[nodiscard]] const Preferences& preferences() const { return preferences_; }
    [[nodiscard]] bool shows_settings() const { return settings_.has_value(); }
    // What went wrong when a lesson was to begin.
    [[nodiscard]] const std::optional<Error>& trouble() const { return trouble_; }

    // Ends a lesson under way as it stands: its session and what is left of it are kept.
    Status end_lesson();

    // Instead of a picture, while there is nothing to see: nobody works then.
    Status unseen();

  private:
    struct OnGpu;
    Status begin_lesson(float aspect);
    Status start_station(ActiveLesson& playing, session::Prepared& prepared);

    void take_place();
    void name_controls();
    Status place_on_gpu();
    void draw_interface(const glm::dvec2& size);
    Status draw_backdrop(gpu::FrameContext& frame, VkExtent2D size);
    void draw_menu(const glm::dvec2& size);
    void draw_seats();
    void draw_laws(joint::Law of_assembly);
    // What is in force: by command line, else by the trainee's settings, else by the assembly.
    [[nodiscard]] joint::Law law_in_force(joint::Law of_assembly) const;
    void draw_result(const glm::dvec2& size);
    void draw_pause(const glm::dvec2& size);
    void draw_settings(const glm::dvec2& size);
    void draw_people();
    void draw_languages();
    void draw_keys();
    void draw_kept();
    bool button(words::Key key);
    void remember_place(words::Key key);
    void open_settings();
    void close_settings();
    // Of a frame: keys that are bound, Escape that leaves. What is left of them for the interface.
    std::vector<platform::Event> take_settings_keys(std::span<const platform::Event> events);
    void bind_key(platform::Key key);
    void meet_trainee();
    void apply_preferences();
    void keep_preferences();
    Status speak(const std::string& language);
    void tell(const std::string& line) const;
    void tell_events();
    void tell_cost();

    AppOptions options_;
    Shows shows_ = Shows::menu;
    std::vector<Listed> listed_;
    std::vector<Seat> seats_;
    content::Assembly assembly_;
    std::optional<scene::Shelf> shelf_;
    std::optional<ActiveLesson> playing_;
    std::optional<session::Played> played_;
    session::CourseOptions course_;
    std::optional<Error> trouble_;
    std::map<std::string_view, std::vector<float>> cost_;  // ms, by system and frame of this lesson
    std::vector<words::Words> languages_;
    words::Words words_;
    lesson::Controls controls_;
    std::optional<std::string> language_wished_;
    Preferences preferences_;
    std::optional<SettingsScreen> settings_;  // while it is shown
    ui::Input input_;
    std::vector<ButtonPlace> buttons_;
    std::unique_ptr<OnGpu> on_;
    Backdrop backdrop_;
    bool closed_ = false, full_screen_ = false;
    bool start_wished_ = false, end_wished_ = false;
};

// The assemblies under content/, those that load.
std::vector<Listed> list_assemblies();

}  // namespace bolt::trainer

// The trainer without its window: menu, lesson and result. Each frame takes the input events and records one
// picture. All GPU objects can be released and created again (after a lost GPU) while a lesson continues.
#pragma once

#include <map>

#include "engine/ui/ui.hpp"
#include "game/trainer/arm_screen.hpp"
#include "game/trainer/lesson_start.hpp"
#include "game/trainer/menu.hpp"
#include "game/trainer/room_hands.hpp"
#include "game/trainer/room_state.hpp"
#include "game/trainer/settings_screen.hpp"
#include "game/trainer/shared_lesson.hpp"
#include "game/trainer/study_screen.hpp"
#include "game/trainer/tour.hpp"
#include "game/view/window.hpp"

namespace bolt::trainer {

struct AppOptions {
    LessonChoice choice;
    bool sound = false;
    bool menu = true;                       // false: a lesson starts at once
    session::LessonOptions lesson;          // those that neither choice nor settings determine
    std::filesystem::path out;              // folder of the session
    bool folder_per_lesson = false;         // each lesson gets a folder of its own in `out`
    std::filesystem::path settings_folder;  // has a settings file for each trainee
    std::filesystem::path settings_file;    // if not empty, the settings of all trainees
    // The folders of the names and codes, and of the glove calibrations (content::PersonFolders). Without a
    // folder for names each typed name gets a new code.
    std::filesystem::path people_folder, gloves_folder;
    view::Mirror mirror = view::Mirror::left_eye;  // what the window of a headset shows first
    bool first_start = false;                      // the menu offers the tour first
    ComputerCheck::GatherFacts gather_facts = computer::gather_facts;  // tests replace it
    StationFactory start_station = trainer::start_station;

    // Called with the folder of a lesson when it starts. It should remove the files of an earlier lesson,
    // such as its report, because they do not describe the new session.
    std::function<void(const std::filesystem::path&)> on_start;
    // Called when a lesson has ended, completed or not. It should write the files that belong to the session,
    // such as its report, into the same folder.
    std::function<Status(const content::Assembly&, const session::LessonOptions&,
                         const session::LessonOutcome&, const std::filesystem::path&)>
        on_end;
    std::function<void(const std::string&)> log;  // receives one line at a time
};

enum class ShownScreen : std::uint8_t {
    menu,
    starting,  // a lesson with devices, or one that is continued, is being started
    lesson,
    result,
    study,  // the page of the due step
};

class App : public view::WindowContent {
  public:
    // With `study`, the app leads that study's participant through the steps and shows no menu.
    explicit App(AppOptions options, std::optional<StudyRun> study = {});
    ~App() override;

    // Creates all GPU objects. Call it at the beginning and after release().
    Status start(view::GpuContext& gpu_context) override;
    // Releases all GPU objects; call it before the GPU context is destroyed. A lesson continues after the
    // next start().
    void release() override;

    // Fails if the session cannot be recorded.
    Status update(const view::WindowFrame& window) override;
    // Writes the frame for the other processes that draw projection walls; parts that are large and seldom
    // change go into `bulk`.
    Status share(cluster::MessageWriter& message, cluster::MessageWriter& bulk) override;
    // Fails if the GPU fails, or the session cannot be recorded.
    Status draw(gpu::FrameContext& frame, const view::WindowFrame& window) override;
    // Moves the eyes of the drawn frame to a newer pose of the head, shortly before the GPU draws it.
    bool move_eyes(const view::WindowFrame& window) override;
    // Called instead of update() and draw() while the window is minimised: pauses a station.
    Status frame_while_hidden() override;

    // Ends the lesson, if one runs, as it stands. Its session and the files beside it are written.
    Status end_lesson();
    // If the program ends during a lesson of a study, that lesson is not counted: it is continued later.
    Status end() override {
        interrupted_ = true;
        return end_lesson();
    }

    // True if the due step of a study needs another display than the present one (wanted_display()). The
    // caller opens it; if that fails, it opens the window. Then it calls enter_display() with the result and
    // runs the app again.
    [[nodiscard]] bool wants_other_display() const override { return wanted_display_.has_value(); }
    [[nodiscard]] const LessonDisplay& wanted_display() const { return *wanted_display_; }
    void enter_display(const Status& opened);

    [[nodiscard]] bool closed() const override { return closed_; }
    // True if a slow GPU may draw the scene with fewer pixels than the window has.
    [[nodiscard]] bool scales_scene() const override { return active_.has_value() && !in_room(); }
    // True if the trainee's settings want to see the real room, and always while the check of an arm's
    // registration waits for the touch of a check point.
    [[nodiscard]] bool wants_passthrough() const override {
        return preferences_.settings.passthrough || awaits_touch();
    }
    [[nodiscard]] render::ImageLayer window_picture(const render::Renderer& renderer) const override {
        if (in_room()) return gpu_->panel->layer();
        return gpu_->shows_enlarged ? gpu_->enlarged->layer() : renderer.picture(0);
    }
    [[nodiscard]] view::Mirror mirror() const override { return options_.mirror; }
    [[nodiscard]] std::optional<render::ImageLayer> panel_picture() const override {
        return in_room() && room_->panel ? std::optional(gpu_->panel->layer()) : std::nullopt;
    }
    [[nodiscard]] bool take_full_screen_request() override {
        return std::exchange(full_screen_requested_, false);
    }

    // The state on the screen, for tests.
    [[nodiscard]] ShownScreen screen() const { return screen_; }
    [[nodiscard]] const ActiveLesson* lesson() const { return active_ ? &*active_ : nullptr; }
    [[nodiscard]] const AssemblyPictures& pictures() const { return pictures_; }
    [[nodiscard]] MenuPage menu_page() const { return menu_.page; }
    [[nodiscard]] const ComputerCheck& computer_check() const { return menu_.check; }
    [[nodiscard]] const LessonChoice& choice() const { return options_.choice; }
    [[nodiscard]] const std::optional<Tour>& tour() const { return tour_; }
    [[nodiscard]] std::span<const DrawnWidget> drawn_widgets() const { return drawn_widgets_; }
    [[nodiscard]] const Preferences& preferences() const { return preferences_; }
    [[nodiscard]] bool shows_settings() const { return settings_.has_value(); }
    [[nodiscard]] const std::optional<Error>& start_error() const { return menu_.start_error; }
    [[nodiscard]] const ArmScreen& arm_screen() const { return arm_screen_; }
    [[nodiscard]] const std::optional<RoomState>& room() const { return room_; }
    [[nodiscard]] const RoomHandModels* room_hands() const { return gpu_->room_hands.get(); }
    [[nodiscard]] const std::optional<StudyScreen>& study() const { return study_; }

  private:
    struct GpuResources {
        view::GpuContext* context = nullptr;
        std::unique_ptr<ui::Ui> ui;
        std::unique_ptr<scene::GpuLessonModels> models;
        std::optional<text::Fonts> fonts;
        std::unique_ptr<RoomHandModels> room_hands;  // null before the first tracked hands or wand
        std::optional<render::PanelPicture> panel;   // none before the interface is first drawn in a room
        // The window's picture, if the scene was drawn with fewer pixels.
        std::optional<render::PanelPicture> enlarged;
        bool shows_enlarged = false;
    };
    // The picture of the interface: that of the window, or of the panel in a room.
    struct Picture {
        std::span<const platform::InputEvent> events;
        VkExtent2D size{};
        float scale = 1.0F;
    };
    // Functions follow_… update one part of the app in each frame.
    Status begin_lesson(float aspect);
    Status enter_lesson(Result<StartedLesson> started, float aspect);
    Status report_start(Status begun);
    void cancel_start();
    void follow_arm(std::span<const platform::InputEvent> events, double seconds, bool enter_key_answers);
    Status close_lesson();  // releases an ended lesson, when its result is left
    [[nodiscard]] LessonChoice lesson_choice() const;
    Result<LessonRequest> study_request();
    void request_display();
    void follow_study_display();
    [[nodiscard]] bool shown_in_headset() const;
    Status record_study_lesson(const StartedLesson& started);
    void count_study_lesson();
    Status upload_models();
    void begin_instruction();
    [[nodiscard]] bool shows_instruction() const;
    ScreenAction draw_instruction_page(const ScreenContext& context);
    Status run_systems(const Picture& picture, const view::WindowFrame& window);
    [[nodiscard]] bool in_room() const { return room_ && room_->plays_in_room; }
    // Pauses a lesson that nobody can see: `seen` is false.
    void pause_unseen(bool seen, bool immersive);
    void follow_headset(const view::ImmersiveFrame* immersive);
    void perform_in_room(Action action);
    void follow_placement(const view::ImmersiveFrame& immersive, std::span<const platform::InputEvent> events,
                          double seconds);
    [[nodiscard]] xr::Hands gloved_hands(xr::Hands hands) const;
    std::optional<Pose> registered_workpiece(const view::ImmersiveFrame& immersive);
    void place_in_room(const view::ImmersiveFrame& immersive);
    void start_registered_arm(const view::ImmersiveFrame& immersive);
    void follow_touch_check(std::span<const platform::InputEvent> events, double seconds,
                            bool enter_key_answers);
    void end_touch_check();
    [[nodiscard]] bool awaits_touch() const {
        return active_ && room_ && room_->touch && waits_for_touch(*room_->touch);
    }
    void show_touch();
    [[nodiscard]] RoomInput room_input(const view::ImmersiveFrame& immersive) const;
    [[nodiscard]] std::optional<xr::Side> working_hand() const;
    void follow_room(const view::WindowFrame& window, std::vector<platform::InputEvent>& events);
    [[nodiscard]] Pose scene_in_room() const;
    Status draw_pictures(gpu::FrameContext& frame, const view::WindowFrame& window);
    Status enlarge_scene(gpu::FrameContext& frame, VkExtent2D size);
    Status draw_interface(gpu::FrameContext& frame, const render::ImageLayer& picture);
    Status draw_panel(gpu::FrameContext& frame);
    Status draw_hands(render::Scene& scene, const view::ImmersiveFrame& immersive);
    Status draw_room(gpu::FrameContext& frame, const view::ImmersiveFrame& immersive);
    void draw_screen(const ScreenContext& context);
    void press_start();
    void show_page(MenuPage page);
    void perform(ScreenAction action);
    void select_trainee();
    void load_trainee();
    Status select_language(const std::string& code);
    void apply_preferences();
    void save_preferences();
    void log(const std::string& line) const;

    AppOptions options_;
    Preferences preferences_;
    std::vector<words::Words> languages_;
    words::Words words_;
    std::optional<std::string> selected_language_;  // applied in the next frame
    lesson::ControlNames controls_;                 // of the current hand, keys and language

    ShownScreen screen_ = ShownScreen::menu;
    Menu menu_;
    std::optional<SettingsScreen> settings_;  // while it is shown
    std::optional<StudyScreen> study_;        // while it leads a participant through a study
    bool interrupted_ = false;                // the program ends
    LessonDisplay display_;                   // that shows the study; the window if its plan names none
    std::optional<LessonDisplay> wanted_display_;
    std::vector<DrawnWidget> drawn_widgets_;  // in the last frame
    ui::UiInput input_;
    bool closed_ = false, full_screen_requested_ = false;
    bool start_requested_ = false, end_requested_ = false;
    bool tour_requested_ = false;  // the next lesson is the tour

    std::unique_ptr<LessonStartThread> start_thread_;  // in ShownScreen::starting
    std::unique_ptr<LessonStartThread> given_up_;      // an earlier one, which may still hold the devices
    ArmScreen arm_screen_;
    std::optional<LessonContext> context_;  // of the last lesson that started
    std::filesystem::path folder_;          // of its session
    std::optional<ActiveLesson> active_;    // also while its result is shown
    std::optional<Tour> tour_;              // if that lesson is the tour
    std::optional<session::LessonOutcome> outcome_;
    std::map<std::string_view, std::vector<float>> system_times_;  // ms per frame of the lesson

    std::optional<PointingRay> wand_ray_;  // of this frame, on walls
    std::optional<RoomState> room_;        // none until a headset or walls are first used
    // A headset tracks the hand of the lesson, but is lost, was taken off, or does not show pictures yet.
    struct MissingHeadset {
        bool noticed = false;      // it was missing in the last frame
        bool paused = false;       // the lesson was paused for that reason
        bool mouse_plays = false;  // the user goes on without it
    };
    MissingHeadset missing_headset_;

    std::optional<LessonSender> sender_;  // none if no other process shows walls
    std::uint32_t lesson_number_ = 0;     // counts the lessons of this program
    SharedModels shared_models_;          // of the lesson

    std::unique_ptr<GpuResources> gpu_;
    AssemblyPictures pictures_;
};

}  // namespace bolt::trainer

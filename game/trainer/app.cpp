#include "game/trainer/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>

#include "game/lesson/step_requirements.hpp"
#include "game/sound/event_detection.hpp"
#include "game/trainer/hud.hpp"
#include "game/trainer/room_bar.hpp"
#include "game/view/resolution.hpp"

namespace bolt::trainer {

namespace {

constexpr double max_frame_time = 0.25;  // s; a slower frame delays the lesson instead of making it jump
constexpr float text_size = 15.0F;       // points
constexpr double timing_duration = 1.5;  // s, of the servo in the check of the computer

std::string describe_event(const content::Assembly& assembly, const lesson::LessonEvent& event, double dt) {
    const std::string joint = event.joint >= 0
                                  ? assembly.joints[static_cast<std::size_t>(event.joint)].design.id + " "
                                  : std::string();
    return fmt::format("{:7.2f} s  {}{} {}", static_cast<double>(event.tick) * dt, joint,
                       lesson::name(event.kind), event.text);
}

// Adds the characters of the texts in all languages, and the symbols that stand in the code.
void add_language_characters(ui::Ui& ui, std::span<const words::Words> languages) {
    for (const words::Words& language : languages) {
        ui.add_characters(language.name);
        for (const std::string& text : language.texts) ui.add_characters(text);
    }
    for (const std::string_view sign : {"▼", "●", "▲", "◆", "▶", "✓", "✗", "–", "‹", "›"})
        ui.add_characters(sign);
}

}  // namespace

App::App(AppOptions options, std::optional<StudyRun> study) : options_(std::move(options)) {
    if (options_.menu) {
        menu_.assemblies = list_assemblies();
        menu_.devices = device_options(options_.choice.equipment);
        menu_.folders = {options_.out, options_.folder_per_lesson, options_.settings_folder, {}};
        if (const auto data = user_data_folder()) menu_.folders.assemblies = *data / "assemblies";
        menu_.first_start = options_.first_start;
    }
    if (study) {
        study_.emplace(std::move(*study));
        options_.menu = false;
        screen_ = ShownScreen::study;
        const study::Progress& progress = study_->participation().progress();
        options_.choice.trainee = progress.person;
        if (!progress.language.empty()) options_.choice.language = progress.language;
    }
    start_requested_ = !options_.menu && !study_;
    preferences_.folder = options_.settings_folder;
    preferences_.file = options_.settings_file;
    preferences_.known = settings_vocabulary(words::languages(words::words_folder()));
    load_trainee();
    if (options_.choice.language.empty()) options_.choice.language = preferences_.settings.language;
}

App::~App() { save_preferences(); }

void App::log(const std::string& line) const {
    if (options_.log) options_.log(line);
}

Status App::start(view::GpuContext& gpu_context) {
    if (languages_.empty()) {
        const std::vector<std::string> codes = words::languages(words::words_folder());
        for (const std::string& code : codes) {
            words::LoadedWords loaded = words::load_words(words::words_folder(), code);
            if (!loaded.ok()) return fail(loaded.errors.front());
            languages_.push_back(std::move(loaded.words));
        }
        const std::string& requested = options_.choice.language;
        BOLT_TRY(select_language(requested.empty() ? words::language_of_desktop(codes) : requested));
    }
    gpu_ = std::make_unique<GpuResources>();
    gpu_->context = &gpu_context;
    BOLT_TRY_ASSIGN(auto ui, ui::Ui::create(*gpu_context.device, {text_size}));
    gpu_->ui = std::move(ui);
    add_language_characters(*gpu_->ui, languages_);
    add_constant_characters(*gpu_->ui, menu_);
    if (study_) gpu_->ui->add_characters(study_->texts());
    BOLT_TRY_ASSIGN(auto fonts, text::load_fonts());
    gpu_->fonts.emplace(std::move(fonts));
    return active_ ? upload_models() : Status{};
}

void App::release() {
    if (gpu_ && gpu_->context->device) (void)gpu_->context->device->idle();
    if (active_) {
        active_->scene = {};
        scene::destroy_drawables(active_->workplace.world);
    }
    pictures_.release();
    if (sender_) sender_->panel.release();
    gpu_.reset();
}

Status App::frame_while_hidden() {
    if (!active_ || !active_->station) return {};
    active_->station->controls.pause = true;
    active_->station->link->set_controls(active_->station->controls);
    return {};
}

// Does what the first button of the menu does, or the button "again" of the result.
void App::press_start() {
    if (screen_ == ShownScreen::menu) tour_requested_ = menu_.first_start;
    start_requested_ = true;
}

void App::show_page(MenuPage page) {
    menu_.page = page;
    if (page != MenuPage::computer) return;
    const gpu::Device& device = *gpu_->context->device;
    computer::FactsRequest request;
    request.gpu =
        computer::GpuFacts{device.name(), device.properties().deviceType == VK_PHYSICAL_DEVICE_TYPE_CPU};
    request.sessions = options_.out;
    request.assembly = lesson_choice().assembly;
    request.seconds = timing_duration;
    menu_.check.start(options_.gather_facts, request);
}

void App::perform(ScreenAction action) {
    switch (action) {
        case ScreenAction::none:
            return;
        case ScreenAction::start_lesson:
        case ScreenAction::start_tour:
            if (screen_ == ShownScreen::menu) tour_requested_ = action == ScreenAction::start_tour;
            start_requested_ = true;
            return;
        case ScreenAction::pause:
            active_->clock.paused = true;
            return;
        case ScreenAction::resume:
            active_->clock.paused = false;
            return;
        case ScreenAction::undo_step:
        case ScreenAction::restart_step:
            request_undo(active_->undo, active_->session->lesson(),
                         action == ScreenAction::undo_step ? 1 : 0);
            active_->clock.paused = false;
            return;
        case ScreenAction::end_lesson:
            active_->clock.paused = false;
            end_requested_ = true;
            return;
        case ScreenAction::show_menu:
            screen_ = study_ ? ShownScreen::study : ShownScreen::menu;
            return;
        case ScreenAction::open_settings:
            select_trainee();
            settings_.emplace();
            return;
        case ScreenAction::close_settings:
            settings_.reset();
            save_preferences();
            return;
        case ScreenAction::show_computer:
            return show_page(MenuPage::computer);
        case ScreenAction::show_files:
            return show_page(MenuPage::files);
        case ScreenAction::close_page:
            return show_page(MenuPage::choices);
        case ScreenAction::permit_move:
            if (start_thread_) start_thread_->permit_move();
            if (active_ && active_->station) active_->station->link->permit_move();
            return;
        case ScreenAction::cancel_start:
            return cancel_start();
        case ScreenAction::end_touch_check:
            return end_touch_check();
        case ScreenAction::place_again:
            return perform_in_room(Action::place_again);
        case ScreenAction::turn_left:
            return perform_in_room(Action::turn_left);
        case ScreenAction::turn_right:
            return perform_in_room(Action::turn_right);
        case ScreenAction::raise:
            return perform_in_room(Action::raise);
        case ScreenAction::lower:
            return perform_in_room(Action::lower);
        case ScreenAction::second_wrench:
            return move_second_wrench(*active_);
        case ScreenAction::select_trainee:
            return select_trainee();
        case ScreenAction::change_display:
            return request_display();
        case ScreenAction::quit:
            closed_ = true;
            return;
    }
}

// Runs the systems of a frame. They also run while the result is shown, so that the picture stays alive.
Status App::run_systems(const Picture& picture, const view::WindowFrame& window) {
    ActiveLesson& active = *active_;
    const bool in_lesson = screen_ == ShownScreen::lesson;
    if (active.station)
        active.station->keyboard.handle_events(in_lesson ? picture.events
                                                         : std::span<const platform::InputEvent>());
    // The menu has a text field, and the settings bind keys. In a room the pointer is the panel's.
    const bool has_keys = screen_ != ShownScreen::menu && screen_ != ShownScreen::study && !settings_;
    const InputFocus focus{has_keys && !in_room() && !gpu_->ui->wants_pointer(), has_keys};
    const double shown = std::min(window.seconds, max_frame_time);
    LessonFrame frame{active,
                      words_,
                      shown,
                      window.seconds - shown,
                      glm::dvec2(picture.size.width, picture.size.height),
                      apply_events(active.input, picture.events, focus),
                      &*gpu_->fonts,
                      {},
                      {}};
    if (in_room()) frame.room = room_input(*window.immersive);
    const bool waits = (active.station && active.station->waits_for_arm) || (room_ && room_->touch);
    if (frame.input.triggered(Action::pause) && in_lesson && !waits)
        active.clock.paused = !active.clock.paused;
    full_screen_requested_ = full_screen_requested_ || frame.input.triggered(Action::full_screen);
    const bool had_wrench = hand_of(active).wrench;
    const auto timed = [&](std::string_view system, const auto& run) {
        const auto begin = std::chrono::steady_clock::now();
        run();
        system_times_[system].push_back(
            std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - begin).count());
    };
    timed("pointer", [&] { handle_input(active.workplace.world, frame); });
    ecs::run(frame_systems, active.workplace.world, frame, timed);
    if (in_lesson &&
        trainer::update(active.guidance.instruction, active.session->lesson(), active.clock.paused))
        begin_instruction();
    if (tour_ && in_lesson) trainer::update(*tour_, frame);
    if (awaits_touch()) show_touch();

    const double dt = active.session->setup().dt;
    if (hand_of(active).wrench != had_wrench)
        log(fmt::format("{:7.2f} s  the wrench is {}", active.session->time(),
                        hand_of(active).wrench ? "in the hand" : "laid down"));
    for (const lesson::LessonEvent& event : active.events) log(describe_event(context_->assembly, event, dt));
    active.events.clear();
    if (active.station && std::exchange(active.station->logged_fault, active.station->wrist_fault) !=
                              active.station->wrist_fault)
        log(active.station->wrist_fault.empty() ? "glove: the wrist is tracked"
                                                : active.station->wrist_fault);
    if (active.sound.live)
        if (const auto news = active.sound.live->status_change()) log(*news);
    BOLT_TRY(frame.status);
    return active.clock.finished && in_lesson ? end_lesson() : Status{};
}

// Draws the screen over the picture, and performs what the user selects on it.
void App::draw_screen(const ScreenContext& context) {
    const bool in_lesson = screen_ == ShownScreen::lesson;
    const HudText texts{&words_, &controls_};
    if (in_lesson) draw_hud(*active_, texts, context.size, context.scale);
    if (in_lesson && tour_) draw_tour(*tour_, *active_, texts, context.size, context.scale);
    if (settings_) {
        const ScreenAction action = settings_->draw(
            context, preferences_, {active_ && in_lesson, study_.has_value(), room_ && room_->has_display});
        apply_preferences();
        perform(action);
    } else if (start_thread_ || arm_screen_.needs.any()) {
        perform(draw_arm(context, arm_screen_));
    } else if (in_lesson && room_ && room_->touch) {
        perform(draw_touch_check(context, *room_->touch));
    } else if (shows_instruction()) {
        perform(draw_instruction_page(context));
    } else if (in_lesson && active_->clock.paused) {
        const bool lost = missing_headset_.noticed && active_->station && active_->station->tracked;
        perform(draw_pause(context, preferences_, active_->session->lesson().mode,
                           {lost, room_ && room_->has_display}));
    } else if (in_lesson && in_room()) {
        perform(draw_room_bar(context, {controls_text(room_->controller), !room_->arm,
                                        lesson::needs_second_wrench(active_->session->assembly())}));
    } else if (screen_ == ShownScreen::menu) {
        MenuPictures pictures;
        for (const AssemblyEntry& entry : menu_.assemblies)
            if (const auto thumbnail = pictures_.thumbnail(entry.name))
                pictures.thumbnails.emplace(entry.name, gpu_->ui->picture(*thumbnail));
        perform(draw_menu(context, menu_, pictures, options_.choice, preferences_));
    } else if (screen_ == ShownScreen::result) {
        perform(draw_result(context, context_->assembly, outcome_->result,
                            {options_.menu, tour_.has_value(), study_.has_value()}));
    } else if (screen_ == ShownScreen::study) {
        perform(study_->draw(context, display_));
    }
}

Status App::draw_interface(gpu::FrameContext& frame, const render::ImageLayer& shown) {
    render::Renderer& renderer = *gpu_->context->renderer;
    ui::Ui& ui = *gpu_->ui;
    const glm::dvec2 extent(input_.size);
    ui.add_characters(input_.text);
    ui.add_characters(arm_screen_.needs.preparation.instruction);
    if (active_ && active_->guidance.instruction.shown != nullptr)
        for (const auto& [language, text] : active_->guidance.instruction.shown->text)
            ui.add_characters(text);
    if (screen_ == ShownScreen::menu) add_changing_characters(ui, words_, menu_, options_.choice);
    BOLT_TRY(ui.begin(frame, input_));
    if (const auto picture = pictures_.picture(renderer); picture && !active_)
        ImGui::GetBackgroundDrawList()->AddImage(ui.picture(*picture), {0.0F, 0.0F},
                                                 {input_.size.x, input_.size.y});
    drawn_widgets_.clear();
    draw_screen(
        {words_, languages_, extent, input_.scale, ui.heading_font(), drawn_widgets_, selected_language_});
    if (active_ && screen_ == ShownScreen::lesson)
        BOLT_TRY(draw_close_up({renderer, frame, ui}, *active_, extent, input_.scale));
    if (active_) active_->view.occupied = occupied_areas();
    if (in_room() && room_->pointer.on_panel) {
        const glm::vec2 at(room_->pointer.at);
        const float radius = (room_->pointer.pressed ? 5.0F : 8.0F) * input_.scale;
        ImGui::GetForegroundDrawList()->AddCircleFilled({at.x, at.y}, radius, IM_COL32(255, 255, 255, 210));
    }
    const render::Overlay overlay = ui.end();
    return renderer.draw_over(frame, overlay, shown);
}

// Draws the lesson, or the pictures of the menu.
Status App::draw_pictures(gpu::FrameContext& frame, const view::WindowFrame& window) {
    static const render::Scene empty_scene;
    render::Renderer& renderer = *gpu_->context->renderer;
    gpu_->shows_enlarged = active_ && window.resolution < 1.0F;
    if (gpu_->shows_enlarged) {
        const VkExtent2D size = view::scaled(window.resolution, window.size);
        const render::Eye eye = projection_of(*active_, glm::dvec2(size.width, size.height)).eye;
        BOLT_TRY(renderer.render(frame, view::with_fewer_pixels(active_->scene, window.resolution),
                                 std::span(&eye, 1), size));
        return enlarge_scene(frame, window.size);
    }
    if (gpu_->enlarged) {
        frame.retire(gpu_->enlarged->release());
        gpu_->enlarged.reset();
    }
    const glm::dvec2 extent(window.size.width, window.size.height);
    const render::Eye eye = active_ ? projection_of(*active_, extent).eye : render::Eye{};
    BOLT_TRY(renderer.render(frame, active_ ? active_->scene : empty_scene, std::span(&eye, 1), window.size));
    if (active_) return {};
    return pictures_.draw(*gpu_->context->device, renderer, frame,
                          picture_request(menu_, options_.choice.assembly, window.size, window.scale));
}

// Enlarges the scene to all pixels of the window, over which the interface is then drawn.
Status App::enlarge_scene(gpu::FrameContext& frame, VkExtent2D size) {
    std::optional<render::PanelPicture>& to = gpu_->enlarged;
    if (to && (to->extent().width != size.width || to->extent().height != size.height)) {
        frame.retire(to->release());
        to.reset();
    }
    if (!to) {
        BOLT_TRY_ASSIGN(auto picture, render::PanelPicture::create(*gpu_->context->device, size));
        to.emplace(std::move(picture));
    }
    to->clear(frame);
    render::Renderer& renderer = *gpu_->context->renderer;
    render::Overlay overlay;
    render::add_picture(overlay, {glm::vec2(0.0F), glm::vec2(size.width, size.height)}, renderer.picture(0));
    return renderer.draw_over(frame, overlay, to->layer());
}

Status App::update(const view::WindowFrame& window) {
    std::vector<platform::InputEvent> events(window.events.begin(), window.events.end());
    follow_room(window, events);
    follow_study_display();
    const Picture picture{events, in_room() ? panel_extent : window.size,
                          in_room() ? panel_scale : window.scale};
    const glm::dvec2 extent(picture.size.width, picture.size.height);
    if (const auto code = std::exchange(selected_language_, std::nullopt)) BOLT_TRY(select_language(*code));
    const auto aspect = static_cast<float>(extent.x / extent.y);
    if (std::exchange(start_requested_, false) && !start_thread_) {
        menu_.start_error.reset();
        BOLT_TRY(report_start(begin_lesson(aspect)));
    }
    if (std::optional<Result<StartedLesson>> started = start_thread_ ? start_thread_->take() : std::nullopt) {
        start_thread_.reset();
        BOLT_TRY(report_start(enter_lesson(std::move(*started), aspect)));
    }
    if (window.immersive != nullptr) place_in_room(*window.immersive);  // a lesson that has just begun
    const bool left = screen_ == ShownScreen::menu || screen_ == ShownScreen::study;
    if (left && active_) BOLT_TRY(close_lesson());
    const bool chooses = screen_ == ShownScreen::menu || screen_ == ShownScreen::result;
    const bool can_start = chooses && !study_ && !settings_ && menu_.page == MenuPage::choices;
    // While the arrow keys have marked a control, Enter presses it. While a name is typed, Enter ends it.
    const bool enter_starts = !gpu_->ui->navigates_by_keys() && !gpu_->ui->edits_text();
    bool close_settings = false;
    update_ui_input(
        input_, settings_ ? settings_->take_keys(events, words_, preferences_.keys, close_settings) : events);
    input_.size = glm::vec2(extent);
    input_.scale = picture.scale;
    input_.seconds = window.seconds;
    if (active_) BOLT_TRY(run_systems(picture, window));
    follow_arm(events, window.seconds, enter_starts);
    follow_touch_check(events, window.seconds, enter_starts);
    if (close_settings) perform(ScreenAction::close_settings);
    for (const platform::InputEvent& event : events) {
        closed_ = closed_ || std::holds_alternative<platform::CloseEvent>(event);
        const bool by_key = std::holds_alternative<platform::KeyEvent>(event);
        const bool confirms = is_confirmation(event) && (enter_starts || !by_key);
        if (can_start && confirms) press_start();
        if (confirms && shows_instruction()) perform(ScreenAction::resume);
        if (screen_ == ShownScreen::menu && is_back(event)) show_page(MenuPage::choices);
    }
    return {};
}

// Draws the interface into the panel. Call it before drawing the eyes, which see the panel.
Status App::draw_panel(gpu::FrameContext& frame) {
    render::Renderer& renderer = *gpu_->context->renderer;
    if (!gpu_->panel) {
        BOLT_TRY_ASSIGN(auto panel, render::PanelPicture::create(*gpu_->context->device, panel_extent));
        gpu_->panel.emplace(std::move(panel));
    }
    if (!active_)
        BOLT_TRY(pictures_.draw(*gpu_->context->device, renderer, frame,
                                picture_request(menu_, options_.choice.assembly, panel_extent, panel_scale)));
    gpu_->panel->clear(frame);
    return draw_interface(frame, gpu_->panel->layer());
}

Status App::draw(gpu::FrameContext& frame, const view::WindowFrame& window) {
    if (in_room()) {
        BOLT_TRY(draw_panel(frame));
        if (sender_) BOLT_TRY(sender_->panel.record(*gpu_->context->device, frame, *gpu_->panel));
    } else if (window.size.width > 0 && window.size.height > 0) {
        BOLT_TRY(draw_pictures(frame, window));
        BOLT_TRY(draw_interface(frame, window_picture(*gpu_->context->renderer)));
    }
    if (window.immersive != nullptr) BOLT_TRY(draw_room(frame, *window.immersive));
    return std::exchange(end_requested_, false) ? end_lesson() : Status{};
}

}  // namespace bolt::trainer

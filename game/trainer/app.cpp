#include "game/trainer/app.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <ctime>

#include "game/sound/event_detection.hpp"
#include "game/trainer/hud.hpp"

namespace bolt::trainer {

namespace {

constexpr double longest_frame = 0.25;   // s; a slower frame delays the lesson instead of making it jump
constexpr float text_size = 15.0F;       // points
constexpr double timing_duration = 1.5;  // s, of the servo in the check of the computer

// Names what the user presses or moves for each control of the current hand.
lesson::ControlNames control_names(const words::Words& words, const KeyMap& keys, const Equipment& equipment,
                                   const StationClient* station) {
    const std::string tool = key_name(keys, Action::tool);
    if (station == nullptr) return lesson::mouse_controls(words, tool);
    if (station->dragged) return lesson::drag_controls(words, tool);
    const station::Layout& layout = station->link->layout();
    const std::uint32_t held = layout.mover_buttons.dead_man;
    const bool keyboard = equipment.devices.empty();
    const std::string closes =
        keyboard || held == 0
            ? std::string(platform::name(platform::Key::space))
            : words::format_text(
                  words, "control.device.button",
                  {{"number", words::Number{static_cast<double>(std::countr_zero(held) + 1), 0}}});
    const bool feels = layout.mover && station::renders_force(*layout.mover);
    lesson::ControlNames names = keyboard ? lesson::keyboard_controls(words, closes, tool)
                                 : feels  ? lesson::device_controls(words, closes, tool)
                                          : lesson::puck_controls(words, closes, tool);
    const bool fingers = station->link->hand() != nullptr || (layout.mover && layout.mover->senses_gripper);
    return fingers ? lesson::glove_controls(words, std::move(names)) : names;
}

// Adds every character that the interface may draw to its font.
void add_characters(ui::Ui& ui, std::span<const words::Words> languages,
                    std::span<const AssemblyEntry> assemblies) {
    for (const words::Words& language : languages) {
        ui.add_characters(language.name);
        for (const std::string& text : language.texts) ui.add_characters(text);
    }
    for (const std::string_view sign : {"▼", "●", "▲", "◆", "▶", "✓", "✗", "–", "‹", "›"})
        ui.add_characters(sign);
    for (const AssemblyEntry& entry : assemblies) {
        for (const auto& [code, title] : entry.title) ui.add_characters(title);
        for (const auto& [code, text] : entry.instructions) ui.add_characters(text);
        if (entry.error) ui.add_characters(entry.error->message());
        for (const content::AssemblyVariant& variant : entry.variants)
            for (const auto& [code, title] : variant.title) ui.add_characters(title);
        for (const content::Tool& tool : entry.tools)
            for (const auto& [code, title] : tool.title) ui.add_characters(title);
    }
}

// Adds the characters of the menu's texts that are not known at the start: names that the trainee types or
// that devices have, and the reasons in findings and errors.
void add_characters(ui::Ui& ui, const words::Words& words, const Menu& menu, const LessonChoice& choice) {
    ui.add_characters(choice.trainee);
    for (const DeviceOption& option : menu.devices) ui.add_characters(option.name);
    for (const computer::Finding& finding : menu.check.findings())
        ui.add_characters(words::format_text(words, finding.text, finding.arguments));
    if (menu.start_error) ui.add_characters(menu.start_error->message());
}

// One line with the median and 99th percentile of each system; sorts the times.
std::string describe_times(std::map<std::string_view, std::vector<float>>& times_of) {
    std::string line = "a frame's systems, median and p99 (ms):";
    for (auto& [system, times] : times_of) {
        std::sort(times.begin(), times.end());
        line +=
            fmt::format(" {} {:.2f} {:.2f}", system, times[times.size() / 2], times[times.size() * 99 / 100]);
    }
    return line;
}

std::string describe_event(const content::Assembly& assembly, const lesson::LessonEvent& event, double dt) {
    const std::string joint = event.joint >= 0
                                  ? assembly.joints[static_cast<std::size_t>(event.joint)].design.id + " "
                                  : std::string();
    return fmt::format("{:7.2f} s  {}{} {}", static_cast<double>(event.tick) * dt, joint,
                       lesson::name(event.kind), event.text);
}

// The folder of the next session, which is created: `out` itself, or "2026-11-25_15-40-12_zq350" in it.
Result<std::filesystem::path> lesson_folder(const AppOptions& options, const LessonChoice& choice) {
    std::filesystem::path folder = options.out;
    if (options.folder_per_lesson) {
        const std::string assembly = std::filesystem::path(choice.assembly).filename().string();
        const std::string name =
            fmt::format("{:%Y-%m-%d_%H-%M-%S}_{}", fmt::localtime(std::time(nullptr)), assembly);
        folder /= name;
        std::error_code ignored;
        for (int i = 2; std::filesystem::exists(folder, ignored); ++i)
            folder = options.out / fmt::format("{}_{}", name, i);
    }
    std::error_code problem;
    std::filesystem::create_directories(folder, problem);
    if (!problem) return folder;
    Error error;
    error.file = folder.string();
    error.what = "this folder cannot be created: " + problem.message();
    error.expected = "a folder that you may write to";
    return fail(error);
}

UserFolders folders_of(const AppOptions& options) {
    UserFolders folders{options.out, options.folder_per_lesson, options.settings_folder, {}};
    if (const auto data = user_data_folder()) folders.assemblies = *data / "assemblies";
    return folders;
}

}  // namespace

struct App::GpuResources {
    view::GpuContext* context = nullptr;
    std::unique_ptr<ui::Ui> ui;
    std::unique_ptr<scene::GpuLessonModels> models;
    std::optional<text::Fonts> fonts;
};

App::App(AppOptions options) : options_(std::move(options)) {
    if (options_.menu) {
        menu_.assemblies = list_assemblies();
        menu_.devices = device_options(options_.choice.equipment);
        menu_.folders = folders_of(options_);
        menu_.first_start = options_.first_start;
    }
    start_requested_ = !options_.menu;
    preferences_.folder = options_.settings_folder;
    preferences_.file = options_.settings_file;
    preferences_.known = settings_vocabulary(words::languages(words::words_folder()));
    load_preferences(preferences_, options_.choice.trainee);
    if (preferences_.trouble != Preferences::Trouble::none) log(preferences_.trouble_message);
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
    add_characters(*gpu_->ui, languages_, menu_.assemblies);
    for (const auto& folder : {menu_.folders.sessions, menu_.folders.settings, menu_.folders.assemblies})
        gpu_->ui->add_characters(folder.string());
    BOLT_TRY_ASSIGN(auto fonts, text::load_fonts());
    gpu_->fonts.emplace(std::move(fonts));
    return active_ ? upload_lesson() : Status{};
}

void App::release() {
    if (gpu_ && gpu_->context->device) (void)gpu_->context->device->idle();
    if (active_) {
        active_->scene = {};
        scene::destroy_drawables(active_->workplace.world);
    }
    pictures_.release();
    gpu_.reset();
}

// Uploads the models of the lesson and makes the entities that refer to them.
Status App::upload_lesson() {
    ActiveLesson& active = *active_;
    BOLT_TRY(gpu_->context->device->idle());
    BOLT_TRY_ASSIGN(auto models, scene::upload(*gpu_->context->device, context_->models));
    gpu_->models = std::move(models);
    BOLT_TRY_ASSIGN(auto workplace,
                    scene::make_workplace(std::move(active.workplace.world), context_->models, *gpu_->models,
                                          active.session->assembly(), active.session->setup()));
    active.workplace = std::move(workplace);
    active.scene = scene::make_lit_scene(active.workplace, gpu_->models->light);
    return {};
}

// The choice of the menu; for the tour its nut, guided, with the same devices.
LessonChoice App::lesson_choice() const {
    LessonChoice choice = options_.choice;
    if (options_.menu) choice.assembly = content::assembly_folder(choice.assembly).string();
    if (!tour_requested_) return choice;
    choice.assembly = content::assembly_folder(tour_assembly).string();
    choice.variant.clear();
    choice.tool.clear();
    choice.mode = lesson::Mode::guided;
    choice.task = lesson::Task::tighten;
    return choice;
}

Status App::begin_lesson(float aspect) {
    select_trainee();
    save_preferences();
    const LessonChoice choice = lesson_choice();
    if (active_ && options_.choice.equipment.needs_station())
        active_->station.reset();  // it holds the devices
    BOLT_TRY_ASSIGN(folder_, lesson_folder(options_, choice));
    LessonStart start{choice, preferences_.settings, options_.lesson, folder_, options_.start_station};
    if (!choice.equipment.has_hardware()) return enter_lesson(start_lesson(start), aspect);
    if (active_) BOLT_TRY(close_lesson());
    starter_ = std::make_unique<LessonStarter>(std::move(start), std::move(given_up_));
    arm_screen_ = {};
    screen_ = ShownScreen::starting;
    return {};
}

Status App::enter_lesson(Result<StartedLesson> started, float aspect) {
    if (!started) {
        std::error_code ignored;
        if (options_.folder_per_lesson) std::filesystem::remove(folder_, ignored);  // if it is still empty
        return fail(started.error());
    }
    if (active_) {
        BOLT_TRY(gpu_->context->device->idle());
        active_.reset();
    }
    if (options_.on_start) options_.on_start(folder_);
    context_ = std::move(started->context);
    active_.emplace(std::move(started->active));
    ActiveLesson& active = *active_;
    for (const std::string& missing : context_->models.missing) log("not drawn: " + missing);
    world::add_haptics(active.workplace.world, active.session->state());
    BOLT_TRY(upload_lesson());
    place_trainee(active, *context_, aspect);
    active.sound.detector.surfaces =
        sound::struck_surfaces(active.session->assembly(), active.session->obstacle_names());
    if (options_.sound) {
        auto live = sound::LiveSound::start(active.session->setup(), active.sound.detector.surfaces);
        if (live)
            active.sound.live = std::make_unique<sound::LiveSound>(std::move(*live));
        else
            log(live.error().message());
    }
    apply_preferences();
    active.verdicts.assign(context_->assembly.joints.size(), lesson::Verdict::none);
    outcome_.reset();
    tour_ = tour_requested_ ? std::optional(Tour{}) : std::nullopt;
    screen_ = ShownScreen::lesson;
    menu_.first_start = false;
    log(fmt::format("lesson begun: {} {}, {}, law {}", context_->assembly.name, context_->assembly.variant,
                    lesson::name(context_->options.mode), joint::name(context_->options.law)));
    return {};
}

// An error of a start is shown in the menu if there is one.
Status App::report_start(Status begun) {
    if (begun) return {};
    if (begun.error().lost || !options_.menu) return begun;
    menu_.start_error = begun.error();
    screen_ = ShownScreen::menu;
    log(begun.error().message());
    return {};
}

void App::cancel_start() {
    if (!starter_) return;
    starter_->give_up();
    given_up_ = std::move(starter_);
    screen_ = ShownScreen::menu;
    closed_ = closed_ || !options_.menu;
}

// Shows what the arm needs, while a lesson starts and in a lesson, and takes the user's answer.
void App::follow_arm(std::span<const platform::InputEvent> events, double seconds, bool enter_answers) {
    StationClient* client = screen_ == ShownScreen::lesson && active_->station ? &*active_->station : nullptr;
    if (client != nullptr) pause_for_arm(*client, active_->clock);
    const device::ArmNeeds needs = starter_            ? starter_->needs()
                                   : client != nullptr ? client->needs
                                                       : device::ArmNeeds{};
    const std::string before = describe(arm_screen_.needs);
    arm_screen_.in_lesson = client != nullptr;
    update(arm_screen_, needs, settings_ ? 0.0 : seconds);  // the settings cover the question
    if (const std::string now = describe(needs); now != before && !now.empty()) log(now);
    if (!settings_) perform(action_of(arm_screen_, events, enter_answers));
}

// Releases the lesson whose result was shown, with the devices that its station holds.
Status App::close_lesson() {
    BOLT_TRY(gpu_->context->device->idle());
    active_.reset();
    gpu_->models.reset();
    return {};
}

Status App::end_lesson() {
    if (!active_ || screen_ != ShownScreen::lesson) return {};
    ActiveLesson& active = *active_;
    if (active.station)
        if (const servo::Timing* timing = active.station->link->stop())
            BOLT_TRY(active.session->record_timing(*timing));

    BOLT_TRY_ASSIGN(auto outcome, active.session->finish(active.workplace.world));
    outcome_ = std::move(outcome);
    active.clock.finished = true;
    for (std::size_t i = 0; i < active.verdicts.size(); ++i)
        active.verdicts[i] = view::verdict_of(outcome_->result.joints[i]);
    screen_ = ShownScreen::result;
    log(fmt::format("lesson ended: {}, score {:.0f}", outcome_->result.finished ? "finished" : "not finished",
                    outcome_->result.score));
    log(describe_times(system_times_));
    system_times_.clear();
    if (active.clock.lag > 1.0)
        log(fmt::format("drawing was too slow: the lesson lagged {:.0f} s behind real time",
                        active.clock.lag));
    if (options_.on_end)
        return options_.on_end(active.session->assembly(), context_->options, *outcome_, folder_);
    return {};
}

Status App::frame_while_hidden() {
    if (!active_ || !active_->station) return {};
    active_->station->controls.pause = true;
    active_->station->link->set_controls(active_->station->controls);
    return {};
}

Status App::select_language(const std::string& code) {
    words::LoadedWords loaded = words::load_words(words::words_folder(), code);
    if (!loaded.ok()) return fail(loaded.errors.front());
    words_ = std::move(loaded.words);
    options_.choice.language = code;
    apply_preferences();
    return {};
}

// Loads the settings of the trainee whose name was entered, after saving those of the previous one.
void App::select_trainee() {
    if (options_.choice.trainee == preferences_.trainee) return;
    save_preferences();
    load_preferences(preferences_, options_.choice.trainee);
    if (preferences_.trouble != Preferences::Trouble::none) log(preferences_.trouble_message);
    const std::string& language = preferences_.settings.language;
    if (!language.empty() && language != words_.language) selected_language_ = language;
    apply_preferences();
}

void App::save_preferences() {
    if (!trainer::save_preferences(preferences_)) log(preferences_.trouble_message);
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
    active.palette = view::palette_of(settings.palette);
    if (settings.captions != active.sound.captions.has_value())
        active.sound.captions = settings.captions ? std::optional(Captions{}) : std::nullopt;
}

// Starts what the first button of the menu, or the button "again" of the result, starts.
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
    menu_.check.start(options_.find_out, request);
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
            screen_ = ShownScreen::menu;
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
            if (starter_) starter_->permit_move();
            if (active_ && active_->station) active_->station->link->permit_move();
            return;
        case ScreenAction::cancel_start:
            return cancel_start();
        case ScreenAction::select_trainee:
            return select_trainee();
        case ScreenAction::quit:
            closed_ = true;
            return;
    }
}

// Runs the systems of a frame. They also run while the result is shown, so that the picture stays alive.
Status App::run_systems(std::span<const platform::InputEvent> events, const glm::dvec2& size,
                        double seconds) {
    ActiveLesson& active = *active_;
    const bool in_lesson = screen_ == ShownScreen::lesson;
    if (active.station)
        active.station->keyboard.handle_events(in_lesson ? events : std::span<const platform::InputEvent>());
    // The menu has a text field and the settings take keys for themselves.
    const bool has_keys = screen_ != ShownScreen::menu && !settings_;
    const InputFocus focus{has_keys && !gpu_->ui->wants_pointer(), has_keys};
    const double shown = std::min(seconds, longest_frame);
    Frame frame{active,          words_, shown,
                seconds - shown, size,   apply_events(active.input, events, focus),
                &*gpu_->fonts,   {}};
    const bool waits_for_arm = active.station && active.station->waits_for_arm;
    if (frame.input.triggered(Action::pause) && in_lesson && !waits_for_arm)
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
    if (tour_ && in_lesson) update(*tour_, frame);

    const double dt = active.session->setup().dt;
    if (hand_of(active).wrench != had_wrench)
        log(fmt::format("{:7.2f} s  the wrench is {}", active.session->time(),
                        hand_of(active).wrench ? "in the hand" : "laid down"));
    for (const lesson::LessonEvent& event : active.events) log(describe_event(context_->assembly, event, dt));
    active.events.clear();
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
        const ScreenAction action = settings_->draw(context, preferences_, active_ && in_lesson);
        apply_preferences();
        perform(action);
    } else if (starter_ || arm_screen_.needs.any()) {
        perform(draw_arm(context, arm_screen_));
    } else if (in_lesson && active_->clock.paused) {
        perform(draw_pause(context, preferences_, active_->session->lesson().mode));
    } else if (screen_ == ShownScreen::menu) {
        MenuPictures pictures;
        for (const AssemblyEntry& entry : menu_.assemblies)
            if (const auto thumbnail = pictures_.thumbnail(entry.name))
                pictures.thumbnails.emplace(entry.name, gpu_->ui->picture(*thumbnail));
        perform(draw_menu(context, menu_, pictures, options_.choice, preferences_));
    } else if (screen_ == ShownScreen::result) {
        perform(
            draw_result(context, context_->assembly, outcome_->result, {options_.menu, tour_.has_value()}));
    }
}

Status App::draw_interface(gpu::FrameContext& frame, VkExtent2D size) {
    render::Renderer& renderer = *gpu_->context->renderer;
    ui::Ui& ui = *gpu_->ui;
    const glm::dvec2 extent(size.width, size.height);
    ui.add_characters(input_.text);
    ui.add_characters(arm_screen_.needs.preparation.instruction);
    if (screen_ == ShownScreen::menu) add_characters(ui, words_, menu_, options_.choice);
    BOLT_TRY(ui.begin(frame, input_));
    if (const auto picture = pictures_.picture(renderer); picture && !active_)
        ImGui::GetBackgroundDrawList()->AddImage(ui.picture(*picture), {0.0F, 0.0F},
                                                 {input_.size.x, input_.size.y});
    buttons_.clear();
    draw_screen({words_, languages_, extent, input_.scale, ui.heading_font(), buttons_, selected_language_});
    if (active_ && screen_ == ShownScreen::lesson)
        BOLT_TRY(draw_close_up({renderer, frame, ui}, *active_, extent, input_.scale));
    if (active_) active_->view.occupied = occupied_areas();
    const render::Overlay overlay = ui.end();
    return renderer.draw_over(frame, overlay, renderer.picture(0));
}

// Draws the lesson, or the pictures of the menu.
Status App::draw_pictures(gpu::FrameContext& frame, VkExtent2D size, float scale) {
    static const render::Scene empty_scene;
    const glm::dvec2 extent(size.width, size.height);
    const render::Eye eye = active_ ? screen_of(*active_, extent).eye : render::Eye{};
    render::Renderer& renderer = *gpu_->context->renderer;
    BOLT_TRY(renderer.render(frame, active_ ? active_->scene : empty_scene, std::span(&eye, 1), size));
    if (active_) return {};
    return pictures_.draw(*gpu_->context->device, renderer, frame,
                          picture_request(menu_, options_.choice.assembly, size, scale));
}

Status App::frame(gpu::FrameContext& frame, std::span<const platform::InputEvent> events, VkExtent2D size,
                  float scale, double seconds) {
    const glm::dvec2 extent(size.width, size.height);
    if (const auto code = std::exchange(selected_language_, std::nullopt)) BOLT_TRY(select_language(*code));
    const auto aspect = static_cast<float>(extent.x / extent.y);
    if (std::exchange(start_requested_, false) && !starter_) {
        menu_.start_error.reset();
        BOLT_TRY(report_start(begin_lesson(aspect)));
    }
    if (std::optional<Result<StartedLesson>> started = starter_ ? starter_->take() : std::nullopt) {
        starter_.reset();
        BOLT_TRY(report_start(enter_lesson(std::move(*started), aspect)));
    }
    if (screen_ == ShownScreen::menu && active_) BOLT_TRY(close_lesson());
    const bool chooses = screen_ == ShownScreen::menu || screen_ == ShownScreen::result;
    const bool can_start = chooses && !settings_ && menu_.page == MenuPage::choices;
    // Enter presses the control that the keys have marked, if they have marked one, and ends the input of a
    // name.
    const bool enter_starts = !gpu_->ui->navigates_by_keys() && !gpu_->ui->edits_text();
    bool close_settings = false;
    update_ui_input(input_, settings_
                                ? settings_->take_keys(events, words_, preferences_.keys, close_settings)
                                : std::vector(events.begin(), events.end()));
    input_.size = glm::vec2(extent);
    input_.scale = scale;
    input_.seconds = seconds;
    if (active_) BOLT_TRY(run_systems(events, extent, seconds));
    follow_arm(events, seconds, enter_starts);
    if (close_settings) perform(ScreenAction::close_settings);
    for (const platform::InputEvent& event : events) {
        closed_ = closed_ || std::holds_alternative<platform::CloseEvent>(event);
        const bool by_key = std::holds_alternative<platform::KeyEvent>(event);
        if (can_start && starts(event) && (enter_starts || !by_key)) press_start();
        if (screen_ == ShownScreen::menu && leaves(event)) show_page(MenuPage::choices);
    }
    BOLT_TRY(draw_pictures(frame, size, scale));
    BOLT_TRY(draw_interface(frame, size));
    return std::exchange(end_requested_, false) ? end_lesson() : Status{};
}

}  // namespace bolt::trainer

#include "game/trainer/app.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdlib>

#include "content/format/assembly.hpp"
#include "game/scene/workplace.hpp"
#include "game/sound/event_detection.hpp"
#include "game/trainer/controls.hpp"
#include "game/trainer/hud.hpp"
#include "haptics/force/output_limits.hpp"

namespace bolt::trainer {

namespace {

constexpr double longest_frame = 0.25;  // s: nothing moves on by more from picture to picture

}  // namespace

struct App::OnGpu {
    view::Painter* painter = nullptr;
    std::unique_ptr<ui::Ui> ui;
    std::unique_ptr<scene::GpuShelf> shelf;
    std::optional<text::Fonts> fonts;
};

std::vector<Listed> list_assemblies() {
    std::vector<std::string> names;
    std::error_code problem;
    const auto folder = content::content_folder() / "assemblies";
    for (auto entry = std::filesystem::directory_iterator(folder, problem);
         !problem && entry != std::filesystem::directory_iterator(); entry.increment(problem))
        if (std::filesystem::exists(entry->path() / "assembly.json"))
            names.push_back(entry->path().filename().string());
    std::sort(names.begin(), names.end());
    std::vector<Listed> listed;
    for (const std::string& name : names) {
        const content::Loaded loaded = content::load_assembly(name);
        if (!loaded.ok() || loaded.assembly.models.model.empty()) continue;
        listed.push_back({name, loaded.assembly.variant, loaded.assembly.title, loaded.assembly.lesson,
                          loaded.assembly.variants, loaded.assembly.tools, loaded.assembly.law});
    }
    return listed;
}

joint::Law App::law_in_force(joint::Law of_assembly) const {
    if (options_.law) return *options_.law;
    for (const joint::Law law : {joint::Law::mechanistic, joint::Law::published})
        if (preferences_.settings.law == joint::name(law)) return law;
    return of_assembly;
}

// Another language from now on.
Status App::speak(const std::string& language) {
    words::Loaded loaded = words::load_words(words::words_folder(), language);
    if (!loaded.ok()) return fail(loaded.errors.front());
    words_ = std::move(loaded.words);
    options_.choice.language = language;
    apply_preferences();
    return {};
}

App::App(AppOptions options) : options_(std::move(options)) {
    if (options_.menu) {
        listed_ = list_assemblies();
        seats_ = seats();
    }
    start_wished_ = !options_.menu;
    preferences_.folder = options_.settings_folder;
    preferences_.file = options_.settings_file;
    preferences_.known = settings_vocabulary(words::languages(words::words_folder()));
    take(preferences_, options_.choice.trainee);
    if (preferences_.trouble != Preferences::Trouble::none) tell(preferences_.why);
    if (options_.choice.language.empty()) options_.choice.language = preferences_.settings.language;
}

App::~App() { keep_preferences(); }

void App::tell(const std::string& line) const {
    if (options_.tell) options_.tell(line);
}

Status App::start(view::Painter& painter) {
    if (languages_.empty()) {
        const std::vector<std::string> there = words::languages(words::words_folder());
        for (const std::string& code : there) {
            words::Loaded loaded = words::load_words(words::words_folder(), code);
            if (!loaded.ok()) return fail(loaded.errors.front());
            languages_.push_back(std::move(loaded.words));
        }
        const std::string& asked = options_.choice.language;
        if (Status spoken = speak(asked.empty() ? words::language_of_desktop(there) : asked); !spoken)
            return spoken;
    }
    on_ = std::make_unique<OnGpu>();
    on_->painter = &painter;
    Result<std::unique_ptr<ui::Ui>> made = ui::Ui::create(*painter.device, {15.0F});
    if (!made) return fail(made.error());
    on_->ui = std::move(*made);
    for (const words::Words& language : languages_) {
        on_->ui->need(language.name);
        for (const std::string& text : language.texts) on_->ui->need(text);
    }
    for (const std::string_view sign : {"▼", "●", "▲", "◆", "–"}) on_->ui->need(sign);
    for (const Listed& listed : listed_) {
        for (const auto& [code, title] : listed.title) on_->ui->need(title);
        for (const auto& [code, text] : listed.lesson) on_->ui->need(text);
        for (const content::Variant& variant : listed.variants)
            for (const auto& [code, title] : variant.title) on_->ui->need(title);
        for (const content::Tool& tool : listed.tools)
            for (const auto& [code, title] : tool.title) on_->ui->need(title);
    }
    Result<text::Fonts> fonts = text::load_fonts();
    if (!fonts) return fail(fonts.error());
    on_->fonts.emplace(std::move(*fonts));
    return playing_ ? place_on_gpu() : Status{};
}

void App::drop() {
    if (on_ && on_->painter->device) (void)on_->painter->device->idle();
    if (playing_) {
        playing_->scene = {};
        scene::remove_pictures(playing_->place.world);
    }
    backdrop_.drop();
    on_.reset();
}

// Models, and the entities that point to them.
Status App::place_on_gpu() {
    if (Status idle = on_->painter->device->idle(); !idle) return idle;
    Result<std::unique_ptr<scene::GpuShelf>> up = scene::upload(*on_->painter->device, *shelf_);
    if (!up) return fail(up.error());
    on_->shelf = std::move(*up);
    ActiveLesson& p = *playing_;
    Result<scene::Workplace> place = scene::make_workplace(std::move(p.place.world), *shelf_, *on_->shelf,
                                                           p.course->assembly(), p.course->setup());
    if (!place) return fail(place.error());
    p.place = std::move(*place);
    p.scene = scene::lit(p.place, on_->shelf->light);
    return {};
}

namespace {

// The wrench is in the first picture too: it is what one reaches for. Who sits sees it from lower.
view::Orbit first_view(const ActiveLesson& p, const view::Subject& machine, double handle_length,
                       float aspect, const scene::Worker& worker) {
    const view::Viewpoint first = machine.views.empty()
                                      ? view::framed(p.place.machine, view::usual_fov, aspect)
                                      : machine.views.front();
    render::BoundingBox all = p.place.machine;
    for (const double along : {-0.1, 1.2}) {
        const glm::vec3 end(hand_of(p).rest * Vec3(along * handle_length, 0.0, 0.0));
        all.low = glm::min(all.low, end);
        all.high = glm::max(all.high, end);
    }
    const view::Orbit orbit = view::framing(view::orbit_of(first), all, aspect);
    const auto eyes = scene::eye_level(p.place.machine, worker);
    return eyes ? view::framing(view::from_at_most(orbit, *eyes), all, aspect) : orbit;
}

// The hand in the glove, or the one that somebody says they work with.
hand::Side hand_at_work(const ActiveLesson& p, const content::Settings& wanted) {
    if (p.station)
        if (const station::DisplayedHand* gloved = p.station->bench->hand()) return gloved->side;
    return wanted.left_handed ? hand::Side::left : hand::Side::right;
}

}  // namespace

Status App::begin_lesson(float aspect) {
    meet_trainee();
    keep_preferences();
    const Choice& choice = options_.choice;
    const content::Settings& wanted = preferences_.settings;

    content::Loaded loaded = content::load_assembly(choice.assembly, choice.variant);
    if (!loaded.ok()) return fail(loaded.errors.front());
    if (Status chosen = content::choose_tool(loaded.assembly, choice.tool); !chosen) return chosen;
    course_ = options_.course;
    course_.law = law_in_force(loaded.assembly.law);
    // Devices, review and texts use the same targets as the lesson.
    assembly_ = lesson::under_law(std::move(loaded.assembly), course_.law);
    course_.mode = choice.mode;
    course_.task = choice.task;
    course_.operator_name = "person";
    course_.trainee = choice.trainee;
    course_.device = force::scaled(options_.course.device, wanted.force_scale);
    Result<session::Prepared> prepared = session::prepare(assembly_, course_);
    if (!prepared) return fail(prepared.error());
    ActiveLesson next;
    if (Status started = start_station(next, *prepared); !started) return started;
    const scene::Worker worker{hand_at_work(next, wanted), wanted.seated_height};
    course_.hand = worker.side == hand::Side::left ? "left" : "right";
    Result<scene::Shelf> shelf = scene::load_shelf(assembly_, worker.side);

    if (!shelf) return fail(shelf.error());
    for (const std::string& missing : shelf->missing) tell("left out: " + missing);
    Result<std::unique_ptr<session::Course>> course =
        session::Course::begin(std::move(*prepared), course_, options_.out / "session.boltwright");
    if (!course) return fail(course.error());
    next.course = std::move(*course);

    if (playing_) {
        if (Status idle = on_->painter->device->idle(); !idle) return idle;
        playing_.reset();
    }
    if (options_.begins) options_.begins();
    shelf_ = std::move(*shelf);
    playing_.emplace(std::move(next));
    ActiveLesson& p = *playing_;
    world::add_haptics(p.place.world, p.course->state());
    if (Status placed = place_on_gpu(); !placed) return placed;
    const servo::Setup& setup = p.course->setup();
    const servo::State& state = p.course->state();
    p.mouse = make_hand(scene::resting_place(p.place.machine, assembly_.wrench.head_thickness, worker.side),
                        worker.side);
    p.place.world.only<world::Hand>() = hand_of(p.mouse);

    take_place();
    p.sound.ear.still = sound::materials(p.course->assembly(), p.course->obstacle_names());
    if (options_.sound) {
        auto live = sound::Live::start(setup, p.sound.ear.still);
        if (live)
            p.sound.live = std::make_unique<sound::Live>(std::move(*live));
        else
            tell(live.error().message());
    }
    p.postures = scene::make_postures(state.tool_contact ? &state.tool_contact->wrench : nullptr,
                                      setup.wrench.handle_length, worker.side, scene::widest_nut(setup));
    p.shoulder = scene::shoulder_at(p.place.machine, worker);
    if (p.station) {
        const hand::Skeleton& open = p.postures.open;
        const Pose fingers = scene::towards(p.station->home, p.shoulder, 0.0);
        p.station->bare_wrist =
            inverse(p.station->home) * fingers * Pose{open.position[hand::wrist], open.rotation[hand::wrist]};
    }
    apply_preferences();
    p.view.close_up.wished = course_.mode == lesson::Mode::guided;
    p.verdicts.assign(assembly_.joints.size(), lesson::Verdict::none);
    p.view.camera.jump(first_view(p, shelf_->machine, setup.wrench.handle_length, aspect, worker));
    played_.reset();
    shows_ = Shows::lesson;
    tell(fmt::format("lesson begun: {} {}, {}, law {}", assembly_.name, assembly_.variant,
                     lesson::name(course_.mode), joint::name(course_.law)));
    return {};
}

// The station that the lesson is played at, if any: with a servo of its own that begins as the lesson's.
Status App::start_station(ActiveLesson& p, session::Prepared& prepared) {
    if (options_.choice.with.none()) return {};
    if (playing_) playing_->station.reset();  // that has the devices
    Equipment with = options_.choice.with;
    with.force_scale = preferences_.settings.force_scale;
    auto bench = options_.station(assembly_, course_, with, options_.choice.trainee);
    if (!bench) return fail(bench.error());
    p.station.emplace();
    p.station->bench = std::move(*bench);
    course_.device = p.station->bench->setup().limits;
    course_.servo = fmt::format("{:.0f} Hz", 1.0 / course_.dt);
    session::use_device(course_, prepared);
    return {};
}

// Hand and wrench before the machine.
void App::take_place() {
    ActiveLesson& p = *playing_;
    if (!p.station) return;
    StationClient& at = *p.station;
    at.rest = hand_of(p).rest;
    at.home = hand_of(p).pose;
}

// What is pressed or moved for what.
void App::name_controls() {
    const std::string tool = key_name(preferences_.keys, Action::tool);
    const StationClient* at = playing_ && playing_->station ? &*playing_->station : nullptr;
    if (at == nullptr) {
        controls_ = lesson::mouse_controls(words_, tool);
        return;
    }
    const std::uint32_t held = at->bench->layout().mover_buttons.held;
    const bool keys = options_.choice.with.devices.empty() || held == 0;
    const std::string closes =
        keys ? std::string(platform::name(platform::Key::space))
             : words::say(words_, "control.device.button",
                          {{"number", words::Number{static_cast<double>(std::countr_zero(held) + 1), 0}}});
    const auto& mover = at->bench->layout().mover;
    const bool feels = mover && station::renders_force(*mover);
    controls_ = options_.choice.with.devices.empty() ? lesson::keyboard_controls(words_, closes, tool)
                : feels                              ? lesson::device_controls(words_, closes, tool)
                                                     : lesson::puck_controls(words_, closes, tool);
    if (at->bench->hand() != nullptr) controls_ = lesson::glove_controls(words_, std::move(controls_));
}

Status App::unseen() {
    if (!playing_ || !playing_->station) return {};
    playing_->station->controls.pause = true;
    playing_->station->bench->set_controls(playing_->station->controls);
    return {};
}

Status App::end_lesson() {
    if (!playing_ || shows_ != Shows::lesson) return {};
    if (playing_->station)
        if (const servo::Timing* timing = playing_->station->bench->stop())
            if (Status kept = playing_->course->keep(*timing); !kept) return kept;

    Result<session::Played> played = playing_->course->finish();
    if (!played) return fail(played.error());
    played_ = std::move(*played);
    playing_->pace.finished = true;
    for (std::size_t i = 0; i < playing_->verdicts.size(); ++i)
        playing_->verdicts[i] = view::verdict_of(played_->result.joints[i]);
    shows_ = Shows::result;
    tell(fmt::format("lesson ended: {}, score {:.0f}", played_->result.finished ? "finished" : "broken off",
                     played_->result.score));
    tell_cost();
    if (options_.ended) return options_.ended(playing_->course->assembly(), course_, *played_);
    return {};
}

// What the frames of the lesson have cost beside rendering.
void App::tell_cost() {
    std::string line = "a frame's systems, median and p99 (ms):";
    for (auto& [system, times] : cost_) {
        std::sort(times.begin(), times.end());
        line +=
            fmt::format(" {} {:.2f} {:.2f}", system, times[times.size() / 2], times[times.size() * 99 / 100]);
    }
    tell(line);
    if (playing_->pace.lagged > 1.0)
        tell(fmt::format("pictures took so long that the lesson went {:.0f} s slower than the clock",
                         playing_->pace.lagged));
    cost_.clear();
}

void App::tell_events() {
    const double dt = playing_->course->setup().dt;
    for (const lesson::Event& event : playing_->events) {
        const std::string joint =
            event.joint >= 0 ? assembly_.joints[static_cast<std::size_t>(event.joint)].design.id + " "
                             : std::string();
        tell(fmt::format("{:7.2f} s  {}{} {}", static_cast<double>(event.tick) * dt, joint, event.kind,
                         event.text));
    }
    playing_->events.clear();
}

Status App::draw_backdrop(gpu::FrameContext& frame, VkExtent2D size) {
    backdrop_.want(options_.choice.assembly);
    view::Painter& painter = *on_->painter;
    return backdrop_.draw(*painter.device, *painter.renderer, frame, size);
}

Status App::frame(gpu::FrameContext& frame, std::span<const platform::Event> events, VkExtent2D size,
                  float scale, double seconds) {
    if (const auto language = std::exchange(language_wished_, std::nullopt))
        if (Status spoken = speak(*language); !spoken) return spoken;
    if (std::exchange(start_wished_, false)) {
        if (Status begun = begin_lesson(static_cast<float>(size.width) / static_cast<float>(size.height));
            !begun) {
            if (begun.error().lost || !options_.menu) return begun;
            trouble_ = begun.error();
            shows_ = Shows::menu;
            playing_.reset();
            tell(begun.error().message());
        } else {
            trouble_.reset();
        }
    }
    const glm::dvec2 extent(size.width, size.height);
    const bool in_settings = settings_.has_value();  // also in the frame in which they are left
    feed(input_, take_settings_keys(events));
    input_.size = glm::vec2(extent);
    input_.scale = scale;
    input_.seconds = seconds;
    ui::Ui& ui = *on_->ui;
    // Only the menu has something to type into, and the settings take keys for themselves.
    const bool has_keys = shows_ != Shows::menu && !in_settings;
    const Mine mine{has_keys && !ui.wants_pointer(), has_keys};
    static const render::Scene no_scene;
    render::Eye eye;
    const render::Scene* scene = &no_scene;
    if (playing_) {
        ActiveLesson& p = *playing_;
        if (p.station)
            p.station->keys.take(shows_ == Shows::lesson ? events : std::span<const platform::Event>());
        const double shown = std::min(seconds, longest_frame);
        Frame now{p, words_, shown, seconds - shown, extent, apply(p.controls, events, mine), &*on_->fonts,
                  {}};
        if (now.wanted.wants(Action::pause) && shows_ == Shows::lesson) p.pace.paused = !p.pace.paused;
        full_screen_ = full_screen_ || now.wanted.wants(Action::full_screen);
        const bool had_wrench = hand_of(p).wrench;
        const auto timed = [&](std::string_view system, const auto& run) {
            const auto begin = std::chrono::steady_clock::now();
            run();
            cost_[system].push_back(
                std::chrono::duration<float, std::milli>(std::chrono::steady_clock::now() - begin).count());
        };
        timed("pointer", [&] { read_pointer(p.place.world, now); });
        ecs::run(frame_systems, p.place.world, now, timed);
        if (hand_of(p).wrench != had_wrench)
            tell(fmt::format("{:7.2f} s  the wrench is {}", p.course->time(),
                             hand_of(p).wrench ? "in the hand" : "laid down"));
        tell_events();
        if (p.sound.live)
            if (const auto news = p.sound.live->news()) tell(*news);
        if (!now.status) return now.status;
        if (p.pace.finished && shows_ == Shows::lesson)
            if (Status ended = end_lesson(); !ended) return ended;
        eye = screen_of(p, extent).eye;
        scene = &p.scene;
    }
    for (const platform::Event& event : events) {
        closed_ = closed_ || std::holds_alternative<platform::CloseEvent>(event);
        const auto* key = std::get_if<platform::KeyEvent>(&event);
        const bool enter = key != nullptr && key->key == platform::Key::enter && key->down && !key->repeated;
        start_wished_ = start_wished_ || (enter && shows_ != Shows::lesson && !in_settings);
    }
    render::Renderer& renderer = *on_->painter->renderer;
    if (Status drawn = renderer.render(frame, *scene, std::span(&eye, 1), size); !drawn) return drawn;
    if (!playing_)
        if (Status drawn = draw_backdrop(frame, size); !drawn) return drawn;
    if (Status begun = ui.begin(frame, input_); !begun) return begun;
    if (const auto behind = backdrop_.picture(renderer); behind && !playing_)
        ImGui::GetBackgroundDrawList()->AddImage(ui.picture(*behind), {0.0F, 0.0F},
                                                 {input_.size.x, input_.size.y});
    draw_interface(extent);
    if (playing_ && shows_ == Shows::lesson) {
        const Drawing on{renderer, frame, ui};
        if (Status drawn = draw_close_up(on, *playing_, extent, scale); !drawn) return drawn;
    }
    if (playing_) playing_->view.occupied = occupied_areas();
    const render::Overlay overlay = ui.end();
    if (Status drawn = renderer.draw_over(frame, overlay, renderer.picture(0)); !drawn) return drawn;
    if (std::exchange(end_wished_, false)) return end_lesson();
    return {};
}

}  // namespace bolt::trainer

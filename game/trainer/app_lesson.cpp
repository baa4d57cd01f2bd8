// The part of App that starts and ends a lesson.
#include <fmt/format.h>

#include <algorithm>

#include "game/study/measures.hpp"
#include "game/study/study_lesson.hpp"
#include "game/trainer/app.hpp"

namespace bolt::trainer {

namespace {

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

}  // namespace

// Uploads the models of the lesson and makes the entities that refer to them.
Status App::upload_models() {
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

// Pauses the lesson for the author's instruction, and shows the view that it names.
void App::begin_instruction() {
    ActiveLesson& active = *active_;
    active.clock.paused = true;
    const std::string& view = active.guidance.instruction.shown->view;
    if (view.empty() || in_room()) return;
    if (const auto named = view::named_view(context_->models.workpiece, view))
        active.view.camera.glide_to(view::orbit_of(*named));
}

bool App::shows_instruction() const {
    const bool touches = room_ && room_->touch;
    return active_ && screen_ == ShownScreen::lesson && !settings_ && !touches && active_->clock.paused &&
           active_->guidance.instruction.shown != nullptr;
}

ScreenAction App::draw_instruction_page(const ScreenContext& context) {
    const content::Instruction& instruction = *active_->guidance.instruction.shown;
    const auto found = gpu_->models->pictures.find(instruction.picture);
    if (found == gpu_->models->pictures.end()) return draw_instruction(context, instruction, nullptr);
    const VkExtent2D extent = found->second.info().extent;
    const InstructionPicture picture{gpu_->ui->picture({&found->second, 0}),
                                     glm::vec2(extent.width, extent.height)};
    return draw_instruction(context, instruction, &picture);
}

// The choice of the menu, or the tour with the same devices.
LessonChoice App::lesson_choice() const {
    LessonChoice choice = options_.choice;
    choice.trainee = menu_.trainee.identified.person.code;
    if (options_.menu) choice.assembly = content::assembly_folder(choice.assembly).string();
    return tour_requested_ ? tour_choice(std::move(choice)) : choice;
}

// The lesson of the study's due step. Its settings override those of the participant, which differ between
// participants.
Result<LessonRequest> App::study_request() {
    study::Participation& participation = study_->participation();
    const content::StudyLesson& lesson = participation.lesson();
    const std::filesystem::path& study_folder = study_->folder();
    BOLT_TRY_ASSIGN(const auto assembly, study::load_lesson_assembly(lesson, study_folder));
    const session::LessonOptions settings = study::lesson_options(lesson, assembly.law);
    LessonRequest request{
        options_.choice, preferences_.settings, options_.lesson, {}, options_.start_station};
    LessonChoice& choice = request.choice;
    choice.trainee = participation.progress().person;
    choice.assembly = study::assembly_of(lesson, study_folder);
    choice.variant = lesson.variant;
    choice.tool = lesson.tool;
    choice.mode = settings.mode;
    choice.task = settings.task;
    choice.law = settings.law;
    if (shown_in_headset() && !(room_ && room_->has_display))
        return fail(ErrorCode::no_device, "the headset shows nothing", "the headset on and worn");
    choice.equipment = equipment_for(lesson.devices, lesson.hand == "free", choice.equipment);
    use_glove(lesson.glove, choice.equipment);
    if (lesson.hand == "tracked" && lesson.devices.empty()) choice.equipment.devices.clear();
    if (shown_in_headset() && (lesson.hand == "tracked" || choice.equipment.hand_unassigned()))
        choice.equipment.hand = HandMode::tracked;
    request.settings.force_scale = lesson.force_scale.value_or(request.settings.force_scale);
    request.options.guiding_force = settings.guiding_force;
    request.options.obstacles = settings.obstacles;
    request.options.seed =
        study::lesson_seed(participation.study(), participation.progress().place, participation.due()->id);
    if (const auto begun = participation.begun_lesson())
        request.interrupted = *begun / study::lesson_session_name;
    BOLT_TRY_ASSIGN(request.folder, participation.make_lesson_folder());
    return request;
}

// Records that the lesson of the study has begun, or continues an interrupted one.
Status App::record_study_lesson(const StartedLesson& started) {
    if (!study_) return {};
    if (started.continued) return study_->participation().record_continued(folder_);
    if (!started.why_begun_again) return study_->participation().record_begun(folder_);
    const std::string why = started.why_begun_again->message();
    log("the interrupted lesson cannot be continued and begins again: " + why);
    return study_->participation().record_begun(folder_, why);
}

Status App::begin_lesson(float aspect) {
    select_trainee();
    save_preferences();
    if (active_ && options_.choice.equipment.needs_station())
        active_->station.reset();  // it holds the devices
    LessonRequest request;
    if (study_) {
        BOLT_TRY_ASSIGN(request, study_request());
        folder_ = request.folder;
    } else {
        const LessonChoice chosen = lesson_choice();
        BOLT_TRY_ASSIGN(folder_,
                        make_lesson_folder(options_.out, options_.folder_per_lesson, chosen.assembly));
        request = {chosen, preferences_.settings, options_.lesson, folder_, options_.start_station};
    }
    const LessonChoice& choice = request.choice;
    const bool is_quick = !choice.equipment.has_hardware() && request.interrupted.empty();
    if (is_quick) return enter_lesson(start_lesson(request), aspect);
    if (active_) BOLT_TRY(close_lesson());
    arm_screen_ = {};
    arm_screen_.restores = !request.interrupted.empty();
    start_thread_ = std::make_unique<LessonStartThread>(std::move(request), std::move(given_up_));
    screen_ = ShownScreen::starting;
    return {};
}

Status App::enter_lesson(Result<StartedLesson> started, float aspect) {
    if (!started) {
        std::error_code ignored;
        if (options_.folder_per_lesson) std::filesystem::remove(folder_, ignored);  // if it is still empty
        return fail(started.error());
    }
    BOLT_TRY(record_study_lesson(*started));
    if (active_) {
        BOLT_TRY(gpu_->context->device->idle());
        active_.reset();
    }
    if (options_.on_start) options_.on_start(folder_);
    context_ = std::move(started->context);
    active_.emplace(std::move(started->active));
    ActiveLesson& active = *active_;
    for (const std::string& missing : context_->models.missing) log("not drawn: " + missing);
    if (!started->continued) world::add_haptics(active.workplace.world, active.session->state());
    BOLT_TRY(upload_models());
    place_trainee(active, *context_, aspect);
    active.view.help = !study_ || study_->participation().lesson().view_help;
    if (const Status sounds = start_sound(active, options_.sound); !sounds) log(sounds.error().message());
    apply_preferences();
    ++lesson_number_;
    shared_models_ = {context_->choice.assembly, context_->assembly.variant, context_->choice.tool,
                      context_->worker.side};
    active.verdicts.assign(context_->assembly.joints.size(), lesson::Verdict::none);
    outcome_.reset();
    tour_ = tour_requested_ ? std::optional(Tour{}) : std::nullopt;
    screen_ = ShownScreen::lesson;
    menu_.first_start = false;
    // In a study the settings would reveal the condition to the experimenter.
    log(started->continued ? fmt::format("lesson continued after {:.1f} s", active.session->time())
        : study_           ? "lesson begun"
                           : fmt::format("lesson begun: {} {}, {}, law {}", context_->assembly.name,
                                         context_->assembly.variant, lesson::name(context_->options.mode),
                                         joint::name(context_->options.law)));
    return {};
}

// Shows an error of a start in the menu or on the page of the study. Returns it if there is neither, or if
// the GPU is lost.
Status App::report_start(Status begun) {
    if (begun) return {};
    if (study_ && !begun.error().lost) {
        study_->show_error(begun.error());
        screen_ = ShownScreen::study;
        log(begun.error().message());
        return {};
    }
    if (begun.error().lost || !options_.menu) return begun;
    menu_.start_error = begun.error();
    screen_ = ShownScreen::menu;
    log(begun.error().message());
    return {};
}

void App::cancel_start() {
    if (!start_thread_) return;
    start_thread_->give_up();
    given_up_ = std::move(start_thread_);
    screen_ = study_ ? ShownScreen::study : ShownScreen::menu;
    closed_ = closed_ || (!options_.menu && !study_);
}

// Shows what the arm needs, before and during a lesson, and performs the user's answer.
void App::follow_arm(std::span<const platform::InputEvent> events, double seconds, bool enter_key_answers) {
    StationClient* client = screen_ == ShownScreen::lesson && active_->station ? &*active_->station : nullptr;
    if (client != nullptr) pause_for_arm(*client, active_->clock);
    const device::ArmNeeds needs = start_thread_       ? start_thread_->needs()
                                   : client != nullptr ? client->needs
                                                       : device::ArmNeeds{};
    const std::string before = describe(arm_screen_.needs);
    arm_screen_.in_lesson = client != nullptr;
    trainer::update(arm_screen_, needs, settings_ ? 0.0 : seconds);  // the settings cover the question
    if (const std::string now = describe(needs); now != before && !now.empty()) log(now);
    if (!settings_) perform(action_of(arm_screen_, events, enter_key_answers));
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
    if (study_ && !interrupted_) count_study_lesson();
    if (!options_.on_end) return {};
    const Status written = options_.on_end(active.session->assembly(), context_->options, *outcome_, folder_);
    if (written || !study_) return written;
    log(written.error().message());  // the report can be made again; the study continues
    return {};
}

// Records the measures of the lesson that has ended. Shows the next page of the study, or the result first if
// the study shows results.
void App::count_study_lesson() {
    screen_ = ShownScreen::study;
    const Status stored =
        study::measure_session(folder_ / study::lesson_session_name).and_then([&](const auto& measures) {
            return study_->participation().end_lesson(measures);
        });
    if (!stored)
        study_->show_error(stored.error());
    else if (study_->participation().study().design.show_results)
        screen_ = ShownScreen::result;
}

}  // namespace bolt::trainer

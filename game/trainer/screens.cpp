#include "game/trainer/screens.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>

#include <algorithm>
#include <array>
#include <chrono>

#include "game/lesson/feedback.hpp"
#include "game/trainer/app.hpp"
#include "game/trainer/hud.hpp"

namespace bolt::trainer {

namespace {

constexpr std::uint32_t group = 2;                     // of the renderer's pictures: 1 is the close-up
constexpr glm::vec4 dim{0.035F, 0.04F, 0.045F, 1.0F};  // behind it
constexpr float nearer = 0.7F;            // than to see all of it: the menu stands before its middle
constexpr float exposure = 0.55F;         // the menu is what is to be read
constexpr std::uint32_t light_size = 32;  // texels: less to filter, while somebody waits

// The coarse model is enough, where there is one.
view::LoadedSubject read(const std::string& assembly) {
    view::LoadedSubject far = view::load_subject(assembly, view::Level::far);
    return far.ok() ? std::move(far) : view::load_subject(assembly);
}

}  // namespace

void Backdrop::want(const std::string& assembly) {
    wanted_ = assembly;
    if (coming_.valid() || shown_ == wanted_ || coming_name_ == wanted_) return;
    coming_name_ = assembly;
    coming_ = std::async(std::launch::async, read, assembly);
}

Status Backdrop::put_up(gpu::Device& device, const view::Subject& subject) {
    BOLT_TRY(device.idle());
    if (light_.levels.get() == VK_NULL_HANDLE) {
        BOLT_TRY_ASSIGN(auto light, render::upload_environment(device, shading::studio(), light_size));
        light_ = std::move(light);
    }
    BOLT_TRY_ASSIGN(auto stage, view::set_stage(device, subject, light_));
    stage_ = std::move(stage);
    stage_->scene.background = dim;
    stage_->scene.exposure = exposure;
    from_ = subject.views.empty() ? view::Viewpoint{} : subject.views.front();
    shown_ = coming_name_;
    drawn_ = {};
    return {};
}

Status Backdrop::draw(gpu::Device& device, render::Renderer& renderer, gpu::FrameContext& frame,
                      VkExtent2D size) {
    using namespace std::chrono_literals;
    if (coming_.valid() && coming_.wait_for(0s) == std::future_status::ready) {
        const view::LoadedSubject loaded = coming_.get();
        // One that cannot be read is told of when its lesson is to begin.
        if (loaded.ok()) BOLT_TRY(put_up(device, loaded.subject));
    }
    if (!stage_ || (drawn_.width == size.width && drawn_.height == size.height)) return {};
    const float aspect = static_cast<float>(size.width) / static_cast<float>(size.height);
    view::Viewpoint at = from_.fov > 0.0F ? from_ : view::framed(stage_->box, view::usual_fov, aspect);
    at.eye = glm::mix(at.target, at.eye, nearer);
    const render::Eye eye =
        render::make_eye(at.eye, at.target, view::lens(stage_->box, at.eye, at.target, at.fov, aspect));
    BOLT_TRY(renderer.render(frame, stage_->scene, {&eye, 1}, size, group));
    drawn_ = size;
    return {};
}

std::optional<render::ImageLayer> Backdrop::picture(const render::Renderer& renderer) const {
    if (shown_ != wanted_ || drawn_.width == 0) return std::nullopt;
    return renderer.picture(0, group);
}

void Backdrop::drop() {
    stage_.reset();
    light_ = {};
    shown_.clear();
    coming_name_.clear();
    drawn_ = {};
}

// The screens of the trainer that are made of buttons: menu, pause, result.

namespace {

constexpr ImGuiWindowFlags panel = ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoTitleBar;

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

void begin_panel(const char* name, const glm::dvec2& size, float width) {
    ImGui::SetNextWindowPos({static_cast<float>(0.5 * size.x), static_cast<float>(0.5 * size.y)},
                            ImGuiCond_Always, {0.5F, 0.5F});
    ImGui::SetNextWindowSizeConstraints({width, 0.0F}, {width, static_cast<float>(size.y)});
    ImGui::SetNextWindowBgAlpha(0.94F);
    ImGui::Begin(name, nullptr, panel);
}

std::string in_language(const std::map<std::string, std::string>& texts, const std::string& language,
                        const std::string& otherwise) {
    for (const std::string& code : {language, std::string("en")})
        if (const auto found = texts.find(code); found != texts.end()) return found->second;
    return otherwise;
}

template <class Value>
void radio(const char* label, Value& value, Value to) {
    if (ImGui::RadioButton(label, value == to)) value = to;
    ImGui::SameLine();
}

void text_field(const char* label, std::string& value) {
    std::array<char, 64> buffer{};
    value.copy(buffer.data(), buffer.size() - 1);
    if (ImGui::InputText(label, buffer.data(), buffer.size())) value = buffer.data();
}

}  // namespace

bool App::button(words::Key key) {
    const bool pressed = ImGui::Button(words_[key].c_str(), {-1.0F, 0.0F});
    remember_place(key);
    return pressed;
}

// What the hand plays with, where there is a choice.
void App::draw_seats() {
    Equipment& with = options_.choice.with;
    for (const Seat& seat : seats_) {
        const std::string name = seat.name.empty() ? words_["menu.mouse"] : seat.name;
        Equipment to = seat.with;
        to.rig = with.rig;
        to.glove = with.glove;
        if (seats_.size() > 1 &&
            ImGui::RadioButton(name.c_str(), with.devices == to.devices && !with.keyboard))
            with = to;
    }
}

// A choice is the trainee's from now on, and replaces that of the command line.
void App::draw_laws(joint::Law of_assembly) {
    ImGui::AlignTextToFramePadding();
    text(words_["menu.law"]);
    const joint::Law now = law_in_force(of_assembly);
    for (const auto& [key, law] : {std::pair{words::Key("menu.law.mechanistic"), joint::Law::mechanistic},
                                   std::pair{words::Key("menu.law.published"), joint::Law::published}}) {
        ImGui::SameLine();
        if (ImGui::RadioButton(words_[key].c_str(), now == law)) {
            preferences_.settings.law = joint::name(law);
            options_.law.reset();
        }
        remember_place(key);
    }
}

void App::draw_menu(const glm::dvec2& size) {
    Choice& choice = options_.choice;
    const float scale = input_.scale;
    begin_panel("##menu", size, 560.0F * scale);
    text("Boltwright");
    ImGui::Separator();
    for (const Listed& listed : listed_) {
        const bool chosen = listed.name == choice.assembly;
        if (ImGui::Selectable(in_language(listed.title, words_.language, listed.name).c_str(), chosen) &&
            !chosen) {
            choice.assembly = listed.name;
            choice.variant.clear();
            choice.tool.clear();
        }
    }
    ImGui::Separator();
    const auto listed = std::find_if(listed_.begin(), listed_.end(),
                                     [&](const Listed& one) { return one.name == choice.assembly; });
    if (listed != listed_.end() && listed->variants.size() > 1) {
        for (const content::Variant& variant : listed->variants)
            radio(in_language(variant.title, words_.language, variant.name).c_str(), choice.variant,
                  variant.name == listed->usual ? std::string() : variant.name);
        ImGui::NewLine();
    }
    if (listed != listed_.end() && listed->tools.size() > 1) {
        for (const content::Tool& tool : listed->tools)
            radio(in_language(tool.title, words_.language, tool.name).c_str(), choice.tool,
                  tool.name == listed->tools.front().name ? std::string() : tool.name);
        ImGui::NewLine();
    }
    if (listed != listed_.end()) {
        ImGui::PushStyleColor(ImGuiCol_Text, {0.75F, 0.8F, 0.85F, 1.0F});
        ImGui::BeginChild("##lesson", {0.0F, 150.0F * scale});
        ImGui::PushTextWrapPos(0.0F);
        text(in_language(listed->lesson, words_.language, ""));
        ImGui::PopTextWrapPos();
        ImGui::EndChild();
        ImGui::PopStyleColor();
    }
    for (const lesson::Mode mode : {lesson::Mode::guided, lesson::Mode::practice, lesson::Mode::assessment})
        radio(words_[lesson::term(mode)].c_str(), choice.mode, mode);
    ImGui::NewLine();
    for (const lesson::Task task : {lesson::Task::tighten, lesson::Task::loosen})
        radio(words_[lesson::term(task)].c_str(), choice.task, task);
    ImGui::NewLine();
    if (listed != listed_.end()) draw_laws(listed->law);
    draw_seats();
    text_field(words_["menu.trainee"].c_str(), choice.trainee);
    if (ImGui::IsItemDeactivatedAfterEdit()) meet_trainee();
    draw_languages();
    ImGui::Separator();
    if (trouble_) {
        ImGui::PushStyleColor(ImGuiCol_Text, {1.0F, 0.55F, 0.45F, 1.0F});
        ImGui::TextWrapped("%s", trouble_->message().c_str());
        ImGui::PopStyleColor();
    }
    if (preferences_.trouble != Preferences::Trouble::none) draw_kept();
    if (button("menu.start")) start_wished_ = true;
    ImGui::SetItemDefaultFocus();
    if (button("menu.settings")) open_settings();
    if (button("menu.quit")) closed_ = true;
    ImGui::End();
}

void App::draw_pause(const glm::dvec2& size) {
    begin_panel("##pause", size, 300.0F * input_.scale);
    text(words_["menu.paused"]);
    ImGui::Separator();
    if (preferences_.trouble != Preferences::Trouble::none) draw_kept();
    if (button("menu.go_on")) playing_->pace.paused = false;
    const bool may_undo = playing_->course->lesson().mode != lesson::Mode::assessment;
    if (may_undo && button("menu.undo")) {
        go_back(playing_->undo, playing_->course->lesson(), 1);
        playing_->pace.paused = false;
    }
    if (may_undo && button("menu.restart_step")) {
        go_back(playing_->undo, playing_->course->lesson(), 0);
        playing_->pace.paused = false;
    }
    if (button("menu.settings")) open_settings();
    if (button("menu.end")) {
        playing_->pace.paused = false;
        end_wished_ = true;
    }
    if (button("menu.quit")) closed_ = true;
    ImGui::End();
}

void App::draw_result(const glm::dvec2& size) {
    const lesson::LessonResult& result = played_->result;
    const float scale = input_.scale;
    ImGui::SetNextWindowPos({static_cast<float>(size.x) - 12.0F * scale, 12.0F * scale}, ImGuiCond_Always,
                            {1.0F, 0.0F});
    ImGui::SetNextWindowSizeConstraints({380.0F * scale, 0.0F},
                                        {380.0F * scale, static_cast<float>(size.y) - 24.0F * scale});
    ImGui::SetNextWindowBgAlpha(0.9F);
    ImGui::Begin("##result", nullptr, panel);
    text(words::say(words_, "result.score", {{"points", words::Number{result.score, 0}}}) +
         fmt::format("   {:.0f} s", result.duration));
    ImGui::Separator();
    // Above what may be long: they are always there to be pressed.
    if (button("menu.again")) start_wished_ = true;
    if (options_.menu && button("menu.menu")) shows_ = Shows::menu;
    if (button("menu.quit")) closed_ = true;
    ImGui::Separator();
    if (ImGui::BeginTable("joints", 5, ImGuiTableFlags_SizingFixedFit | ImGuiTableFlags_RowBg)) {
        for (const char* head : {"", "N·m", "°", "kN", ""}) ImGui::TableSetupColumn(head);
        ImGui::TableHeadersRow();
        for (const lesson::JointResult& joint : result.joints) {
            for (const std::string& cell :
                 {joint.id, fmt::format("{:.1f}", joint.torque),
                  fmt::format("{:.0f}", to_degrees(joint.angle)), fmt::format("{:.1f}", joint.clamp / 1e3),
                  fmt::format("{} {}", view::sign_of(view::verdict_of(joint)),
                              words_[lesson::term(joint.overall)])}) {
                ImGui::TableNextColumn();
                text(cell);
            }
        }
        ImGui::EndTable();
    }
    const lesson::Review review = lesson::review(assembly_, result);
    ImGui::PushTextWrapPos(340.0F * scale);
    for (const lesson::Remark& reason : review.reasons)
        text((reason.points != 0.0 ? fmt::format("{:+.0f}  ", reason.points) : std::string()) +
             lesson::say(words_, reason));
    ImGui::Separator();
    for (const words::Key advice : review.advice) text(words_[advice]);
    ImGui::PopTextWrapPos();
    ImGui::End();
}

void App::draw_interface(const glm::dvec2& size) {
    buttons_.clear();
    if (shows_ == Shows::lesson) draw_hud(*playing_, {&words_, &controls_}, size, input_.scale);
    if (settings_) return draw_settings(size);
    if (shows_ == Shows::lesson && playing_->pace.paused) draw_pause(size);
    if (shows_ == Shows::menu) draw_menu(size);
    if (shows_ == Shows::result) draw_result(size);
}

}  // namespace bolt::trainer

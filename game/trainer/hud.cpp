#include "game/trainer/hud.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>  // the public API gives a window's area only while it is being filled

#include <algorithm>
#include <cmath>

#include "game/lesson/feedback.hpp"
#include "game/lesson/step_requirements.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/arm_screen.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::trainer {

namespace {

constexpr float min_strike = 0.08F;                   // m/s, audible strike
constexpr float min_slide = 0.02F, min_press = 1.0F;  // m/s; N
constexpr float min_run = 2.0F;                       // rad/s
constexpr float min_load = 0.3F;
constexpr double creep_for_caption = 0.02;  // rad under load, several stick-slip cycles (sound/synth.cpp)
constexpr double creep_decay_time = 1.0;    // s
constexpr double min_duration = 0.15;  // s, after which a lasting sound other than `creep` gets a caption
constexpr double decay_rate = 3.0;     // how many times faster progress falls after the sound than it rose

double& of(std::array<double, caption_count>& all, Caption caption) {
    return all.at(static_cast<std::size_t>(caption));
}

void show_if(Captions& captions, Caption caption, bool condition) {
    if (condition) of(captions.remaining, caption) = caption_duration;
}

// Integrates a lasting sound, because the movements of a mouse, and so the sounds, are intermittent. `more`
// and `less` are fractions of the amount that shows the caption.
void accumulate(Captions& captions, Caption caption, double more, double less) {
    double& progress = of(captions.progress, caption);
    show_if(captions, caption, more > 0.0 && progress + more >= 1.0);
    progress = std::clamp(progress + more - less, 0.0, 1.0);
}

void observe_lasting(Captions& captions, Caption caption, bool audible, double dt) {
    accumulate(captions, caption, audible ? dt / min_duration : 0.0,
               audible ? 0.0 : decay_rate * dt / min_duration);
}

}  // namespace

void observe(Captions& captions, const sound::SoundCues& cues, double dt) {
    const bool struck = cues.strike_speed > min_strike;
    show_if(captions, Caption::slip, cues.slip > 0.0F);
    show_if(captions, Caption::mistake, cues.mistake);
    show_if(captions, Caption::click, cues.click);
    show_if(captions, Caption::done, cues.done);
    show_if(captions, Caption::strike_casing, struck && cues.surface == sound::StruckSurface::casing);
    show_if(captions, Caption::strike_nut, struck && cues.surface == sound::StruckSurface::nut);
    const double creep_angle = cues.load > min_load ? static_cast<double>(cues.creep_speed) * dt : 0.0;
    accumulate(captions, Caption::creep, creep_angle / creep_for_caption, dt / creep_decay_time);
    observe_lasting(captions, Caption::scrape, cues.slide_speed > min_slide && cues.contact_force > min_press,
                    dt);
    show_if(captions, Caption::tooth, cues.tooth);
    observe_lasting(captions, Caption::run, cues.run_speed > min_run, dt);
}

void update(Captions& captions, double seconds) {
    for (double& left : captions.remaining) left = std::max(0.0, left - seconds);
}

std::vector<Caption> visible_captions(const Captions& captions) {
    std::vector<Caption> all;
    for (std::size_t i = 0; i < caption_count && all.size() < max_captions; ++i)
        if (captions.remaining.at(i) > 0.0) all.push_back(static_cast<Caption>(i));
    return all;
}

words::TextKey text_key(Caption caption) {
    constexpr words::TextKey keys[] = {
        "caption.slip",       "caption.mistake", "caption.click",  "caption.done",  "caption.strike_casing",
        "caption.strike_nut", "caption.groan",   "caption.scrape", "caption.tooth", "caption.run"};
    static_assert(std::size(keys) == caption_count);
    return keys[static_cast<std::size_t>(caption)];
}

namespace {

constexpr std::size_t max_points = 4000;
constexpr float min_angle_step = 0.02F, min_torque_step = 0.2F;  // less than a pixel

std::optional<content::ToleranceWindow> target_window(const lesson::Lesson& lesson, std::size_t joint) {
    if (lesson.task != lesson::Task::tighten) return std::nullopt;
    const lesson::LessonStep* due = lesson.due();
    const bool its_turn = due != nullptr && due->joint == joint && due->kind != lesson::StepKind::run_down;
    return its_turn ? lesson::torque_window(lesson, *due) : lesson.assembly->joints[joint].spec.torque;
}

}  // namespace

namespace {

// Keeps every second point. Further points must then differ twice as much.
void thin_out(TorquePlot& plot) {
    std::size_t kept = 0;
    for (std::size_t i = 0; i < plot.points.size(); i += 2) plot.points[kept++] = plot.points[i];
    plot.points.resize(kept);
    plot.coarseness *= 2.0F;
}

}  // namespace

void observe(TorquePlot& plot, const lesson::Lesson& lesson,
             const ecs::Access<const world::Joint, const world::ToolState>& world) {
    const std::int16_t engaged = world.only<world::ToolState>().joint;
    if (engaged < 0) return;
    if (engaged != plot.joint) {
        plot.points.clear();
        plot.coarseness = 1.0F;
    }
    plot.joint = engaged;
    plot.target = target_window(lesson, static_cast<std::size_t>(plot.joint));
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(plot.joint));
    const PlotPoint now{static_cast<float>(to_degrees(joint.angle)), static_cast<float>(joint.torque)};
    const bool same = !plot.points.empty() &&
                      std::abs(plot.points.back().angle - now.angle) < plot.coarseness * min_angle_step &&
                      std::abs(plot.points.back().torque - now.torque) < plot.coarseness * min_torque_step;
    if (same) return;
    if (plot.points.size() == max_points) thin_out(plot);
    plot.points.push_back(now);
}

std::vector<render::Rectangle> occupied_areas() {
    std::vector<render::Rectangle> areas;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const bool own = (window->Flags & ImGuiWindowFlags_ChildWindow) == 0 && !window->IsFallbackWindow;
        if (!own || !window->Active || window->Hidden) continue;
        const ImVec2 high = {window->Pos.x + window->Size.x, window->Pos.y + window->Size.y};
        areas.push_back({{window->Pos.x, window->Pos.y}, {high.x, high.y}});
    }
    return areas;
}

namespace {

constexpr ImGuiWindowFlags hud_panel_flags = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                             ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                                             ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

constexpr ImU32 grid = IM_COL32(150, 160, 170, 60), frame_color = IM_COL32(200, 205, 210, 160),
                curve = IM_COL32(255, 205, 70, 255), effort_color = IM_COL32(255, 120, 80, 255);

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

ImU32 to_imgui_color(const glm::vec4& color, float opacity) {
    return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, opacity * color.a});
}

void begin_dialog(const char* name, const ImVec2& at, const ImVec2& pivot, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowBgAlpha(0.78F);
    ImGui::Begin(name, nullptr, flags);
}

// A panel that fits its content; for content of constant size.
void begin_dialog(const char* name, const ImVec2& at, const ImVec2& pivot) {
    begin_dialog(name, at, pivot, hud_panel_flags | ImGuiWindowFlags_AlwaysAutoResize);
}

struct HudLine {
    std::string text;
    ImVec4 color;
};

const ImVec4 white(0.96F, 0.97F, 0.98F, 1.0F), pale(0.75F, 0.85F, 0.95F, 1.0F), warm(1.0F, 0.6F, 0.5F, 1.0F),
    grey(0.5F, 0.5F, 0.5F, 1.0F);

// A panel that fits its lines from its first frame on. ImGui's automatic size lags by a frame, which clips
// text where frames are slow.
void text_panel(const char* name, const ImVec2& at, const ImVec2& pivot, std::span<const HudLine> lines,
                float max_width) {
    if (lines.empty()) return;
    const ImGuiStyle& style = ImGui::GetStyle();
    ImVec2 size(0.0F, -style.ItemSpacing.y);
    for (const HudLine& line : lines) {
        const char* begin = line.text.c_str();
        const ImVec2 extent =
            ImGui::CalcTextSize(begin, begin + line.text.size(), false, max_width - style.WindowPadding.x);
        size = {std::max(size.x, extent.x), size.y + style.ItemSpacing.y + extent.y};
    }
    ImGui::SetNextWindowSize({size.x + 2.0F * style.WindowPadding.x, size.y + 2.0F * style.WindowPadding.y});
    begin_dialog(name, at, pivot, hud_panel_flags);
    ImGui::PushTextWrapPos(max_width);
    for (const HudLine& line : lines) {
        ImGui::PushStyleColor(ImGuiCol_Text, line.color);
        text(line.text);
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// Torque over nut angle, with the target window.
void draw_plot(const ActiveLesson& active, const words::Words& w, const glm::dvec2& size, float scale) {
    const std::vector<PlotPoint>& points = active.plot.points;
    if (points.size() < 2) return;
    const auto joint = static_cast<std::size_t>(active.plot.joint);
    const content::Specification& spec = active.session->assembly().joints[joint].spec;
    const ImVec2 area(260.0F * scale, 150.0F * scale);
    begin_dialog("##plot",
                 {static_cast<float>(size.x) - 12.0F * scale, static_cast<float>(size.y) - 12.0F * scale},
                 {1.0F, 1.0F});
    text(words::format_text(w, "hud.curve", {{"joint", active.session->assembly().joints[joint].design.id}}));
    const ImVec2 low = ImGui::GetCursorScreenPos();
    ImGui::Dummy(area);
    const auto [least, most] =
        std::minmax_element(points.begin(), points.end(),
                            [](const PlotPoint& a, const PlotPoint& b) { return a.angle < b.angle; });
    const float begin = least->angle, across = std::max(most->angle - begin, 10.0F) * 1.08F;
    float highest = static_cast<float>(spec.torque.high) * 1.15F, lowest = 0.0F;
    for (const PlotPoint& q : points) {
        highest = std::max(highest, q.torque);
        lowest = std::min(lowest, q.torque);
    }
    const auto place = [&](float angle, float torque) {
        return ImVec2(low.x + area.x * (angle - begin) / across,
                      low.y + area.y * (highest - torque) / (highest - lowest));
    };
    ImDrawList& list = *ImGui::GetWindowDrawList();
    if (active.plot.target && active.session->lesson().mode != lesson::Mode::assessment) {
        const ImVec2 top = place(begin, static_cast<float>(active.plot.target->high)),
                     foot = place(begin + across, static_cast<float>(active.plot.target->low));
        // Band and edges, visible without colour vision too.
        list.AddRectFilled(top, foot, to_imgui_color(active.palette.ok, 0.24F));
        list.AddRect(top, foot, to_imgui_color(active.palette.ok, 0.9F));
    }
    list.AddLine(place(begin, 0.0F), place(begin + across, 0.0F), grid);
    list.AddRect(low, {low.x + area.x, low.y + area.y}, frame_color);
    for (std::size_t i = 1; i < points.size(); ++i)
        list.AddLine(place(points[i - 1].angle, points[i - 1].torque),
                     place(points[i].angle, points[i].torque), curve, 2.0F * scale);
    ImGui::End();
}

// The force of the hand on the handle, which a haptic device would render.
void draw_effort(const ActiveLesson& active, const words::Words& w, const glm::dvec2& size, float scale) {
    const std::int16_t engaged = tool_state_of(active).joint;
    if (engaged < 0 || !hand_of(active).wrench) return;
    const servo::Setup& setup = active.session->setup();
    const world::Joint& joint = world::joint_at(active.workplace.world, static_cast<std::size_t>(engaged));
    const double force = std::abs(joint.torque) / setup.wrench.handle_length;
    const double greatest = setup.wrench.stiffness * to_radians(2.5) / setup.wrench.handle_length;
    const auto share = static_cast<float>(std::clamp(force / greatest, 0.0, 1.0));
    begin_dialog("##effort", {static_cast<float>(0.5 * size.x), static_cast<float>(size.y) - 12.0F * scale},
                 {0.5F, 1.0F});
    text(words::format_text(w, "hud.pull", {{"force", words::Number{force, 0}}}));
    const ImVec2 low = ImGui::GetCursorScreenPos(), area(260.0F * scale, 12.0F * scale);
    ImGui::Dummy(area);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, {low.x + area.x * share, low.y + area.y}, effort_color, 3.0F * scale);
    list.AddRect(low, {low.x + area.x, low.y + area.y}, frame_color, 3.0F * scale);
    ImGui::End();
}

// "B3: Tighten to 230 N·m".
std::string due_text(const words::Words& w, const std::string& id, const lesson::LessonStep& due) {
    const std::string& what = w[lesson::text_key(due.kind)];
    if (due.kind == lesson::StepKind::tighten)
        return words::format_text(
            w, "hud.due_torque",
            {{"joint", id}, {"what", what}, {"torque", words::torque_number(due.torque)}});
    if (due.angle > 0.0)
        return words::format_text(
            w, "hud.due_angle",
            {{"joint", id}, {"what", what}, {"angle", words::Number{to_degrees(due.angle), 0}}});
    return words::format_text(w, "hud.due", {{"joint", id}, {"what", what}});
}

void draw_step(const ActiveLesson& active, const words::Words& w, const glm::dvec2& size, float scale) {
    const lesson::Lesson& lesson = active.session->lesson();
    const lesson::LessonStep* due = trainer::due(active.undo, lesson);
    const auto whole = [](std::size_t n) { return words::Number{static_cast<double>(n), 0}; };
    const std::size_t steps = lesson.steps.size();
    const std::size_t at = due == nullptr ? steps : static_cast<std::size_t>(due - lesson.steps.data()) + 1;
    std::vector<HudLine> lines{
        {words::format_text(w, "hud.step", {{"step", whole(at)}, {"of", whole(steps)}}) +
             fmt::format("   {:.0f} s", active.session->time()),
         white}};
    if (due != nullptr && lesson.mode != lesson::Mode::assessment) {
        const std::string& id = active.session->assembly().joints[due->joint].design.id;
        lines.push_back({due_text(w, id, *due), white});
        // In a room nobody sees a keyboard.
        if (!active.view.head)
            for (const auto& [key, action] : {std::pair{words::TextKey("hud.ask"), Action::hint},
                                              std::pair{words::TextKey("hud.find_view"), Action::find_view}})
                if (action != Action::find_view || active.view.help)
                    lines.push_back(
                        {words::format_text(w, key, {{"control", key_name(active.input.keys, action)}}),
                         grey});
    }
    text_panel("##step", {12.0F * scale, 12.0F * scale}, {0.0F, 0.0F}, lines, static_cast<float>(size.x));
}

// Instructions and mistakes: at the top centre, where they cover the least of the work.
void draw_hint(const ActiveLesson& active, const HudText& texts, const glm::dvec2& size, float scale) {
    const words::Words& w = *texts.words;
    // Beside the step's panel, even in a small window.
    const float full = static_cast<float>(size.x), beside = full - 240.0F * scale;
    const float width = std::min({560.0F * scale, 0.56F * full, beside});
    const bool narrow = 0.5F * (full + width) > beside;
    std::vector<HudLine> lines;
    const force::Fault fault = active.workplace.world.only<world::DeviceForce>().fault;
    if (fault != force::Fault::none) lines.push_back({w[lesson::text_key(fault)], warm});
    if (active.guidance.mistakes.shown) {
        lines.push_back({lesson::mistake_text(w, *active.guidance.mistakes.shown), warm});
        lines.push_back({lesson::remedy_text(w, *active.guidance.mistakes.shown), white});
        if (undo_repairs(active.guidance.mistakes.shown->kind))
            lines.push_back(
                {active.session->lesson().mode == lesson::Mode::guided
                     ? w["mistake.begins_again"]
                     : words::format_text(w, "mistake.take_back",
                                          {{"control", key_name(active.input.keys, Action::restart_step)}}),
                 pale});
    }
    if (active.guidance.hints.shown) {
        lines.push_back({lesson::hint_text(w, *active.guidance.hints.shown), white});
        if (std::string motion = lesson::motion_text(w, *active.guidance.hints.shown, *texts.controls);
            !motion.empty())
            lines.push_back({std::move(motion), pale});
    }
    text_panel("##hint", {narrow ? full - 12.0F * scale : 0.5F * full, 12.0F * scale},
               {narrow ? 1.0F : 0.5F, 0.0F}, lines, width);
}

void draw_device_messages(const ActiveLesson& active, const words::Words& w, const glm::dvec2& size,
                          float scale) {
    // The screen about the arm explains its needs better.
    if (!active.station || active.station->needs.any()) return;
    std::vector<HudLine> lines;
    if (const auto warning = arm_warning(active.station->health)) lines.push_back({w[*warning], warm});
    for (const std::string& message : active.station->fault_messages) lines.push_back({message, warm});
    text_panel("##fault_messages", {12.0F * scale, static_cast<float>(size.y) - 12.0F * scale}, {0.0F, 1.0F},
               lines, 0.5F * static_cast<float>(size.x));
}

// Captions at the bottom centre, as in films.
void draw_captions(const ActiveLesson& active, const words::Words& w, const glm::dvec2& size, float scale) {
    if (!active.sound.captions) return;
    std::vector<HudLine> lines;
    for (const Caption caption : visible_captions(*active.sound.captions))
        lines.push_back({w[text_key(caption)], white});
    text_panel("##captions", {static_cast<float>(0.5 * size.x), static_cast<float>(size.y) - 72.0F * scale},
               {0.5F, 1.0F}, lines, static_cast<float>(size.x));
}

}  // namespace

void draw_hud(const ActiveLesson& active, const HudText& texts, const glm::dvec2& size, float scale) {
    draw_step(active, *texts.words, size, scale);
    draw_hint(active, texts, size, scale);
    draw_plot(active, *texts.words, size, scale);
    draw_effort(active, *texts.words, size, scale);
    draw_device_messages(active, *texts.words, size, scale);
    draw_captions(active, *texts.words, size, scale);
}

}  // namespace bolt::trainer

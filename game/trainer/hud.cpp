#include "game/trainer/hud.hpp"

#include <fmt/format.h>
#include <imgui/imgui.h>
#include <imgui/imgui_internal.h>  // the public interface has a window's area only while it is being filled

#include <algorithm>
#include <cmath>

#include "game/lesson/feedback.hpp"
#include "game/trainer/active_lesson.hpp"
#include "game/trainer/controls.hpp"

namespace bolt::trainer {

namespace {

constexpr float soft_strike = 0.08F;               // m/s; what is softer is hardly heard
constexpr float slow_slide = 0.02F, light = 1.0F;  // m/s; N
constexpr float slow_run = 2.0F;                   // rad/s
constexpr float some_load = 0.3F;
constexpr double enough_creep = 0.02;    // rad under load: it sticks and lets go some times (sound/synth.cpp)
constexpr double creep_forgotten = 1.0;  // s in which it is
constexpr double lasting = 0.15;         // s that other sounds have to last to be worth a line
constexpr double forgets = 3.0;  // times as fast as they were heard they are forgotten when they have stopped

double& of(std::array<double, caption_count>& all, Caption caption) {
    return all.at(static_cast<std::size_t>(caption));
}

void say(Captions& captions, Caption caption, bool now) {
    if (now) of(captions.left, caption) = caption_stands;
}

// Of what goes on: shares of what it takes to be said. A hand at a mouse moves in jerks, and so do the
// sounds.
void gather(Captions& captions, Caption caption, double more, double less) {
    double& heard = of(captions.heard, caption);
    say(captions, caption, more > 0.0 && heard + more >= 1.0);
    heard = std::clamp(heard + more - less, 0.0, 1.0);
}

void note_lasting(Captions& captions, Caption caption, bool now, double dt) {
    gather(captions, caption, now ? dt / lasting : 0.0, now ? 0.0 : forgets * dt / lasting);
}

}  // namespace

void note(Captions& captions, const sound::Heard& heard, double dt) {
    const bool struck = heard.strike > soft_strike;
    say(captions, Caption::slip, heard.slip > 0.0F);
    say(captions, Caption::mistake, heard.mistake);
    say(captions, Caption::click, heard.click);
    say(captions, Caption::done, heard.done);
    say(captions, Caption::strike_casing, struck && heard.met == sound::Met::casing);
    say(captions, Caption::strike_nut, struck && heard.met == sound::Met::nut);
    const double crept = heard.load > some_load ? static_cast<double>(heard.creep) * dt : 0.0;
    gather(captions, Caption::groan, crept / enough_creep, dt / creep_forgotten);
    note_lasting(captions, Caption::scrape, heard.slide > slow_slide && heard.press > light, dt);
    note_lasting(captions, Caption::run, heard.run > slow_run, dt);
}

void update(Captions& captions, double seconds) {
    for (double& left : captions.left) left = std::max(0.0, left - seconds);
}

std::vector<Caption> shown(const Captions& captions) {
    std::vector<Caption> all;
    for (std::size_t i = 0; i < caption_count && all.size() < most_captions; ++i)
        if (captions.left.at(i) > 0.0) all.push_back(static_cast<Caption>(i));
    return all;
}

words::Key term(Caption caption) {
    constexpr words::Key keys[] = {"caption.slip",  "caption.mistake",       "caption.click",
                                   "caption.done",  "caption.strike_casing", "caption.strike_nut",
                                   "caption.groan", "caption.scrape",        "caption.run"};
    static_assert(std::size(keys) == caption_count);
    return keys[static_cast<std::size_t>(caption)];
}

namespace {

constexpr std::size_t most_points = 4000;
constexpr float seen_angle = 0.02F, seen_torque = 0.2F;  // less than a pixel

std::optional<content::Window> aim_of(const lesson::Lesson& lesson, std::size_t joint) {
    if (lesson.task != lesson::Task::tighten) return std::nullopt;
    const lesson::Step* due = lesson.due();
    const bool its_turn = due != nullptr && due->joint == joint && due->kind != lesson::StepKind::run_down;
    return its_turn ? lesson::window(lesson, *due) : lesson.assembly->joints[joint].spec.torque;
}

}  // namespace

void note(Plot& plot, const lesson::Lesson& lesson,
          const ecs::Access<const world::Joint, const world::ToolContact>& world) {
    const std::int16_t engaged = world.only<world::ToolContact>().joint;
    if (engaged < 0) return;
    if (engaged != plot.joint) plot.points.clear();
    plot.joint = engaged;
    plot.aim = aim_of(lesson, static_cast<std::size_t>(plot.joint));
    const world::Joint& joint = world::joint_at(world, static_cast<std::size_t>(plot.joint));
    const PlotPoint now{static_cast<float>(to_degrees(joint.angle)), static_cast<float>(joint.torque)};
    const bool same = !plot.points.empty() && std::abs(plot.points.back().angle - now.angle) < seen_angle &&
                      std::abs(plot.points.back().torque - now.torque) < seen_torque;
    if (!same && plot.points.size() < most_points) plot.points.push_back(now);
}

std::vector<render::Rectangle> occupied_areas() {
    std::vector<render::Rectangle> plates;
    for (const ImGuiWindow* window : ImGui::GetCurrentContext()->Windows) {
        const bool own = (window->Flags & ImGuiWindowFlags_ChildWindow) == 0 && !window->IsFallbackWindow;
        if (!own || !window->Active || window->Hidden) continue;
        const ImVec2 high = {window->Pos.x + window->Size.x, window->Pos.y + window->Size.y};
        plates.push_back({{window->Pos.x, window->Pos.y}, {high.x, high.y}});
    }
    return plates;
}

namespace {

constexpr ImGuiWindowFlags still = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                   ImGuiWindowFlags_NoInputs | ImGuiWindowFlags_NoSavedSettings |
                                   ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav;

constexpr ImU32 grid = IM_COL32(150, 160, 170, 60), frame_color = IM_COL32(200, 205, 210, 160),
                curve = IM_COL32(255, 205, 70, 255), strain_color = IM_COL32(255, 120, 80, 255);

void text(const std::string& line) { ImGui::TextUnformatted(line.c_str(), line.c_str() + line.size()); }

ImU32 in_color(const glm::vec4& color, float opacity) {
    return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, opacity * color.a});
}

void plate(const char* name, const ImVec2& at, const ImVec2& pivot, ImGuiWindowFlags flags) {
    ImGui::SetNextWindowPos(at, ImGuiCond_Always, pivot);
    ImGui::SetNextWindowBgAlpha(0.78F);
    ImGui::Begin(name, nullptr, flags);
}

// Of what has always the same size.
void plate(const char* name, const ImVec2& at, const ImVec2& pivot) {
    plate(name, at, pivot, still | ImGuiWindowFlags_AlwaysAutoResize);
}

struct Line {
    std::string text;
    ImVec4 color;
};

const ImVec4 white(0.96F, 0.97F, 0.98F, 1.0F), pale(0.75F, 0.85F, 0.95F, 1.0F), warm(1.0F, 0.6F, 0.5F, 1.0F),
    grey(0.5F, 0.5F, 0.5F, 1.0F);

// As large as its lines from its first picture on: ImGui's own fit is a picture late, and where pictures take
// long half a sentence is read.
void plate_of(const char* name, const ImVec2& at, const ImVec2& pivot, std::span<const Line> lines,
              float widest) {
    if (lines.empty()) return;
    const ImGuiStyle& style = ImGui::GetStyle();
    ImVec2 size(0.0F, -style.ItemSpacing.y);
    for (const Line& line : lines) {
        const char* begin = line.text.c_str();
        const ImVec2 taken =
            ImGui::CalcTextSize(begin, begin + line.text.size(), false, widest - style.WindowPadding.x);
        size = {std::max(size.x, taken.x), size.y + style.ItemSpacing.y + taken.y};
    }
    ImGui::SetNextWindowSize({size.x + 2.0F * style.WindowPadding.x, size.y + 2.0F * style.WindowPadding.y});
    plate(name, at, pivot, still);
    ImGui::PushTextWrapPos(widest);
    for (const Line& line : lines) {
        ImGui::PushStyleColor(ImGuiCol_Text, line.color);
        text(line.text);
        ImGui::PopStyleColor();
    }
    ImGui::PopTextWrapPos();
    ImGui::End();
}

// Torque over the nut's angle, with the window that is to be reached.
void draw_plot(const ActiveLesson& p, const words::Words& w, const glm::dvec2& size, float scale) {
    const std::vector<PlotPoint>& points = p.plot.points;
    if (points.size() < 2) return;
    const auto joint = static_cast<std::size_t>(p.plot.joint);
    const content::Specification& spec = p.course->assembly().joints[joint].spec;
    const ImVec2 area(260.0F * scale, 150.0F * scale);
    plate("##plot", {static_cast<float>(size.x) - 12.0F * scale, static_cast<float>(size.y) - 12.0F * scale},
          {1.0F, 1.0F});
    text(words::say(w, "hud.curve", {{"joint", p.course->assembly().joints[joint].design.id}}));
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
    if (p.plot.aim && p.course->lesson().mode != lesson::Mode::assessment) {
        const ImVec2 top = place(begin, static_cast<float>(p.plot.aim->high)),
                     foot = place(begin + across, static_cast<float>(p.plot.aim->low));
        // A band and its edges: it is one without any colour.
        list.AddRectFilled(top, foot, in_color(p.palette.ok, 0.24F));
        list.AddRect(top, foot, in_color(p.palette.ok, 0.9F));
    }
    list.AddLine(place(begin, 0.0F), place(begin + across, 0.0F), grid);
    list.AddRect(low, {low.x + area.x, low.y + area.y}, frame_color);
    for (std::size_t i = 1; i < points.size(); ++i)
        list.AddLine(place(points[i - 1].angle, points[i - 1].torque),
                     place(points[i].angle, points[i].torque), curve, 2.0F * scale);
    ImGui::End();
}

// How hard the hand pulls: what a device would let it feel.
void draw_strain(const ActiveLesson& p, const words::Words& w, const glm::dvec2& size, float scale) {
    const std::int16_t engaged = contact_of(p).joint;
    if (engaged < 0 || !hand_of(p).wrench) return;
    const servo::Setup& setup = p.course->setup();
    const world::Joint& joint = world::joint_at(p.place.world, static_cast<std::size_t>(engaged));
    const double force = std::abs(joint.torque) / setup.wrench.handle_length;
    const double greatest = setup.wrench.stiffness * to_radians(2.5) / setup.wrench.handle_length;
    const auto share = static_cast<float>(std::clamp(force / greatest, 0.0, 1.0));
    plate("##strain", {static_cast<float>(0.5 * size.x), static_cast<float>(size.y) - 12.0F * scale},
          {0.5F, 1.0F});
    text(words::say(w, "hud.pull", {{"force", words::Number{force, 0}}}));
    const ImVec2 low = ImGui::GetCursorScreenPos(), area(260.0F * scale, 12.0F * scale);
    ImGui::Dummy(area);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, {low.x + area.x * share, low.y + area.y}, strain_color, 3.0F * scale);
    list.AddRect(low, {low.x + area.x, low.y + area.y}, frame_color, 3.0F * scale);
    ImGui::End();
}

void draw_step(const ActiveLesson& p, const words::Words& w, const glm::dvec2& size, float scale) {
    const lesson::Lesson& lesson = p.course->lesson();
    const lesson::Step* due = trainer::due(p.undo, lesson);
    const auto whole = [](std::size_t n) { return words::Number{static_cast<double>(n), 0}; };
    const std::size_t steps = lesson.steps.size();
    const std::size_t at = due == nullptr ? steps : static_cast<std::size_t>(due - lesson.steps.data()) + 1;
    std::vector<Line> lines{{words::say(w, "hud.step", {{"step", whole(at)}, {"of", whole(steps)}}) +
                                 fmt::format("   {:.0f} s", p.course->time()),
                             white}};
    if (due != nullptr && lesson.mode != lesson::Mode::assessment) {
        const std::string& id = p.course->assembly().joints[due->joint].design.id;
        const std::string& what = w[lesson::term(due->kind)];
        lines.push_back(
            {due->kind == lesson::StepKind::tighten
                 ? words::say(w, "hud.due_torque",
                              {{"joint", id}, {"what", what}, {"torque", words::torque_number(due->torque)}})
                 : words::say(w, "hud.due", {{"joint", id}, {"what", what}}),
             white});
        for (const auto& [key, action] : {std::pair{words::Key("hud.ask"), Action::hint},
                                          std::pair{words::Key("hud.find_view"), Action::find_view}})
            lines.push_back({words::say(w, key, {{"control", key_name(p.controls.keys, action)}}), grey});
    }
    plate_of("##step", {12.0F * scale, 12.0F * scale}, {0.0F, 0.0F}, lines, static_cast<float>(size.x));
}

// What is to be done, and what went wrong: in the middle above, where it hides the least of the work.
void draw_hint(const ActiveLesson& p, const Said& said, const glm::dvec2& size, float scale) {
    const words::Words& w = *said.words;
    // Beside the step's plate, also in a small window.
    const float whole = static_cast<float>(size.x), beside = whole - 240.0F * scale;
    const float width = std::min({560.0F * scale, 0.56F * whole, beside});
    const bool narrow = 0.5F * (whole + width) > beside;
    std::vector<Line> lines;
    const force::Fault fault = p.place.world.only<world::DeviceForce>().fault;
    if (fault != force::Fault::none) lines.push_back({w[lesson::term(fault)], warm});
    if (p.coaching.mistakes.shown) {
        lines.push_back({lesson::say_why(w, *p.coaching.mistakes.shown), warm});
        lines.push_back({lesson::say_what_to_do(w, *p.coaching.mistakes.shown), white});
        lines.push_back({p.course->lesson().mode == lesson::Mode::guided
                             ? w["mistake.begins_again"]
                             : words::say(w, "mistake.take_back",
                                          {{"control", key_name(p.controls.keys, Action::restart_step)}}),
                         pale});
    }
    if (p.coaching.hints.shown) {
        lines.push_back({lesson::say(w, *p.coaching.hints.shown), white});
        if (std::string motion = lesson::say_motion(w, *p.coaching.hints.shown, *said.controls);
            !motion.empty())
            lines.push_back({std::move(motion), pale});
    }
    plate_of("##hint", {narrow ? whole - 12.0F * scale : 0.5F * whole, 12.0F * scale},
             {narrow ? 1.0F : 0.5F, 0.0F}, lines, width);
}

// What is wrong with the devices, in their own words.
void draw_troubles(const ActiveLesson& p, const glm::dvec2& size, float scale) {
    if (!p.station) return;
    std::vector<Line> lines;
    for (const std::string& trouble : p.station->troubles) lines.push_back({trouble, warm});
    plate_of("##troubles", {12.0F * scale, static_cast<float>(size.y) - 12.0F * scale}, {0.0F, 1.0F}, lines,
             0.5F * static_cast<float>(size.x));
}

// What there is to be heard, in words, where films have it.
void draw_captions(const ActiveLesson& p, const words::Words& w, const glm::dvec2& size, float scale) {
    if (!p.sound.captions) return;
    std::vector<Line> lines;
    for (const Caption caption : shown(*p.sound.captions)) lines.push_back({w[term(caption)], white});
    plate_of("##captions", {static_cast<float>(0.5 * size.x), static_cast<float>(size.y) - 72.0F * scale},
             {0.5F, 1.0F}, lines, static_cast<float>(size.x));
}

}  // namespace

void draw_hud(const ActiveLesson& p, const Said& said, const glm::dvec2& size, float scale) {
    draw_step(p, *said.words, size, scale);
    draw_hint(p, said, size, scale);
    draw_plot(p, *said.words, size, scale);
    draw_strain(p, *said.words, size, scale);
    draw_troubles(p, size, scale);
    draw_captions(p, *said.words, size, scale);
}

}  // namespace bolt::trainer

#include "game/view/walls.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

#include "content/displays/panel_fit.hpp"
#include "content/displays/wall_geometry.hpp"

namespace bolt::view {

namespace {

constexpr float wall_near = 0.05F, wall_far = 100.0F;  // m

std::uint32_t eye_count(const content::Wall& wall) {
    return wall.stereo == content::StereoMode::mono ? 1 : 2;
}

Error output_error(const content::Wall& wall, std::string what, std::string expected) {
    return {ErrorCode::no_device, fmt::format("wall \"{}\": {}", wall.name, std::move(what)),
            std::move(expected)};
}

Error missing_process(const content::Wall& wall, int process, int processes) {
    Error error = output_error(
        wall,
        processes == 1
            ? fmt::format("its output has rank {}, and the program was started alone", process)
            : fmt::format("its output has rank {}, and there are {} processes", process, processes),
        fmt::format("mpirun -n {} or more (docs/displays.md)", process + 1));
    error.code = ErrorCode::usage;
    return error;
}

std::string monitor_names(std::span<const content::HostMonitor> monitors) {
    std::string all;
    for (const content::HostMonitor& monitor : monitors)
        all += (all.empty() ? "" : ", ") + fmt::format("\"{}\"", monitor.name);
    return all.empty() ? "a connected monitor" : all;
}

Result<platform::DesktopArea> area_of(const content::Wall& wall, const content::DisplayOutput& output,
                                      const content::DisplayHost& host) {
    if (!output.display.empty() && !content::is_same_display(output.display, host.display))
        return fail(output_error(wall, fmt::format("its output is on X display \"{}\"", output.display),
                                 fmt::format("\"{}\", which DISPLAY names", host.display)));
    if (output.position) {
        const content::PixelSize size = output.resolution.value_or(content::PixelSize{});
        return platform::DesktopArea{output.position->x, output.position->y, size.width, size.height};
    }
    const content::HostMonitor* named = content::find_monitor(output, host.monitors);
    if (named == nullptr)
        return fail(output_error(wall,
                                 output.monitor_index
                                     ? fmt::format("there is no monitor {}", *output.monitor_index)
                                     : fmt::format("there is no monitor \"{}\"", output.monitor),
                                 monitor_names(host.monitors)));
    return platform::DesktopArea{named->x, named->y, named->width, named->height};
}

}  // namespace

EyeGroup wall_eyes(const content::Wall& wall, const Pose& head, double eye_separation, VkExtent2D size) {
    EyeGroup group{size, {}};
    const std::uint32_t eyes = eye_count(wall);
    const Vec3 normal = glm::cross(wall.lower_right - wall.lower_left, wall.upper_right - wall.lower_right);
    for (std::uint32_t eye = 0; eye < eyes; ++eye) {
        const double side = eyes == 1 ? 0.0 : (eye == 0 ? -0.5 : 0.5);
        const Vec3 position = head * Vec3(side * eye_separation, 0.0, 0.0);
        if (glm::dot(position - wall.lower_left, normal) <=
            static_cast<double>(wall_near) * glm::length(normal))
            return {size, {}};
        group.eyes.push_back(render::make_wall_eye(
            glm::vec3(position), glm::vec3(wall.lower_left), glm::vec3(wall.lower_right),
            glm::vec3(content::upper_left(wall)), wall_near, wall_far));
    }
    return group;
}

bool on_a_wall(std::span<const content::Wall> walls, const Vec3& eye, const Vec3& point) {
    return std::any_of(walls.begin(), walls.end(), [&](const content::Wall& wall) {
        const content::WallAxes axes = content::axes_of(wall);
        const double from = content::distance_in_front(axes, eye),
                     towards = from - content::distance_in_front(axes, point);
        if (from <= 0.0 || towards <= 0.0) return false;
        const Vec3 seen = eye + from / towards * (point - eye) - axes.origin;
        const double x = glm::dot(seen, axes.right), y = glm::dot(seen, axes.up);
        return x >= 0.0 && x <= axes.width && y >= 0.0 && y <= axes.height;
    });
}

content::DisplayHost this_host(const platform::Desktop& desktop, const cluster::Cluster* cluster) {
    content::DisplayHost host;
    if (cluster != nullptr) {
        host.process = cluster->process();
        host.processes = cluster->size();
    }
    for (const platform::Monitor& monitor : platform::monitors(desktop))
        host.monitors.push_back(
            {monitor.name, monitor.area.x, monitor.area.y, monitor.area.width, monitor.area.height});
    // NOLINTNEXTLINE(concurrency-mt-unsafe): before any thread
    if (const char* display = std::getenv("DISPLAY")) host.display = display;
    return host;
}

Result<std::vector<WallWindow>> plan_wall_windows(const content::DisplayFile& displays,
                                                  const content::DisplayHost& host) {
    std::vector<WallWindow> windows;
    for (std::size_t i = 0; i < displays.walls.size(); ++i) {
        const content::Wall& wall = displays.walls[i];
        const bool two = wall.right_output.has_value();
        const auto add = [&](const content::DisplayOutput& output, WallWindow::Shows shows) -> Status {
            if (output.process >= host.processes)
                return fail(missing_process(wall, output.process, host.processes));
            if (output.process != host.process) return {};
            BOLT_TRY_ASSIGN(const auto area, area_of(wall, output, host));
            windows.push_back({"Boltwright: " + wall.name, area, i, shows});
            return {};
        };
        BOLT_TRY(add(wall.output, two ? WallWindow::Shows::left_output : WallWindow::Shows::all));
        if (two) BOLT_TRY(add(*wall.right_output, WallWindow::Shows::right_output));
    }
    // The first process has the control window.
    if (windows.empty() && host.process > 0)
        return fail(ErrorCode::usage, fmt::format("process {} shows no wall", host.process),
                    "as many processes as the display file has ranks");
    return windows;
}

std::vector<EyeViewport> eye_viewports(const content::Wall& wall, WallWindow::Shows shows,
                                       VkExtent2D window) {
    const std::uint32_t first = wall.swap_eyes ? 1 : 0, second = 1 - first;
    const auto offset = [](std::uint32_t x, std::uint32_t y) {
        return VkOffset2D{static_cast<std::int32_t>(x), static_cast<std::int32_t>(y)};
    };
    const std::uint32_t half_width = window.width / 2, half_height = window.height / 2;
    switch (wall.stereo) {
        case content::StereoMode::mono:
            return {{0, {{0, 0}, window}}};
        case content::StereoMode::side_by_side:
            return {{first, {{0, 0}, {half_width, window.height}}},
                    {second, {offset(half_width, 0), {window.width - half_width, window.height}}}};
        case content::StereoMode::top_bottom:
            return {{first, {{0, 0}, {window.width, half_height}}},
                    {second, {offset(0, half_height), {window.width, window.height - half_height}}}};
        case content::StereoMode::two_outputs:
            return {{shows == WallWindow::Shows::right_output ? second : first, {{0, 0}, window}}};
    }
    return {};
}

Result<std::unique_ptr<Walls>> Walls::open(const platform::Desktop& desktop, WallsOptions options) {
    BOLT_TRY_ASSIGN(const auto plan,
                    plan_wall_windows(options.displays, this_host(desktop, options.cluster)));
    std::unique_ptr<Walls> walls(new Walls);
    for (const WallWindow& wanted : plan) {
        platform::WindowOptions window_options;
        window_options.title = wanted.title;
        window_options.covers = wanted.area;
        BOLT_TRY_ASSIGN(auto window, platform::Window::open(desktop, window_options));
        walls->outputs_.push_back({wanted, std::move(window), nullptr, {}});
    }
    walls->displays_ = std::move(options.displays);
    if (const auto fit = content::fit_panel(walls->displays_.walls, walls->displays_.head.fixed_head))
        walls->panel_ = PanelPlace{fit->pose, fit->point_size};
    walls->head_ = std::move(options.head);
    walls->cluster_ = options.cluster;
    walls->log_ = std::move(options.log);
    return walls;
}

Walls::~Walls() {
    if (!leader_) return;
    if (log_ && frame_ > 0) log_(leader_->summary());
    leader_->end({});
}

Status Walls::wait_for_processes(std::uint64_t fingerprint, StopWaiting stop) {
    if (cluster_ == nullptr || cluster_->process() != 0) return {};
    BOLT_TRY_ASSIGN(auto leader, WallLeader::begin(*cluster_, fingerprint, std::move(stop), log_));
    leader_.emplace(std::move(leader));
    return {};
}

Result<gpu::Surface> Walls::make_surface(const gpu::Instance& instance) {
    return outputs_.front().window.make_surface(instance);
}

Status Walls::share(const ImmersiveFrame& immersive, const cluster::Message& content,
                    const cluster::Message& bulk) {
    ClusterFrame frame;
    frame.number = ++frame_;
    frame.head = immersive.head;
    frame.tracked = immersive.tracked;
    frame.content = content;
    frame.bulk = bulk;
    return leader_->send(frame);
}

Status Walls::wait_for_others() {
    BOLT_TRY_ASSIGN(const auto events, leader_->wait_until_drawn());
    events_of_others_.insert(events_of_others_.end(), events.begin(), events.end());
    return leader_->permit();
}

Status Walls::start(gpu::Device& device, const gpu::Instance& instance) {
    for (Output& output : outputs_) {
        const gpu::MakeSurface make_surface = [&output, &instance] {
            return output.window.make_surface(instance);
        };
        BOLT_TRY_ASSIGN(auto surface, make_surface());
        VkBool32 presents = VK_FALSE;
        BOLT_TRY(gpu::check(vkGetPhysicalDeviceSurfaceSupportKHR(device.physical(), device.queue_family(),
                                                                 surface.get(), &presents),
                            "querying the window of a wall"));
        if (presents != VK_TRUE)
            return fail(output_error(displays_.walls[output.plan.wall],
                                     "the GPU cannot present to the window's display",
                                     "walls and control window on one GPU"));
        BOLT_TRY_ASSIGN(auto swapchain, gpu::Swapchain::create(device, std::move(surface), make_surface));
        output.swapchain = std::move(swapchain);
    }
    return {};
}

void Walls::release() {
    for (Output& output : outputs_) output.swapchain.reset();
}

std::vector<platform::InputEvent> Walls::poll_events() {
    std::vector<platform::InputEvent> events = std::exchange(events_of_others_, {});
    for (Output& output : outputs_)
        for (const platform::InputEvent& event : output.window.poll_events())
            if (std::holds_alternative<platform::KeyEvent>(event) ||
                std::holds_alternative<platform::TextEvent>(event) ||
                std::holds_alternative<platform::CloseEvent>(event))
                events.push_back(event);
    return events;
}

// Logs a change of the tracker's state.
void Walls::log_status(tracking::HeadStatus status) {
    const bool first = !logged_status_;
    if (logged_status_ == status) return;
    logged_status_ = status;
    if (!log_) return;
    switch (status) {
        case tracking::HeadStatus::tracked:
            log_(first ? "head: tracked" : "head: tracked again");
            break;
        case tracking::HeadStatus::held:
            log_("head: not tracked; its last pose is used");
            break;
        case tracking::HeadStatus::faded:
            log_("head: not tracked; the fixed pose of the display file is used");
            break;
    }
}

// The wand as a hand that points and has no place of its own.
static xr::HandInput hand_of(const head_tracking::Wand& wand) {
    xr::HandInput hand;
    hand.active = true;
    if (wand.aim) hand.aim = xr::ReportedPose{*wand.aim, true};
    hand.select = wand.select ? 1.0F : 0.0F;
    hand.menu = wand.menu;
    hand.secondary = wand.tool;
    hand.stick = glm::vec2(wand.stick_x, wand.stick_y);
    return hand;
}

Result<ImmersiveFrame> Walls::begin_frame(double now) {
    const tracking::FilteredHead head = head_->at(now);
    const bool fixed = displays_.head.tracker == content::HeadTracker::fixed;
    if (!fixed) log_status(head.status);
    BOLT_TRY_ASSIGN(ImmersiveFrame immersive,
                    begin_frame(head.pose, fixed || head.status == tracking::HeadStatus::tracked));
    if (head_->wand()) immersive.hands[Side::right] = hand_of(*head_->wand());
    return immersive;
}

Result<ImmersiveFrame> Walls::begin_frame(const Pose& head, bool tracked) {
    ImmersiveFrame immersive;
    immersive.head = head;
    immersive.tracked = tracked;
    immersive.expected_head = displays_.head.fixed_head;
    immersive.shows = [this](const Vec3& point) {
        return on_a_wall(displays_.walls, displays_.head.fixed_head.position, point);
    };
    immersive.panel = panel_;
    immersive.attentive = true;
    for (const content::Wall& wall : displays_.walls) {
        VkExtent2D size{};
        for (Output& output : outputs_) {
            if (&displays_.walls[output.plan.wall] != &wall) continue;
            const platform::Size pixels = output.window.pixels();
            BOLT_TRY_ASSIGN(output.size, output.swapchain->prepare({pixels.width, pixels.height}));
            for (const EyeViewport& viewport : eye_viewports(wall, output.plan.shows, output.size)) {
                size.width = std::max(size.width, viewport.area.extent.width);
                size.height = std::max(size.height, viewport.area.extent.height);
            }
        }
        const bool visible = size.width > 0 && size.height > 0;
        immersive.groups.push_back(visible ? wall_eyes(wall, head, displays_.eye_separation, size)
                                           : EyeGroup{});
    }
    return immersive;
}

void Walls::add_pictures(const render::Renderer& renderer, const ImmersiveFrame& immersive,
                         std::vector<gpu::WindowPictures>& windows) const {
    for (const Output& output : outputs_) {
        gpu::WindowPictures window{output.swapchain.get(), {}, true};
        const std::size_t wall = output.plan.wall;
        const bool drawn = !immersive.groups[wall].eyes.empty();
        if (drawn) {
            for (const EyeViewport& viewport :
                 eye_viewports(displays_.walls[wall], output.plan.shows, output.size)) {
                const render::ImageLayer picture =
                    renderer.picture(viewport.eye, immersive_group + static_cast<std::uint32_t>(wall));
                window.pictures.push_back({picture.image, picture.layer, {}, viewport.area});
            }
        }
        windows.push_back(std::move(window));
    }
}

double Walls::refresh_rate() const {
    double lowest = 0.0;
    for (const Output& output : outputs_) {
        const double rate = output.window.refresh_rate();
        if (rate > 0.0 && (lowest == 0.0 || rate < lowest)) lowest = rate;
    }
    return lowest;
}

}  // namespace bolt::view

#include "game/computer/computer.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <thread>

#include "engine/base/process.hpp"
#include "game/session/contact_models.hpp"
#include "game/session/lesson_session.hpp"

namespace bolt::computer {

namespace {

namespace fs = std::filesystem;

// A load for the servo: a hand that lowers the wrench onto the first nut and lifts it once a second. The
// wrench is rotated by 8° from a fit and collides with the nut, so that contacts, god-object, guiding and
// output stage all compute.
servo::TickInput working_input(const servo::Setup& setup, const servo::State& state) {
    const servo::NutGeometry& nut = setup.nuts.front();
    const double time = static_cast<double>(state.tick) * setup.dt;
    const Vec3 at = servo::nut_centre(nut, 0.0) + nut.axis * (0.014 + 0.012 * std::cos(2.0 * pi * time));
    // The handle points away from the casing, beyond the flange's edge.
    const double handle = setup.wrench.head_angle + to_radians(8.0) + (nut.seat.z > 0.0 ? 0.5 : 1.5) * pi;
    const double nearest =
        std::round(handle / (pi / 3.0)) * (pi / 3.0) + setup.wrench.head_angle + to_radians(8.0);
    const Vec3 x = std::cos(-nearest) * nut.e1 + std::sin(-nearest) * nut.e2;
    const Quat q = glm::normalize(glm::quat_cast(glm::dmat3(x, glm::cross(nut.axis, x), nut.axis)));
    servo::TickInput input;
    input.commanded_tool = servo::to_commanded_tool({at, q});
    input.grip = servo::Grip::wrench;
    input.dead_man = true;
    input.guided_joint = 0;
    return input;
}

// The folder, or the nearest of its parents that exists.
fs::path existing_part(fs::path folder) {
    std::error_code ignored;
    folder = fs::absolute(folder, ignored);
    while (!fs::is_directory(folder, ignored) && folder.has_relative_path()) folder = folder.parent_path();
    return folder;
}

words::TextArgument why(const Error& error) { return {"why", error.message()}; }

Finding gpu_finding(const ComputerFacts& facts) {
    if (!facts.gpu)
        return {Severity::bad,
                "finding.gpu_none",
                {why(facts.gpu.error())},
                words::TextKey("finding.gpu_none.do")};
    if (facts.gpu->software)
        return {Severity::limited,
                "finding.gpu_software",
                {{"gpu", facts.gpu->name}},
                words::TextKey("finding.gpu_software.do")};
    return {Severity::good, "finding.gpu", {{"gpu", facts.gpu->name}}, {}};
}

Finding sound_finding(const ComputerFacts& facts) {
    if (facts.sound) return {Severity::good, "finding.sound", {{"name", *facts.sound}}, {}};
    return {Severity::limited,
            "finding.no_sound",
            {why(facts.sound.error())},
            words::TextKey("finding.no_sound.do")};
}

void add_devices(const ComputerFacts& facts, std::vector<Finding>& all) {
    bool any = false, force = false;
    for (const device::ListedDevice& listed : facts.devices) {
        if (listed.kind == device::DeviceKind::other) continue;
        any = true;
        force = force || listed.kind != device::DeviceKind::puck;
        if (!listed.usable()) {
            // No remedy of our own: the error names one.
            all.push_back({Severity::limited,
                           "finding.device_refused",
                           {{"name", listed.name}, why(*listed.error)},
                           {}});
            continue;
        }
        all.push_back({Severity::good, "finding.device", {{"name", listed.name}}, {}});
    }
    if (!any)
        all.push_back({Severity::limited, "finding.no_device", {}, words::TextKey("finding.no_device.do")});
    else if (!force)
        all.push_back({Severity::limited, "finding.no_force", {}, words::TextKey("finding.no_force.do")});
}

void add_timing(const ComputerFacts& facts, std::vector<Finding>& all) {
    if (!facts.timing) return;
    if (!*facts.timing) {
        all.push_back({Severity::limited, "finding.timing_failed", {why(facts.timing->error())}, {}});
        return;
    }
    const ServoTiming& measured = **facts.timing;
    if (measured.assessment.adequate)
        all.push_back({Severity::good, "finding.timing", {}, {}});
    else
        all.push_back({Severity::limited,
                       "finding.timing_bad",
                       {{"why", measured.assessment.reasons.front()}},
                       words::TextKey("finding.timing_bad.do")});
    for (const std::string& refused : measured.privileges.refused)
        all.push_back({Severity::limited,
                       "finding.privilege",
                       {{"why", refused}},
                       words::TextKey("finding.privilege.do")});
}

Finding disk_finding(const ComputerFacts& facts) {
    if (!facts.folder_error.empty())
        return {Severity::bad,
                "finding.folder",
                {{"folder", facts.sessions.string()}, {"why", facts.folder_error}},
                words::TextKey("finding.folder.do")};
    const words::TextArgument free{"free", words::Number{facts.free_space / 1e9, 1}};
    if (facts.free_space < min_free_space)
        return {Severity::bad, "finding.disk_low", {free}, words::TextKey("finding.disk_low.do")};
    return {Severity::good, "finding.disk", {free}, {}};
}

}  // namespace

Result<GpuFacts> find_gpu() {
    BOLT_TRY_ASSIGN(const auto instance, gpu::Instance::create({}));
    BOLT_TRY_ASSIGN(const auto found, gpu::survey_devices(instance, {}));
    if (found.choice.index < 0)
        return fail(ErrorCode::no_device, "no Vulkan device can be used",
                    "a driver, such as lavapipe of the package mesa-vulkan-drivers");
    const gpu::DeviceCandidate& used = found.candidates[static_cast<std::size_t>(found.choice.index)];
    return GpuFacts{used.name, used.type == VK_PHYSICAL_DEVICE_TYPE_CPU};
}

Result<std::vector<ServoTiming>> time_servo(const std::string& assembly, const std::vector<double>& rates,
                                            double seconds) {
    const content::LoadedAssembly loaded = content::load_assembly(assembly);
    if (!loaded.ok()) return fail(loaded.errors.front());
    std::vector<ServoTiming> timings;
    std::optional<servo::ToolContact> contact;  // loaded once, because it takes seconds
    for (const double rate : rates) {
        const servo::Setup setup =
            session::make_setup(loaded.assembly, loaded.assembly.law, force::OutputLimits{}, 0, 1.0 / rate);
        servo::State state = servo::initial_state(setup);
        if (!contact) {
            BOLT_TRY_ASSIGN(auto made, session::load_tool_contact(loaded.assembly, setup));
            contact = std::move(made);
        }
        if (contact) servo::set_coupling(setup, *contact);
        state.tool_contact = std::move(contact);
        // The first tick computes all distance bounds.
        servo::tick(setup, state, working_input(setup, state));
        servo::ThreadOptions options;
        options.rate = rate;
        BOLT_TRY_ASSIGN(auto thread, servo::ServoThread::start(options, [&](const servo::Deadline&) {
                            servo::tick(setup, state, working_input(setup, state));
                            return true;
                        }));
        std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
        thread.stop();
        contact = std::move(state.tool_contact);
        timings.push_back(
            {rate, thread.timing(), thread.privileges(), servo::assess_host(thread.timing(), rate)});
    }
    return timings;
}

ComputerFacts gather_facts(const FactsRequest& request) {
    ComputerFacts facts;
    facts.gpu = request.gpu;
    if (auto sink = request.open_sound())
        facts.sound = (*sink)->name();
    else
        facts.sound = fail(sink.error());
    facts.devices = device::list_devices();
    facts.sessions = request.sessions;
    const fs::path folder = existing_part(request.sessions);
    std::error_code problem;
    facts.free_space = static_cast<double>(fs::space(folder, problem).available);
    if (problem)
        facts.folder_error = problem.message();
    else if (access(folder.c_str(), W_OK | X_OK) != 0)
        facts.folder_error = std::strerror(errno);  // NOLINT(concurrency-mt-unsafe): read at once
    facts.films = run_program({"ffmpeg", "-version"}, Capture::output_and_errors).has_value();
    if (request.seconds > 0.0) {
        auto timings = time_servo(request.assembly, {1000.0}, request.seconds);
        if (timings)
            facts.timing = std::move(timings->front());
        else
            facts.timing = Result<ServoTiming>(fail(timings.error()));
    }
    return facts;
}

std::vector<Finding> findings(const ComputerFacts& facts) {
    std::vector<Finding> all{gpu_finding(facts), disk_finding(facts), sound_finding(facts)};
    add_devices(facts, all);
    add_timing(facts, all);
    if (facts.films)
        all.push_back({Severity::good, "finding.films", {}, {}});
    else
        all.push_back({Severity::limited, "finding.no_films", {}, words::TextKey("finding.no_films.do")});
    std::stable_sort(all.begin(), all.end(),
                     [](const Finding& a, const Finding& b) { return a.severity > b.severity; });
    return all;
}

std::string describe(const words::Words& words, const std::vector<Finding>& findings) {
    std::string text;
    for (const Finding& finding : findings) {
        const char* mark = finding.severity == Severity::good  ? "ok  "
                           : finding.severity == Severity::bad ? "BAD "
                                                               : "note";
        text += fmt::format("  {} {}\n", mark, words::format_text(words, finding.text, finding.arguments));
        if (finding.remedy) text += fmt::format("       {}\n", words[*finding.remedy]);
    }
    return text;
}

}  // namespace bolt::computer

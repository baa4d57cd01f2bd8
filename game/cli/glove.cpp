// boltwright glove: calibrates a glove for a trainee, imports a vendor's calibration, and shows the joint
// angles that a glove measures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <ctime>
#include <memory>
#include <thread>

#include "content/trainee/glove_calibration.hpp"
#include "engine/base/file.hpp"
#include "engine/base/result.hpp"
#include "engine/base/serial_port.hpp"
#include "engine/base/steady_seconds.hpp"
#include "game/cli/commands.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/measured_hand.hpp"

namespace bolt::cli {

namespace {

namespace fs = std::filesystem;

constexpr double frame_timeout = 10.0;  // s, for the first frame of a glove
constexpr double port_timeout = 1.0;    // s, for the port to open
constexpr auto poll_period = std::chrono::milliseconds(5);

struct GloveArguments {
    std::string port, trainee, folder, file, hand = "right";
    std::size_t sensors = 18;
    double hand_length_mm = 1e3 * hand::skeleton_length;
    double seconds = 10.0;
};

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))); }

Result<fs::path> calibration_folder(const GloveArguments& options) {
    return options.folder.empty() ? station_setup::calibrations_folder() : fs::path(options.folder);
}

// Returns every sample of a glove once.
struct GloveReader {
    hand::GloveDriver driver;
    std::uint64_t last = 0;
    // The next sample; null: there is none yet.
    const hand::GloveSample* next() {
        const hand::GloveSample& sample = driver.sample();
        if (sample.number == last) return nullptr;
        last = sample.number;
        return &sample;
    }
};

// Opens the glove on the port of the options, or on the only serial port, and waits for its first frame.
Result<GloveReader> open(GloveArguments& options) {
    if (options.port.empty()) {
        const std::vector<fs::path> ports = serial_ports();
        if (ports.size() != 1)
            return fail(ErrorCode::no_device,
                        ports.empty() ? "there is no serial port for a glove"
                                      : fmt::format("there are {} serial ports", ports.size()),
                        ports.empty()
                            ? "the glove's adapter plugged in, or its port given with --port"
                            : "the glove's port given with --port, such as " + ports.front().string());
        options.port = ports.front().string();
    }
    GloveReader reader{hand::GloveDriver::start(options.port)};
    for (const double from = steady_seconds(); steady_seconds() - from < frame_timeout;
         std::this_thread::sleep_for(poll_period)) {
        if (reader.next() != nullptr) return reader;
        if (!reader.driver.report().open && steady_seconds() - from > port_timeout) break;
    }
    const hand::GloveReport& report = reader.driver.report();
    return fail(ErrorCode::no_device,
                report.fault_message[0] != '\0' ? std::string(report.fault_message.data())
                                                : options.port + ": no glove answers",
                report.open ? "a glove that is switched on and connected to its box" : "");
}

// The person who wears the glove. A new name gets a code.
Result<content::Person> wearer_of(const GloveArguments& options) {
    BOLT_TRY_ASSIGN(const auto folder, calibration_folder(options));
    return person_argument(options.trainee, folder, NewPerson::added);
}

// Completes and saves the calibration. Returns a message with its path.
Result<std::string> save(const GloveArguments& options, const content::Person& person,
                         content::GloveCalibration calibration) {
    BOLT_TRY_ASSIGN(const auto folder, calibration_folder(options));
    calibration.trainee = person.code;
    calibration.date = today();
    calibration.hand_length = 1e-3 * options.hand_length_mm;
    std::error_code failed;
    fs::create_directories(folder, failed);  // writing the file reports a failure
    const fs::path path = content::glove_calibration_path(folder, person.code, calibration.hand);
    BOLT_TRY(content::save_glove_calibration(path, calibration));
    return fmt::format("Saved to {} for {}\n", path.string(), content::name_and_code(person));
}

// Prompts for the postures until the calibration is done or has failed.
Result<hand::CalibrationResult> record_postures(GloveReader& reader) {
    hand::CalibrationSession session;
    std::optional<hand::Posture> prompted;
    hand::CalibrationProblem reported = hand::CalibrationProblem::none;
    while (session.phase != hand::CalibrationPhase::done && session.phase != hand::CalibrationPhase::failed) {
        if (prompted != session.requested) {
            prompted = session.requested;
            const std::string text = fmt::format("{}/{}  {}\n", static_cast<int>(*prompted) + 1,
                                                 hand::posture_count, hand::prompt(*prompted));
            BOLT_TRY(print(text));
        }
        if (reported != session.problem) {
            reported = session.problem;
            if (reported != hand::CalibrationProblem::none)
                BOLT_TRY(print(fmt::format("     {}\n", hand::message_for(reported))));
        }
        std::this_thread::sleep_for(poll_period);
        const hand::GloveSample* sample = reader.next();
        update(session, sample == nullptr ? nullptr : &sample->frame, steady_seconds());
    }
    if (session.failure) return fail(*session.failure);
    return std::move(*session.result);
}

Status calibrate(GloveArguments options) {
    BOLT_TRY_ASSIGN(auto reader, open(options));
    const hand::GloveIdentity identity = reader.driver.report().identity;
    if (Status printed =
            print(fmt::format("A {} glove with {} sensors. Hold each posture still until the next prompt.\n",
                              identity.side == hand::Side::left ? "left" : "right", identity.sensors));
        !printed)
        return printed;
    BOLT_TRY_ASSIGN(const auto person, wearer_of(options));  // before the work
    BOLT_TRY_ASSIGN(const auto made, record_postures(reader));
    std::string text = fmt::format("Quality {:.2f} (best: 1)\n", made.score);
    for (const std::string& remark : made.remarks) text += "  " + remark + "\n";
    BOLT_TRY(print(text));
    if (made.score == 0.0)
        return fail(ErrorCode::failed, "a sensor is unusable, so no calibration is saved",
                    "a new calibration");
    const Result<std::string> saved =
        save(options, person,
             {{}, options.port, identity.side, identity.sensors, {}, made.score, 0.0, made.calibration});
    return saved ? print(*saved) : fail(saved.error());
}

Status import_calibration(const GloveArguments& options) {
    BOLT_TRY_ASSIGN(const auto text, read_file(options.file, std::size_t{1} << 20U, ErrorCode::bad_content));
    BOLT_TRY_ASSIGN(const auto calibration, hand::parse_cal(text, options.file));
    BOLT_TRY_ASSIGN(const auto person, wearer_of(options));
    const Result<std::string> saved = save(options, person,
                                           {{},
                                            {},
                                            options.hand == "left" ? hand::Side::left : hand::Side::right,
                                            options.sensors,
                                            {},
                                            0.0,
                                            0.0,
                                            calibration});
    return saved ? print(*saved) : fail(saved.error());
}

// One line with the angles of thumb and fingers in degrees.
std::string line_of(const hand::Angles& a) {
    std::string text =
        fmt::format("thumb {:3.0f} {:3.0f} {:3.0f} {:3.0f}", to_degrees(a.thumb.roll),
                    to_degrees(a.thumb.abduction), to_degrees(a.thumb.mcp), to_degrees(a.thumb.ip));
    constexpr std::array<const char*, 4> names{"index", "middle", "ring", "little"};
    for (std::size_t i = 0; i < names.size(); ++i)
        text += fmt::format("  {} {:3.0f} {:3.0f} {:3.0f}", names[i], to_degrees(a.fingers[i].mcp),
                            to_degrees(a.fingers[i].pip), to_degrees(a.fingers[i].dip));
    return text + "\n";
}

Status show(GloveArguments options) {
    BOLT_TRY_ASSIGN(const auto stored, content::load_glove_calibration(options.file));
    BOLT_TRY_ASSIGN(auto reader, open(options));
    const hand::GloveIdentity identity = reader.driver.report().identity;
    if (identity.side != stored.hand || identity.sensors != stored.sensors)
        return fail(ErrorCode::usage, "this calibration is for another glove",
                    fmt::format("one for a {} hand with {} sensors",
                                identity.side == hand::Side::left ? "left" : "right", identity.sensors));
    hand::GloveWearer wearer;
    wearer.calibration = stored.calibration;
    wearer.hand = hand::make_hand(stored.hand, stored.hand_length);
    hand::MeasuredHand measured;
    double last_printed = 0.0;
    for (const double until = steady_seconds() + options.seconds; steady_seconds() < until;
         std::this_thread::sleep_for(poll_period)) {
        const hand::GloveSample* sample = reader.next();
        if (sample == nullptr) continue;
        update(measured, wearer, sample->frame, sample->time);
        if (sample->time - last_printed < 0.1) continue;
        last_printed = sample->time;
        BOLT_TRY(print(line_of(measured.angles)));
    }
    return {};
}

}  // namespace

void add_glove(CLI::App& app, int& exit_code) {
    CLI::App* command =
        app.add_subcommand("glove", "Calibrate a CyberGlove for a trainee, or show what it measures");
    command->require_subcommand(1);
    const auto options = std::make_shared<GloveArguments>();
    const auto run = [&exit_code, options](CLI::App* sub, Status (*work)(GloveArguments)) {
        sub->callback([&exit_code, options, work] {
            const Status done = work(*options);
            exit_code = done ? 0 : print_error(done.error());
        });
    };
    const auto add_wearer = [&](CLI::App* sub) {
        sub->add_option("--trainee", options->trainee, "Name or code of the trainee")->required();
        sub->add_option("--hand-length-mm", options->hand_length_mm,
                        "From the crease of the wrist to the tip of the middle finger")
            ->check(CLI::Range(100.0, 300.0))
            ->capture_default_str();
        sub->add_option("--folder", options->folder,
                        "Folder of calibrations; default: the user's data folder");
    };
    const auto add_port = [&](CLI::App* sub) {
        sub->add_option("--port", options->port, "The glove's serial port; default: the only one");
    };

    CLI::App* calibrated =
        command->add_subcommand("calibrate", "Calibrate by four postures that the trainee is prompted for");
    add_port(calibrated);
    add_wearer(calibrated);
    run(calibrated, calibrate);

    CLI::App* imported = command->add_subcommand("import", "Import a .cal file of the vendor");
    imported->add_option("FILE", options->file, "The .cal file")->required();
    imported->add_option("--hand", options->hand, "left or right")
        ->check(CLI::IsMember({"left", "right"}))
        ->capture_default_str();
    imported->add_option("--sensors", options->sensors, "18 or 22")
        ->check(CLI::IsMember({18, 22}))
        ->capture_default_str();
    add_wearer(imported);
    run(imported, [](GloveArguments o) { return import_calibration(o); });

    CLI::App* shown = command->add_subcommand("show", "Show the measured joint angles, in degrees");
    shown->add_option("FILE", options->file, "The calibration file")->required();
    add_port(shown);
    shown->add_option("--seconds", options->seconds, "Duration")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    run(shown, show);
}

}  // namespace bolt::cli

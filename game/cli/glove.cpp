// boltwright glove: calibrates a glove for a trainee, takes over a calibration of the vendor's, and shows
// what a glove measures with one.
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
#include "game/cli/commands.hpp"
#include "game/station/station_setup.hpp"
#include "haptics/hand/glove_calibration.hpp"
#include "haptics/hand/glove_driver.hpp"
#include "haptics/hand/measured_hand.hpp"

namespace bolt::cli {

namespace {

namespace fs = std::filesystem;

constexpr double patience = 10.0;      // s for a glove to give its first frame
constexpr double port_patience = 1.0;  // s for its port to open
constexpr auto look_again = std::chrono::milliseconds(5);

struct GloveOptions {
    std::string port, trainee, folder, file, hand = "right";
    std::size_t sensors = 18;
    double hand_length_mm = 1e3 * hand::skeleton_length;
    double seconds = 10.0;
};

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))); }

Result<fs::path> kept_in(const GloveOptions& options) {
    return options.folder.empty() ? station_setup::calibrations_folder() : fs::path(options.folder);
}

// Reads every sample of a glove once.
struct Reader {
    hand::GloveDriver driver;
    std::uint64_t last = 0;
    const hand::GloveSample* next() {
        const hand::GloveSample& sample = driver.sample();
        if (sample.number == last) return nullptr;
        last = sample.number;
        return &sample;
    }
};

// On the port that is named, or on the only one there is, and streaming.
Result<Reader> open(GloveOptions& options) {
    if (options.port.empty()) {
        const std::vector<fs::path> ports = hand::serial_ports();
        if (ports.size() != 1)
            return fail(ErrorCode::no_device,
                        ports.empty() ? "there is no serial port that a glove could be on"
                                      : fmt::format("there are {} serial ports", ports.size()),
                        ports.empty() ? "plug in the glove's adapter, or name its port with --port"
                                      : "name the glove's with --port, such as " + ports.front().string());
        options.port = ports.front().string();
    }
    Reader reader{hand::GloveDriver::start(options.port)};
    for (const double from = now(); now() - from < patience; std::this_thread::sleep_for(look_again)) {
        if (reader.next() != nullptr) return reader;
        if (!reader.driver.report().open && now() - from > port_patience) break;
    }
    const hand::GloveReport& report = reader.driver.report();
    return fail(ErrorCode::no_device,
                report.trouble[0] != '\0' ? std::string(report.trouble.data())
                                          : options.port + " gives nothing that a glove would",
                report.open ? "is the glove switched on and plugged into its box?" : "");
}

Result<std::string> keep(const GloveOptions& options, content::GloveCalibration calibration) {
    calibration.trainee = options.trainee;
    calibration.date = today();
    calibration.hand_length = 1e-3 * options.hand_length_mm;
    BOLT_TRY_ASSIGN(const auto folder, kept_in(options));
    std::error_code failed;
    fs::create_directories(folder, failed);  // what goes wrong here goes wrong when the file is written
    const fs::path path = content::glove_calibration_path(folder, options.trainee, calibration.hand);
    BOLT_TRY(content::save_glove_calibration(path, calibration));
    return "Kept in " + path.string() + "\n";
}

Result<hand::CalibrationResult> ask_for_postures(Reader& reader) {
    hand::CalibrationSession session;
    std::optional<hand::Posture> asked;
    hand::CalibrationTrouble told = hand::CalibrationTrouble::none;
    while (session.phase != hand::CalibrationPhase::done && session.phase != hand::CalibrationPhase::failed) {
        if (asked != session.requested) {
            asked = session.requested;
            const std::string text = fmt::format("{}/{}  {}\n", static_cast<int>(*asked) + 1,
                                                 hand::posture_count, hand::prompt(*asked));
            BOLT_TRY(print(text));
        }
        if (told != session.trouble) {
            told = session.trouble;
            if (told != hand::CalibrationTrouble::none)
                BOLT_TRY(print(fmt::format("     {}\n", hand::message_for(told))));
        }
        std::this_thread::sleep_for(look_again);
        const hand::GloveSample* sample = reader.next();
        update(session, sample == nullptr ? nullptr : &sample->frame, now());
    }
    if (!session.result)
        return fail(ErrorCode::failed, hand::message_for(session.trouble), "a new calibration");
    return std::move(*session.result);
}

Status calibrate(GloveOptions options) {
    BOLT_TRY_ASSIGN(auto reader, open(options));
    const hand::GloveIdentity identity = reader.driver.report().identity;
    if (Status said =
            print(fmt::format("A {} glove of {} sensors. Hold each posture still until the next.\n",
                              identity.hand == hand::Side::left ? "left" : "right", identity.sensors));
        !said)
        return said;
    BOLT_TRY_ASSIGN(const auto made, ask_for_postures(reader));
    std::string text = fmt::format("Quality {:.2f} (1 is as good as gloves are)\n", made.score);
    for (const std::string& remark : made.remarks) text += "  " + remark + "\n";
    BOLT_TRY(print(text));
    if (made.score == 0.0)
        return fail(ErrorCode::failed, "a sensor is of no use, nothing is kept", "a new calibration");
    const Result<std::string> kept = keep(
        options, {{}, options.port, identity.hand, identity.sensors, {}, made.score, 0.0, made.calibration});
    return kept ? print(*kept) : fail(kept.error());
}

Status take_over(const GloveOptions& options) {
    BOLT_TRY_ASSIGN(const auto text, read_file(options.file, std::size_t{1} << 20U, ErrorCode::bad_content));
    BOLT_TRY_ASSIGN(const auto calibration, hand::parse_cal(text, options.file));
    const Result<std::string> kept =
        keep(options, {{},
                       {},
                       options.hand == "left" ? hand::Side::left : hand::Side::right,
                       options.sensors,
                       {},
                       0.0,
                       0.0,
                       calibration});
    return kept ? print(*kept) : fail(kept.error());
}

// The hand, a line a tenth of a second: degrees of thumb and fingers.
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

Status show(GloveOptions options) {
    BOLT_TRY_ASSIGN(const auto kept, content::load_glove_calibration(options.file));
    BOLT_TRY_ASSIGN(auto reader, open(options));
    const hand::GloveIdentity identity = reader.driver.report().identity;
    if (identity.hand != kept.hand || identity.sensors != kept.sensors)
        return fail(ErrorCode::usage, "this calibration is of another glove",
                    fmt::format("one of a {} hand with {} sensors",
                                identity.hand == hand::Side::left ? "left" : "right", identity.sensors));
    hand::GloveWearer wearer;
    wearer.calibration = kept.calibration;
    wearer.hand = hand::make_hand(kept.hand, kept.hand_length);
    hand::MeasuredHand worn;
    double told = 0.0;
    for (const double until = now() + options.seconds; now() < until;
         std::this_thread::sleep_for(look_again)) {
        const hand::GloveSample* sample = reader.next();
        if (sample == nullptr) continue;
        update(worn, wearer, sample->frame, sample->time);
        if (sample->time - told < 0.1) continue;
        told = sample->time;
        BOLT_TRY(print(line_of(worn.angles)));
    }
    return {};
}

}  // namespace

void add_glove(CLI::App& app, int& exit_code) {
    CLI::App* command = app.add_subcommand("glove", "Calibrate a CyberGlove for a trainee, and look at it");
    command->require_subcommand(1);
    const auto options = std::make_shared<GloveOptions>();
    const auto run = [&exit_code, options](CLI::App* sub, Status (*work)(GloveOptions)) {
        sub->callback([&exit_code, options, work] {
            const Status done = work(*options);
            exit_code = done ? 0 : print_error(done.error());
        });
    };
    const auto whose = [&](CLI::App* sub) {
        sub->add_option("--trainee", options->trainee, "Whose hand it is")->required();
        sub->add_option("--hand-length-mm", options->hand_length_mm,
                        "From the crease of the wrist to the tip of the middle finger")
            ->check(CLI::Range(100.0, 300.0))
            ->capture_default_str();
        sub->add_option("--folder", options->folder, "Where to keep it; else the user's data folder");
    };
    const auto where = [&](CLI::App* sub) {
        sub->add_option("--port", options->port, "The glove's serial port, if there are several");
    };

    CLI::App* made = command->add_subcommand("calibrate", "By four postures that the trainee is asked for");
    where(made);
    whose(made);
    run(made, calibrate);

    CLI::App* taken = command->add_subcommand("import", "From the vendor's .cal file");
    taken->add_option("FILE", options->file, "The .cal file")->required();
    taken->add_option("--hand", options->hand, "left or right")
        ->check(CLI::IsMember({"left", "right"}))
        ->capture_default_str();
    taken->add_option("--sensors", options->sensors, "18 or 22")
        ->check(CLI::IsMember({18, 22}))
        ->capture_default_str();
    whose(taken);
    run(taken, [](GloveOptions o) { return take_over(o); });

    CLI::App* shown = command->add_subcommand("show", "What the glove measures, in degrees");
    shown->add_option("FILE", options->file, "The calibration that was kept")->required();
    where(shown);
    shown->add_option("--seconds", options->seconds, "For how long")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    run(shown, show);
}

}  // namespace bolt::cli

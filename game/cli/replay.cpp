// boltwright replay: replays a session bit for bit, and writes it as a picture, a film or a sound file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <csignal>
#include <memory>

#include "engine/base/process.hpp"
#include "engine/base/result.hpp"
#include "game/cli/commands.hpp"
#include "game/film/film.hpp"
#include "game/sound/event_detection.hpp"
#include "game/sound/playback.hpp"
#include "game/view/pictures.hpp"

namespace bolt::cli {

namespace {

struct ReplayOptions {
    std::string session, png, video, wav, view, language, size = "1280x720", gpu;
    double at = -1.0, from = 0.0, until = 1e9;
    int rate = 30;
    bool validate = false, silent = false, stereo = false;
};

// Temporary files of a film, removed by the destructor.
struct TemporaryFiles {
    std::filesystem::path pictures, sound;
    ~TemporaryFiles() {
        std::error_code ignored;
        for (const auto& path : {pictures, sound})
            if (!path.empty()) std::filesystem::remove(path, ignored);
    }
};

// Names the temporary files after the film, in its folder: "film.pictures.mp4", "film.sound.wav".
void name_temporary_files(const std::filesystem::path& film, const std::string& wav,
                          TemporaryFiles& temporary) {
    const std::filesystem::path stem = film.parent_path() / film.stem();
    temporary.pictures = stem.string() + ".pictures" + film.extension().string();
    if (wav.empty()) temporary.sound = stem.string() + ".sound.wav";
}

// FFmpeg encodes H.264 if it supports that. The pixel format and flags are those that all players read.
Result<ChildStdin> start_ffmpeg(const ReplayOptions& options, const std::string& film, VkExtent2D size) {
    return ChildStdin::start({"ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba",
                              "-s", fmt::format("{}x{}", size.width, size.height), "-r",
                              std::to_string(options.rate), "-i", "-", "-pix_fmt", "yuv420p", "-movflags",
                              "+faststart", film});
}

// Merges pictures and sound into the film. The format of the film determines the sound: AAC in MP4, none in a
// GIF.
Status merge_film(const std::string& pictures, const std::string& sound, const std::string& film) {
    BOLT_TRY_ASSIGN(const auto done,
                    run_program({"ffmpeg", "-nostdin", "-y", "-loglevel", "error", "-i", pictures, "-i",
                                 sound, "-c:v", "copy", "-movflags", "+faststart", film},
                                Capture::output_and_errors));
    if (done.exit_code != 0)
        return fail(ErrorCode::failed, fmt::format("ffmpeg could not write {}: {}", film, done.output),
                    "free space, and an ffmpeg with x264");
    return {};
}

// Draws the picture or the film of a replay.
class ReplayCamera {
  public:
    ReplayCamera(const ReplayOptions& options, film::Film& film, std::optional<ChildStdin> encoder)
        : options_(options), film_(film), encoder_(std::move(encoder)) {}

    // Draws a picture if one is due. Returns false if no more ticks are needed.
    bool draw(const session::ReplayTick& moment) {
        if (error_) return false;
        const bool one = options_.at >= 0.0;
        const double period = one ? 0.05 : 1.0 / options_.rate;
        // A single picture is preceded by a second in which the camera settles.
        const double begin =
            one ? options_.at - period * std::min(20.0, std::floor(options_.at / period)) : options_.from;
        const double end = one ? options_.at : options_.until;
        // The time of a picture follows from its number. If it followed from the previous picture, rounding
        // to ticks would accumulate, and pictures and sound would drift apart.
        if (moment.time < begin + drawn_ * period - 0.5 * moment.setup.dt) return true;
        if (moment.time > end && drawn_ > 0) return false;
        Result<render::Picture> picture = film_.draw(moment, period);
        if (!picture) return stop(picture.error());
        ++drawn_;
        if (encoder_)
            if (const Status written = encoder_->write(picture->rgba); !written) return stop(written.error());
        last_ = std::move(*picture);
        return true;
    }

    Status finish() {
        if (error_) return fail(*error_);
        if (drawn_ == 0)
            return fail(ErrorCode::usage, "the session ends before the first picture",
                        "an earlier --at or --from");
        if (encoder_ && encoder_->finish() != 0)
            return fail(ErrorCode::failed, "ffmpeg could not write the film",
                        "free space, and an ffmpeg with x264");
        if (!options_.png.empty()) BOLT_TRY(view::write_picture(last_, options_.png));
        return film_.check_validation();
    }
    [[nodiscard]] int drawn() const { return drawn_; }
    [[nodiscard]] bool failed() const { return error_.has_value(); }

  private:
    bool stop(const Error& error) {
        error_ = error;
        return false;
    }
    const ReplayOptions& options_;
    film::Film& film_;
    std::optional<ChildStdin> encoder_;
    render::Picture last_;
    std::optional<Error> error_;
    int drawn_ = 0;
};

// Writes the sound of a replay.
class ReplaySound {
  public:
    ReplaySound(const ReplayOptions& options, sound::Soundtrack track)
        : until_(options.until), track_(std::move(track)) {}

    // Adds a tick. Returns false if no more ticks are needed.
    bool add(const session::ReplayTick& moment, const sound::Audible& world) {
        if (moment.time > until_ || !status_) return false;
        status_ = track_.add_tick(moment.setup, world, sound::lesson_cues(moment.lesson.events), moment.time);
        return status_.has_value();
    }
    Status finish() { return status_ ? track_.finish() : status_; }
    [[nodiscard]] bool failed() const { return !status_; }

  private:
    double until_;
    sound::Soundtrack track_;
    Status status_;
};

// Prints that the replay equals the recording; fails if it does not.
Status print_verification(const session::SessionReader& session, const session::ReplayResult& replayed) {
    const double dt = session.header().dt;
    if (replayed.mismatches > 0)
        return fail(ErrorCode::failed,
                    fmt::format("{}: {} of {} ticks differ from the recording, the first at {:.3f} s",
                                session.file(), replayed.mismatches, replayed.ticks,
                                static_cast<double>(replayed.first_mismatch) * dt),
                    "the program and the content of the recording");
    std::string continued;
    for (const std::uint64_t ticks : session.header().continued_after)
        continued +=
            fmt::format("; interrupted and continued after {:.1f} s", static_cast<double>(ticks) * dt);
    return print(fmt::format("{}: {} ticks ({:.1f} s), all as they were recorded{}\n", session.file(),
                             replayed.ticks, static_cast<double>(replayed.ticks) * dt, continued));
}

// The outputs of a replay, which read its world.
struct ReplayOutputs {
    std::unique_ptr<film::Film> film;
    world::World world_without_film;
    std::optional<ReplayCamera> camera;
    std::optional<ReplaySound> sound;

    world::WriteHaptics world() {
        return film ? world::WriteHaptics(film->world()) : world::WriteHaptics(world_without_film);
    }
    // Returns false if no output needs more ticks, or one has failed.
    bool add(const session::ReplayTick& moment) {
        const bool drawing = camera && camera->draw(moment), recording = sound && sound->add(moment, world());
        if ((camera && camera->failed()) || (sound && sound->failed())) return false;
        return drawing || recording || (!camera && !sound);
    }
    Status finish() {
        if (sound) BOLT_TRY(sound->finish());
        return camera ? camera->finish() : Status();
    }
};

// Creates the film and, for a video, starts its encoder.
Status add_camera(const ReplayOptions& options, const session::SessionSetup& at, hand::Side hand,
                  const std::string& film, ReplayOutputs& outputs) {
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.size));
    const std::filesystem::path folder = words::words_folder();
    const std::string language =
        options.language.empty() ? words::language_of_desktop(words::languages(folder)) : options.language;
    const words::LoadedWords loaded = words::load_words(folder, language);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(auto made, film::Film::create(at, {hand, loaded.words, options.view, size, options.gpu,
                                                       options.stereo, options.validate}));
    outputs.film = std::move(made);
    std::optional<ChildStdin> encoder;
    if (!options.video.empty()) {
        const VkExtent2D film_size{size.width * (options.stereo ? 2U : 1U), size.height};
        Result<ChildStdin> started = start_ffmpeg(options, film, film_size);
        if (!started)
            return fail(ErrorCode::failed, started.error().what,
                        "FFmpeg (Debian: ffmpeg), which writes the film; --png and --wav do not need it");
        encoder.emplace(std::move(*started));
    }
    outputs.camera.emplace(options, *outputs.film, std::move(encoder));
    return {};
}

Status add_sound(const ReplayOptions& options, const session::SessionSetup& at,
                 const std::filesystem::path& wav, ReplayOutputs& outputs) {
    BOLT_TRY_ASSIGN(auto track,
                    sound::Soundtrack::create(
                        wav, at.setup, sound::struck_surfaces(at.assembly, at.obstacle_names), options.from));
    outputs.sound.emplace(options, std::move(track));
    return {};
}

// Prints the names of the written files.
Status print_files(const ReplayOptions& options, const ReplayOutputs& outputs) {
    if (!options.video.empty())
        if (Status printed = print(fmt::format("{}: {} pictures{}\n", options.video, outputs.camera->drawn(),
                                               options.silent ? "" : ", with sound"));
            !printed)
            return printed;
    return options.wav.empty() ? Status() : print(fmt::format("{}\n", options.wav));
}

Status run_replay(ReplayOptions options) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // makes the end of FFmpeg a write error
    BOLT_TRY_ASSIGN(auto session, session::SessionReader::open(options.session));
    BOLT_TRY_ASSIGN(auto at, session::restore_setup(session));
    const double length = static_cast<double>(session.tick_count()) * session.header().dt;
    if (!options.png.empty()) options.at = options.at < 0.0 ? length : std::min(options.at, length);
    const bool sounds = !options.wav.empty() || (!options.video.empty() && !options.silent);
    const bool both = sounds && !options.video.empty() && !options.silent;
    TemporaryFiles temporary;
    if (both) name_temporary_files(options.video, options.wav, temporary);
    const std::string pictures = both ? temporary.pictures.string() : options.video;
    const std::string wav = options.wav.empty() ? temporary.sound.string() : options.wav;
    const hand::Side hand = session.header().hand.value_or(hand::Side::right);
    ReplayOutputs outputs;
    world::add_haptics(outputs.world_without_film, at.state);

    if (!options.png.empty() || !options.video.empty())
        BOLT_TRY(add_camera(options, at, hand, pictures, outputs));
    if (sounds) BOLT_TRY(add_sound(options, at, wav, outputs));
    BOLT_TRY_ASSIGN(const auto replayed,
                    session::replay(session, std::move(at), outputs.world(),
                                    [&](const session::ReplayTick& moment) { return outputs.add(moment); }));
    BOLT_TRY(outputs.finish());
    if (both) BOLT_TRY(merge_film(pictures, wav, options.video));
    BOLT_TRY(print_files(options, outputs));
    return print_verification(session, replayed);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* replay = app.add_subcommand(
        "replay", "Replay a session tick by tick, verify that it is the same, and draw or film it");
    replay->add_option("session", options->session, "Session file")->required();
    auto* at = replay->add_option("--at", options->at, "Time in the lesson to draw, s; default: its end")
                   ->check(CLI::NonNegativeNumber);
    auto* png = replay->add_option("--png", options->png, "PNG file to write");
    at->needs(png);
    auto* video = replay->add_option("--video", options->video, "Film to write with FFmpeg")->excludes(png);
    replay->add_option("--wav", options->wav, "WAV file to write")->excludes(png);
    replay->add_flag("--silent", options->silent, "Write the film without sound")->needs(video);
    auto* from = replay->add_option("--from", options->from, "Start of film and sound, s");
    auto* until = replay->add_option("--until", options->until, "End of film and sound, s");
    replay->add_option("--rate", options->rate, "Pictures a second of the film")
        ->check(CLI::Range(1, 120))
        ->needs(video)
        ->capture_default_str();
    replay->add_option("--view", options->view,
                       "Named view of the assembly; default: the camera follows the work");
    replay->add_option("--language", options->language,
                       "Language of the texts in the picture, such as en; default: the desktop's");
    replay->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
    replay->add_flag("--stereo", options->stereo, "Both eyes, side by side");
    replay->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    replay->add_flag("--validate", options->validate,
                     "Run under the Vulkan validation layers; any message is an error");
    replay->callback([options, from, until, &exit_code] {
        const bool cut = from->count() + until->count() > 0;
        const Status done = cut && options->video.empty() && options->wav.empty()
                                ? fail(ErrorCode::usage, "--from and --until cut only film and sound",
                                       "--video FILE or --wav FILE too")
                                : run_replay(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

}  // namespace bolt::cli

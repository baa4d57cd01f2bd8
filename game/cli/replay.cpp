// boltwright replay: a session played again to the same bits, as a picture, as a film, as what was heard.
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

// What is there on the way to a film; gone in the end, however it ends.
struct Scratch {
    std::filesystem::path pictures, sound;
    ~Scratch() {
        std::error_code ignored;
        for (const auto& path : {pictures, sound})
            if (!path.empty()) std::filesystem::remove(path, ignored);
    }
};

// Named after the film, beside it: "film.pictures.mp4", "film.sound.wav".
void name_beside(const std::filesystem::path& film, const std::string& wav, Scratch& scratch) {
    const std::filesystem::path stem = film.parent_path() / film.stem();
    scratch.pictures = stem.string() + ".pictures" + film.extension().string();
    if (wav.empty()) scratch.sound = stem.string() + ".sound.wav";
}

// H.264 where FFmpeg has it, what every player reads.
Result<ChildStdin> start_ffmpeg(const ReplayOptions& options, const std::string& film, VkExtent2D size) {
    return ChildStdin::start({"ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba",
                              "-s", fmt::format("{}x{}", size.width, size.height), "-r",
                              std::to_string(options.rate), "-i", "-", "-pix_fmt", "yuv420p", "-movflags",
                              "+faststart", film});
}

// Pictures and sound to a film, the sound as its kind of file has it: AAC in MP4, nothing in a GIF.
Status put_together(const std::string& pictures, const std::string& sound, const std::string& film) {
    BOLT_TRY_ASSIGN(const auto done,
                    run_program({"ffmpeg", "-nostdin", "-y", "-loglevel", "error", "-i", pictures, "-i",
                                 sound, "-c:v", "copy", "-movflags", "+faststart", film},
                                Capture::output_and_errors));
    if (done.exit_code != 0)
        return fail(ErrorCode::failed, fmt::format("ffmpeg could not write {}: {}", film, done.output));
    return {};
}

// What is drawn of the session while it is played again.
class Camera {
  public:
    Camera(const ReplayOptions& options, film::Film& film, std::optional<ChildStdin> feed)
        : options_(options), film_(film), feed_(std::move(feed)) {}

    // Whether to go on.
    bool see(const session::Moment& moment) {
        if (wrong_) return false;
        const bool one = options_.at >= 0.0;
        const double period = one ? 0.05 : 1.0 / options_.rate;
        // A single picture has a second before it, in which the camera comes to where it looks.
        const double begin =
            one ? options_.at - period * std::min(20.0, std::floor(options_.at / period)) : options_.from;
        const double end = one ? options_.at : options_.until;
        // Due by their count, not by the one before: the sound would run away from a film that is late by a
        // part of a tick at every picture.
        if (moment.time < begin + drawn_ * period - 0.5 * moment.setup.dt) return true;
        if (moment.time > end && drawn_ > 0) return false;
        Result<render::Picture> picture = film_.draw(moment, period);
        if (!picture) return stop(picture.error());
        ++drawn_;
        if (feed_)
            if (const Status fed = feed_->write(picture->rgba); !fed) return stop(fed.error());
        last_ = std::move(*picture);
        return true;
    }

    Status finish() {
        if (wrong_) return fail(*wrong_);
        if (drawn_ == 0) return fail(ErrorCode::usage, "the session ends before there is anything to draw");
        if (feed_ && feed_->finish() != 0) return fail(ErrorCode::failed, "ffmpeg could not write the film");
        if (!options_.png.empty()) BOLT_TRY(view::write_picture(last_, options_.png));
        return film_.no_messages();
    }
    [[nodiscard]] int drawn() const { return drawn_; }
    [[nodiscard]] bool failed() const { return wrong_.has_value(); }

  private:
    bool stop(const Error& error) {
        wrong_ = error;
        return false;
    }
    const ReplayOptions& options_;
    film::Film& film_;
    std::optional<ChildStdin> feed_;
    render::Picture last_;
    std::optional<Error> wrong_;
    int drawn_ = 0;
};

// What is heard of it meanwhile.
class Microphone {
  public:
    Microphone(const ReplayOptions& options, sound::Soundtrack track)
        : until_(options.until), track_(std::move(track)) {}

    bool hear(const session::Moment& moment, const sound::Audible& world) {
        if (moment.time > until_ || !kept_) return false;
        kept_ = track_.hear(moment.setup, world, sound::cues_of(moment.lesson.events), moment.time);
        return kept_.has_value();
    }
    Status finish() { return kept_ ? track_.finish() : kept_; }
    [[nodiscard]] bool failed() const { return !kept_; }

  private:
    double until_;
    sound::Soundtrack track_;
    Status kept_;
};

Status say_what_was(const session::Reader& session, const session::Replayed& replayed) {
    const double dt = session.header().dt;
    if (replayed.wrong > 0)
        return fail(
            ErrorCode::failed,
            fmt::format("{}: {} of {} ticks did not come out as they were recorded, the first at {:.3f} s",
                        session.file(), replayed.wrong, replayed.ticks,
                        static_cast<double>(replayed.first_wrong) * dt),
            "the program and the content that it was recorded with");
    return print(fmt::format("{}: {} ticks ({:.1f} s), all as they were recorded\n", session.file(),
                             replayed.ticks, static_cast<double>(replayed.ticks) * dt));
}

// What watches the replay. The tick is written into the world first; film and sound then read it there.
struct Crew {
    std::unique_ptr<film::Film> film;
    world::World without_pictures;  // the world of a replay without a film
    std::optional<Camera> camera;
    std::optional<Microphone> microphone;

    bool follow(const session::Moment& moment) {
        const world::WriteHaptics world = film ? world::WriteHaptics(film->world()) : without_pictures;
        world::write_snapshot(world, {moment.state, moment.input, moment.output});
        const bool seen = camera && camera->see(moment),
                   heard = microphone && microphone->hear(moment, world);
        if ((camera && camera->failed()) || (microphone && microphone->failed())) return false;
        return seen || heard || (!camera && !microphone);
    }
    Status finish() {
        if (microphone) BOLT_TRY(microphone->finish());
        return camera ? camera->finish() : Status();
    }
};

Status take_camera(const ReplayOptions& options, const session::Prepared& at, hand::Side hand,
                   const std::string& film, Crew& crew) {
    BOLT_TRY_ASSIGN(const auto size, view::parse_size(options.size));
    const std::filesystem::path folder = words::words_folder();
    const std::string language =
        options.language.empty() ? words::language_of_desktop(words::languages(folder)) : options.language;
    const words::Loaded loaded = words::load_words(folder, language);
    if (!loaded.ok()) return fail(loaded.errors.front());
    BOLT_TRY_ASSIGN(auto made, film::Film::create(at, {hand, loaded.words, options.view, size, options.gpu,
                                                       options.stereo, options.validate}));
    crew.film = std::move(made);
    std::optional<ChildStdin> feed;
    if (!options.video.empty()) {
        const VkExtent2D whole{size.width * (options.stereo ? 2U : 1U), size.height};
        Result<ChildStdin> started = start_ffmpeg(options, film, whole);
        if (!started)
            return fail(ErrorCode::failed, started.error().what,
                        "FFmpeg (Debian: ffmpeg), which writes the film; --png and --wav need none");
        feed.emplace(std::move(*started));
    }
    crew.camera.emplace(options, *crew.film, std::move(feed));
    return {};
}

Status take_microphone(const ReplayOptions& options, const session::Prepared& at,
                       const std::filesystem::path& wav, Crew& crew) {
    BOLT_TRY_ASSIGN(auto track,
                    sound::Soundtrack::create(wav, at.setup, sound::materials(at.assembly, at.obstacle_names),
                                              options.from));
    crew.microphone.emplace(options, std::move(track));
    return {};
}

Status say_what_is_there(const ReplayOptions& options, const Crew& crew) {
    if (!options.video.empty())
        if (Status said = print(fmt::format("{}: {} pictures{}\n", options.video, crew.camera->drawn(),
                                            options.silent ? "" : ", with sound"));
            !said)
            return said;
    return options.wav.empty() ? Status() : print(fmt::format("{}\n", options.wav));
}

Status run_replay(ReplayOptions options) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // an FFmpeg that ends is an error that we report
    BOLT_TRY_ASSIGN(auto session, session::Reader::open(options.session));
    BOLT_TRY_ASSIGN(auto at, session::prepare_again(session));
    const double length = static_cast<double>(session.tick_count()) * session.header().dt;
    if (!options.png.empty()) options.at = options.at < 0.0 ? length : std::min(options.at, length);
    const bool sounds = !options.wav.empty() || (!options.video.empty() && !options.silent);
    const bool both = sounds && !options.video.empty() && !options.silent;
    Scratch scratch;
    if (both) name_beside(options.video, options.wav, scratch);
    const std::string pictures = both ? scratch.pictures.string() : options.video;
    const std::string wav = options.wav.empty() ? scratch.sound.string() : options.wav;
    const hand::Side hand = session.header().hand == "left" ? hand::Side::left : hand::Side::right;
    Crew crew;
    world::add_haptics(crew.without_pictures, at.state);

    if (!options.png.empty() || !options.video.empty())
        BOLT_TRY(take_camera(options, at, hand, pictures, crew));
    if (sounds) BOLT_TRY(take_microphone(options, at, wav, crew));
    BOLT_TRY_ASSIGN(const auto replayed,
                    session::replay(session, std::move(at),
                                    [&](const session::Moment& moment) { return crew.follow(moment); }));
    BOLT_TRY(crew.finish());
    if (both) BOLT_TRY(put_together(pictures, wav, options.video));
    BOLT_TRY(say_what_is_there(options, crew));
    return say_what_was(session, replayed);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<ReplayOptions>();
    CLI::App* replay = app.add_subcommand(
        "replay", "Play a session again, tick by tick; say whether it comes out the same, draw or film it");
    replay->add_option("session", options->session, "Session file")->required();
    auto* at = replay->add_option("--at", options->at, "Second of the lesson to draw; its end if not given")
                   ->check(CLI::NonNegativeNumber);
    auto* png = replay->add_option("--png", options->png, "Picture to write");
    at->needs(png);
    auto* video = replay->add_option("--video", options->video, "Film to write, by FFmpeg")->excludes(png);
    replay->add_option("--wav", options->wav, "Sound of the lesson to write")->excludes(png);
    replay->add_flag("--silent", options->silent, "A film without sound")->needs(video);
    auto* from = replay->add_option("--from", options->from, "Second at which film and sound begin");
    auto* until = replay->add_option("--until", options->until, "Second at which they end");
    replay->add_option("--rate", options->rate, "Pictures a second of the film")
        ->check(CLI::Range(1, 120))
        ->needs(video)
        ->capture_default_str();
    replay->add_option("--view", options->view, "Named view of the assembly; follows the work if not given");
    replay->add_option("--language", options->language,
                       "Of what stands in the picture: en, de, zh; the desktop's if not given");
    replay->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
    replay->add_flag("--stereo", options->stereo, "Both eyes, side by side");
    replay->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    replay->add_flag("--validate", options->validate,
                     "Run under the Vulkan validation layers; any message is an error");
    replay->callback([options, from, until, &exit_code] {
        const bool cut = from->count() + until->count() > 0;
        const Status done = cut && options->video.empty() && options->wav.empty()
                                ? fail(ErrorCode::usage, "--from and --until are of a --video or a --wav")
                                : run_replay(*options);
        exit_code = done ? 0 : print_error(done.error());
    });
}

}  // namespace bolt::cli

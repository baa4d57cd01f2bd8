// boltwright replay: a session played again to the same bits, as a picture or as a film.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <csignal>
#include <memory>

#include "engine/base/console.hpp"
#include "engine/base/feed.hpp"
#include "game/cli/commands.hpp"
#include "game/film/film.hpp"
#include "game/view/picture_file.hpp"
#include "game/view/size.hpp"

namespace bolt::cli {

namespace {

struct Options {
    std::string session, png, video, view, size = "1280x720", gpu;
    double at = -1.0, from = 0.0, until = 1e9;
    int rate = 30;
    bool validate = false;
};

// H.264 where FFmpeg has it, what every player reads.
Result<Feed> start_ffmpeg(const Options& options, VkExtent2D size) {
    return Feed::start({"ffmpeg", "-y", "-loglevel", "error", "-f", "rawvideo", "-pix_fmt", "rgba", "-s",
                        fmt::format("{}x{}", size.width, size.height), "-r", std::to_string(options.rate),
                        "-i", "-", "-pix_fmt", "yuv420p", "-movflags", "+faststart", options.video});
}

// What is drawn of the session while it is played again.
class Camera {
  public:
    Camera(const Options& options, film::Film& film, std::optional<Feed> feed)
        : options_(options), film_(film), feed_(std::move(feed)) {}

    // Whether to go on.
    bool see(const play::Moment& moment) {
        const bool one = options_.at >= 0.0;
        const double period = one ? 0.05 : 1.0 / options_.rate;
        // A single picture has a second before it, in which the camera comes to where it looks.
        const double begin = one ? options_.at - 1.0 : options_.from;
        const double end = one ? options_.at : options_.until;
        if (moment.time < begin || moment.time < next_) return true;
        if (moment.time > end && drawn_ > 0) return false;
        next_ = moment.time + period - 0.5 * moment.setup.dt;
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
        if (feed_ && feed_->finish() != 0)
            return fail(ErrorCode::failed, fmt::format("ffmpeg could not write {}", options_.video));
        if (!options_.png.empty())
            if (Status kept = view::write_picture(last_, options_.png); !kept) return kept;
        return film_.no_messages();
    }
    [[nodiscard]] int drawn() const { return drawn_; }

  private:
    bool stop(const Error& error) {
        wrong_ = error;
        return false;
    }
    const Options& options_;
    film::Film& film_;
    std::optional<Feed> feed_;
    render::Picture last_;
    std::optional<Error> wrong_;
    double next_ = 0.0;
    int drawn_ = 0;
};

Status say_what_was(const record::Reader& session, const play::Replayed& replayed) {
    const double dt = session.header().dt;
    if (replayed.wrong > 0)
        return fail(
            ErrorCode::failed,
            fmt::format("{}: {} of {} ticks did not come out as they were recorded, the first at {:.3f} s",
                        session.file(), replayed.wrong, replayed.ticks,
                        static_cast<double>(replayed.first_wrong) * dt),
            "the program and the content that it was recorded with");
    return say(fmt::format("{}: {} ticks ({:.1f} s), all as they were recorded\n", session.file(),
                           replayed.ticks, static_cast<double>(replayed.ticks) * dt));
}

Status run_replay(Options options) {
    (void)std::signal(SIGPIPE, SIG_IGN);  // an FFmpeg that ends is an error that we report
    Result<record::Reader> session = record::Reader::open(options.session);
    if (!session) return fail(session.error());
    Result<play::Prepared> at = play::prepare_again(*session);
    if (!at) return fail(at.error());
    const double length = static_cast<double>(session->tick_count()) * session->header().dt;
    if (!options.png.empty()) options.at = options.at < 0.0 ? length : std::min(options.at, length);
    std::optional<Camera> camera;
    std::unique_ptr<film::Film> film;
    if (!options.png.empty() || !options.video.empty()) {
        const Result<VkExtent2D> size = view::parse_size(options.size);
        if (!size) return fail(size.error());
        Result<std::unique_ptr<film::Film>> made =
            film::Film::create(*at, {options.view, *size, options.gpu, options.validate});
        if (!made) return fail(made.error());
        film = std::move(*made);
        std::optional<Feed> feed;
        if (!options.video.empty()) {
            Result<Feed> started = start_ffmpeg(options, *size);
            if (!started)
                return fail(ErrorCode::failed, started.error().what,
                            "FFmpeg (Debian: ffmpeg), which writes the film; --png needs none");
            feed.emplace(std::move(*started));
        }
        camera.emplace(options, *film, std::move(feed));
    }
    const Result<play::Replayed> replayed = play::replay(
        *session, std::move(*at), [&](const play::Moment& moment) { return !camera || camera->see(moment); });
    if (!replayed) return fail(replayed.error());
    if (camera)
        if (Status done = camera->finish(); !done) return done;
    if (camera && !options.video.empty())
        if (Status said = say(fmt::format("{}: {} pictures\n", options.video, camera->drawn())); !said)
            return said;
    return say_what_was(*session, *replayed);
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
    auto options = std::make_shared<Options>();
    CLI::App* replay = app.add_subcommand(
        "replay", "Play a session again, tick by tick; say whether it comes out the same, draw or film it");
    replay->add_option("session", options->session, "Session file")->required();
    auto* at = replay->add_option("--at", options->at, "Second of the lesson to draw; its end if not given")
                   ->check(CLI::NonNegativeNumber);
    auto* png = replay->add_option("--png", options->png, "Picture to write");
    at->needs(png);
    auto* video = replay->add_option("--video", options->video, "Film to write, by FFmpeg")->excludes(png);
    replay->add_option("--from", options->from, "Second at which the film begins")->needs(video);
    replay->add_option("--until", options->until, "Second at which it ends")->needs(video);
    replay->add_option("--rate", options->rate, "Pictures a second of the film")
        ->check(CLI::Range(1, 120))
        ->needs(video)
        ->capture_default_str();
    replay->add_option("--view", options->view, "Named view of the assembly; follows the work if not given");
    replay->add_option("--size", options->size, "WIDTHxHEIGHT")->capture_default_str();
    replay->add_option("--gpu", options->gpu, "Part of the name of the GPU to use");
    replay->add_flag("--validate", options->validate,
                     "Run under the Vulkan validation layers; any message is an error");
    replay->callback([options, &exit_code] {
        const Status done = run_replay(*options);
        exit_code = done ? 0 : complain(done.error());
    });
}

}  // namespace bolt::cli

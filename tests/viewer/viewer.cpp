#include "game/viewer/viewer.hpp"

#include <doctest/doctest.h>

#include "game/trainees/trainee.hpp"
#include "tests/support/folder.hpp"
#include "tests/support/need.hpp"

namespace bolt::test {

using namespace viewer;

namespace {

// A lesson of a clumsy trainee, played once for all tests.
const session::SessionReader& recorded() {
    static const Folder folder;
    static const session::SessionReader session = [] {
        const content::LoadedAssembly loaded = content::load_assembly("cover-m8");
        REQUIRE(loaded.ok());
        trainees::TrainOptions options;
        options.trainee = need(trainees::find_profile("clumsy"));
        options.lesson.trainee_profile = options.trainee.name;
        options.lesson.obstacles = session::ObstacleUse::if_any;
        options.lesson.seed = 3;
        const auto file = folder / "session.boltwright";
        (void)need(trainees::train(loaded.assembly, options, file,
                                   [](const trainees::TrainingProgress&) { return true; }));
        return need(session::SessionReader::open(file));
    }();
    return session;
}

// The viewer without a window, with the validation layers.
struct HeadlessViewer {
    static constexpr VkExtent2D size{320, 180};
    Folder folder;
    gpu::Instance instance;
    view::GpuContext gpu;
    std::unique_ptr<Viewer> viewer;

    HeadlessViewer() : instance(make_instance()) {
        ViewerOptions options;
        options.session = folder / "session.boltwright";
        words::LoadedWords loaded = words::load_words(words::words_folder(), "en");
        REQUIRE(loaded.ok());
        options.words = std::move(loaded.words);
        viewer = need(Viewer::create(need(replay_session(recorded())), std::move(options)));
        start();
    }
    ~HeadlessViewer() {
        viewer->release();
        for (const std::string& message : instance.log().messages) FAIL_CHECK(message);
    }
    static gpu::Instance make_instance() {
        gpu::InstanceOptions options;
        options.validation = true;
        return need(gpu::Instance::create(options));
    }
    void start() {
        render::RendererOptions renderer;
        renderer.level_error_px = 1.0F;
        renderer.shadow_size = 256;
        gpu = need(view::make_gpu_context(instance, {}, renderer));
        need(viewer->start(gpu));
    }
    void lose_gpu() {
        viewer->release();
        gpu.renderer.reset();
        gpu.frames.reset();
        gpu.device.reset();
        start();
    }
    void frame(const std::vector<platform::InputEvent>& events = {}, double seconds = 0.0) {
        const view::WindowFrame window{events, size, 0.35F, seconds, nullptr};
        need(viewer->update(window));
        auto frame = need(gpu.frames->begin());
        need(viewer->draw(*frame, window));
        need(gpu.frames->submit(*frame));
    }
    void key(platform::Key key) { frame({platform::KeyEvent{key, true, false, {}}}); }
};

bool same_joint(const world::Joint& a, const world::Joint& b) {
    return a.angle == b.angle && a.torque == b.torque && a.clamp == b.clamp && a.stage == b.stage;
}

}  // namespace

TEST_CASE("Recording: its states are those of the replay, to the bit") {
    const std::unique_ptr<Recording> recording = need(replay_session(recorded()));
    CHECK(recording->mismatches == 0);
    session::SessionSetup start = need(session::restore_setup(recorded()));
    world::World world;
    world::add_haptics(world, start.state);
    std::size_t compared = 0;
    (void)need(session::replay(recorded(), std::move(start), world, [&](const session::ReplayTick& tick) {
        const std::size_t index = recording->index_at(tick.time);
        if (std::abs(tick.time - static_cast<double>(index) * recording->period) > 1e-9) return true;
        const RecordedState& state = recording->states[index];
        for (const world::Joint& joint : state.joints)
            CHECK(same_joint(joint, world::joint_at(world::ReadJoints(world), joint.index)));
        CHECK(state.tool.pose.position == world.only<world::ConstrainedTool>().pose.position);
        CHECK(state.contact.joint == world.only<world::ToolState>().joint);
        ++compared;
        return true;
    }));
    CHECK(compared + 2 >= recording->states.size());
    CHECK(recording->duration() ==
          doctest::Approx(static_cast<double>(recorded().tick_count()) * 1e-3).epsilon(0.001));
}

TEST_CASE("Recording: a chapter for each step that began, in order, and neighbours of any time") {
    const std::unique_ptr<Recording> recording = need(replay_session(recorded()));
    std::vector<double> chapters;
    for (const TimelineMark& mark : recording->marks)
        if (!mark.mistake) chapters.push_back(mark.time);
    std::size_t begun = 0;
    for (const lesson::LessonEvent& event : need(recorded().events()))
        begun += event.kind == lesson::EventKind::step_begin ? 1 : 0;
    REQUIRE(chapters.size() == begun);
    REQUIRE(begun > 3);
    CHECK(std::is_sorted(chapters.begin(), chapters.end()));
    CHECK(recording->neighbouring_chapter(chapters[1], 1) == chapters[2]);
    CHECK(recording->neighbouring_chapter(chapters[2] + 0.5, -1) == chapters[1]);
    CHECK(recording->neighbouring_chapter(recording->duration(), 1) == recording->duration());
    CHECK(recording->neighbouring_chapter(0.0, -1) == 0.0);
    CHECK(recording->chapter_at(chapters[2] + 0.1)->time == chapters[2]);
}

TEST_CASE("Recording: each mistake is explained in the language of the viewer") {
    const std::unique_ptr<Recording> recording = need(replay_session(recorded()));
    const words::LoadedWords german = words::load_words(words::words_folder(), "de");
    REQUIRE(german.ok());
    std::size_t mistakes = 0;
    for (const TimelineMark& mark : recording->marks) {
        if (!mark.mistake) continue;
        ++mistakes;
        REQUIRE_MESSAGE(mark.explanation, mark.event.text);
        CHECK(mark.explanation->joint == mark.joint);
        const std::string text = lesson::mistake_text(german.words, *mark.explanation);
        CHECK_FALSE(text.empty());
        CHECK(text != mark.event.text);
    }
    CHECK(mistakes > 0);
}

TEST_CASE("Recording: a session without a tick is an error") {
    const Folder folder;
    const auto file = folder / "empty.boltwright";
    { session::SessionWriter writer = need(session::SessionWriter::create(file, recorded().header())); }
    const Result<session::SessionReader> reader = session::SessionReader::open(file);
    REQUIRE(reader);
    const auto recording = replay_session(*reader);
    REQUIRE(!recording);
    CHECK(recording.error().message().find("no tick") != std::string::npos);
}

TEST_CASE("Viewer: keys play, pause, seek and select views") {
    HeadlessViewer h;
    Viewer& viewer = *h.viewer;
    h.frame();
    CHECK(viewer.playing());
    h.frame({}, 0.1);
    CHECK(viewer.time() == doctest::Approx(0.1));
    h.key(platform::Key::space);
    h.frame({}, 0.1);
    CHECK(!viewer.playing());
    CHECK(viewer.time() == doctest::Approx(0.1));
    h.key(platform::Key::right);
    CHECK(viewer.time() == doctest::Approx(2.1));
    h.key(platform::Key::page_down);
    const double chapter = viewer.time();
    CHECK(viewer.recording().chapter_at(chapter)->time == chapter);
    h.key(platform::Key::end);
    CHECK(viewer.time() == viewer.recording().duration());
    h.key(platform::Key::space);  // begins again
    CHECK(viewer.playing());
    CHECK(viewer.time() < 1.0);
    const view::Orbit before = viewer.camera();
    h.key(platform::Key::digit_2);
    CHECK(view::viewpoint_of(viewer.camera()).eye != view::viewpoint_of(before).eye);
    CHECK(viewer.speed() == 1.0);
    h.key(platform::Key::up);
    CHECK(viewer.speed() == 2.0);
    for (int i = 0; i < 9; ++i) h.key(platform::Key::down);
    CHECK(viewer.speed() == 0.25);
    h.key(platform::Key::escape);
    CHECK(viewer.closed());
}

TEST_CASE("Viewer: dragging on the time line seeks, dragging on the scene turns the camera") {
    HeadlessViewer h;
    Viewer& viewer = *h.viewer;
    h.key(platform::Key::space);
    h.frame();
    const auto [low, high] = viewer.time_line();
    const glm::dvec2 middle = 0.5 * (glm::dvec2(low) + glm::dvec2(high));
    h.frame({platform::CursorEvent{middle}});
    h.frame({platform::ButtonEvent{platform::Button::left, true, middle}});
    h.frame();
    h.frame({platform::ButtonEvent{platform::Button::left, false, middle}});
    CHECK(viewer.time() == doctest::Approx(0.5 * viewer.recording().duration()).epsilon(0.02));
    const view::Orbit before = viewer.camera();
    const glm::dvec2 scene(60.0, 40.0);
    h.frame({platform::CursorEvent{scene}});
    h.frame();
    h.frame({platform::ButtonEvent{platform::Button::left, true, scene}});
    h.frame({platform::CursorEvent{scene + glm::dvec2(20.0, 0.0)}});
    h.frame({platform::ButtonEvent{platform::Button::left, false, scene + glm::dvec2(20.0, 0.0)}});
    CHECK(viewer.camera().yaw != before.yaw);
    CHECK(viewer.time() == doctest::Approx(0.5 * viewer.recording().duration()).epsilon(0.02));
}

TEST_CASE("Viewer: P saves the picture beside the session, also after the GPU is lost in between") {
    for (const bool lost : {false, true}) {
        CAPTURE(lost);
        HeadlessViewer h;
        h.frame();
        h.key(platform::Key::space);
        h.key(platform::Key::p);
        if (lost) {
            h.lose_gpu();
            h.frame();
        }
        h.frame();
        const auto file = h.folder / "session-0.0s.png";
        CHECK(std::filesystem::file_size(file) > 10'000);
        CHECK(h.viewer->message().find(file.string()) != std::string::npos);
    }
}

TEST_CASE("Viewer: goes on after a lost GPU") {
    HeadlessViewer h;
    h.frame({}, 0.2);
    const double before = h.viewer->time();
    h.lose_gpu();
    h.frame({}, 0.1);
    CHECK(h.viewer->time() == doctest::Approx(before + 0.1));
}

}  // namespace bolt::test

// A lesson at a station: the servo has its own time, the lesson follows with another servo, and somebody
// plays by the keys that a keyboard has.
#include <doctest/doctest.h>

#include <cmath>
#include <filesystem>
#include <set>

#include "content/format/assembly.hpp"
#include "game/session/replay.hpp"
#include "game/session/session_file.hpp"
#include "game/trainer/mouse_hand.hpp"
#include "game/trainer/station_client.hpp"
#include "game/trainer/step_undo.hpp"
#include "tests/station/virtual_bench.hpp"
#include "tests/support/sanitized.hpp"
#include "tests/support/skip.hpp"
#include "tests/trainer/one_joint.hpp"

using namespace bolt;
using namespace bolt::trainer;
using platform::Key;

namespace {

namespace fs = std::filesystem;

constexpr double frame = 0.02;  // s

// The servo at the keyboard, and the lesson beside it.
struct Played {
    content::Assembly assembly;
    session::CourseOptions options;
    std::unique_ptr<session::Course> course;
    StationClient at;
    test::VirtualBench* bench = nullptr;
    Asked asked;
    StepUndo back;
    std::set<Key> down;
    fs::path file;
    Status status;
    std::vector<std::string> mistakes;

    explicit Played(const std::string& name, lesson::Mode mode = lesson::Mode::guided, bool gloved = false) {
        content::Loaded loaded = content::load_assembly(name);
        REQUIRE(loaded.ok());
        assembly = std::move(loaded.assembly);
        options.mode = mode;
        options.obstacles = session::Obstacles::if_any;
        file = fs::path(BOLT_TRAINER_OUT) / "station.boltwright";
        auto one = session::prepare(assembly, options), other = session::prepare(assembly, options);
        REQUIRE(one);
        REQUIRE(other);
        auto made = std::make_unique<test::VirtualBench>(std::move(*one), options);
        bench = made.get();
        at.bench = std::move(made);
        if (gloved) {
            station::DisplayedHand hand;
            hand.has_frame = true;
            bench->wear(hand, Pose{Vec3(0.12, 0.02, -0.03), rotation(Vec3(0.1, 0.2, 1.5))});
            at.bare_wrist = Pose{Vec3(0.02, 0.1, 0.05), rotation(Vec3(-1.0, 0.2, 0.3))};
            pinch(false);
        }

        options.device = bench->setup().limits;
        session::use_device(options, *other);
        auto begun = session::Course::begin(std::move(*other), options, file);
        REQUIRE(begun);
        course = std::move(*begun);
        at.rest = {Vec3(0.0, 0.01, 0.25), glm::angleAxis(-0.5 * pi, Vec3(1, 0, 0))};
        at.home = make_hand(at.rest).pose;
        picture();
    }

    void hold(const std::set<Key>& keys) {
        std::vector<platform::Event> events;
        for (const Key key : down)
            if (!keys.contains(key)) events.emplace_back(platform::KeyEvent{key, false, false, {}});
        for (const Key key : keys)
            if (!down.contains(key)) events.emplace_back(platform::KeyEvent{key, true, false, {}});
        down = keys;
        at.keys.take(events);
    }
    // Thumb and index finger of a gloved hand, together or apart.
    void pinch(bool together) const {
        bench->hand_->joints.position[hand::thumb_tip] = Vec3(0.0);
        bench->hand_->joints.position[hand::index_tip] = Vec3(together ? 0.02 : 0.09, 0.0, 0.0);
    }
    void picture() {
        bench->pass(frame);
        for (station::TickRecord tick; status && goes_on(back, *course) && at.bench->next_tick(tick);) {
            status = course->take(tick.input, tick.output);
            for (const lesson::Event& event : course->events()) {
                if (event.kind == "mistake") mistakes.push_back(event.text);
                note(back, course->lesson(), event);
            }
        }
        Asked now = asked;
        now.paused = now.paused || !goes_on(back, *course);
        now.undo = steps_back(back, course->lesson());
        const Status sent = wish(at, *course, now);
        CHECK(sent);
        asked.tool = asked.recentre = false;
    }
    void pictures(double seconds) {
        for (double t = 0.0; t < seconds; t += frame) picture();
    }
    [[nodiscard]] const lesson::Step* due() const { return course->lesson().due(); }
    [[nodiscard]] int engaged() const { return at.now.output.joint; }
    [[nodiscard]] bool has_wrench() const { return at.now.input.grip == servo::Grip::wrench; }
    [[nodiscard]] Vec3 nut() const {
        return servo::nut_centre(course->setup().nuts[due()->joint],
                                 course->state().joints[due()->joint].nut.angle);
    }
};

// Somebody at the keys, the hand in a glove or not.

class Keyboard {
  public:
    explicit Keyboard(Played& played) : p_(played) {}
    double sought = 1.0;  // of the torque that is due

    void play(double longest, std::size_t steps = SIZE_MAX) {
        while (p_.status && p_.due() != nullptr && p_.course->time() < longest &&
               p_.course->lesson().current < steps)
            do_step();
        p_.hold({});
    }

  private:
    // A gloved hand needs no key to close it: it closes. About the wrench it is closed already, and the key
    // sets that on.
    void go_on(std::set<Key> keys) {
        if (p_.at.gloved && !p_.has_wrench()) p_.pinch(keys.erase(Key::space) > 0);

        p_.hold(keys);
        p_.picture();
    }
    // Keys that move the tool there.
    static std::set<Key> towards(const Vec3& way, double near) {
        std::set<Key> keys;
        const auto add = [&](double along, Key more, Key less) {
            if (std::abs(along) > near) keys.insert(along > 0.0 ? more : less);
        };
        add(way.x, Key::d, Key::a);
        add(way.y, Key::e, Key::q);
        add(way.z, Key::s, Key::w);
        return keys;
    }
    void go_to(const Vec3& place, double near, double longest) {
        for (double t = 0.0; t < longest && glm::length(place - p_.at.now.tool.position) > 2.0 * near;
             t += frame)
            go_on(towards(place - p_.at.now.tool.position, near));
        go_on({});
    }
    void do_step() {
        const std::size_t current = p_.course->lesson().current;
        const bool fingers = p_.due()->kind == lesson::StepKind::run_down;
        if (fingers && p_.has_wrench()) lay_down();

        if (!fingers && !p_.has_wrench()) take_wrench();
        p_.pictures(0.1);
        reach(fingers);
        if (p_.engaged() >= 0) {
            if (fingers)
                spin(current);
            else
                pull();
        }
        come_off();
    }
    void lay_down() {
        p_.asked.tool = true;
        if (p_.at.gloved) p_.bench->hand_->held = false;
    }
    void take_wrench() {
        const Pose lies = p_.at.now.wrench_rest.value_or(p_.at.rest);
        go_to(lies * Vec3(0.1, 0.0, 0.1), 0.02, 6.0);
        go_to(lies * Vec3(0.1, 0.0, 0.03), 0.01, 4.0);
        if (p_.at.gloved) p_.bench->hand_->held = true;
        for (int i = 0; i < 5; ++i) go_on({Key::space});
        go_on({});
        REQUIRE(p_.has_wrench());

        for (int i = 0; i < 30; ++i) go_on({Key::e});
    }
    // As the ghost has it: with room for the handle.
    void turn_to_fit() {
        const Pose ghost =
            wrench_on(p_.at.rest, p_.course->setup(), p_.course->state(), p_.due()->joint, false);
        for (double t = 0.0; t < 8.0; t += frame) {
            const Quat& now = p_.at.now.tool.orientation;
            const Vec3 left = rotation_vector(glm::normalize(ghost.orientation * glm::conjugate(now)));
            if (glm::length(left) < 0.08) break;
            std::set<Key> keys;
            const auto add = [&](double about, Key more, Key less) {
                if (std::abs(about) > 0.03) keys.insert(about > 0.0 ? more : less);
            };
            add(left.x, Key::down, Key::up);
            add(left.y, Key::left, Key::right);
            add(left.z, Key::page_up, Key::page_down);
            go_on(keys);
        }
        go_on({});
    }
    void reach(bool fingers) {
        if (!fingers) turn_to_fit();
        go_to(p_.nut() + Vec3(0.0, 0.1, 0.0), 0.02, 8.0);
        for (double t = 0.0; t < 6.0 && p_.engaged() < 0; t += frame) go_on({Key::space});
    }
    void spin(std::size_t current) {
        for (double t = 0.0; t < 60.0 && p_.course->lesson().current == current && p_.engaged() >= 0 &&
                             !lesson::reached(p_.course->lesson(), p_.course->state().joints);
             t += frame)
            go_on({Key::space, Key::right});
    }
    void pull() {
        const lesson::Step step = *p_.due();
        double still = 0.0, angle = 0.0;
        while (p_.status && p_.engaged() >= 0 && still < 1.0 &&
               p_.course->state().joints[step.joint].torque < sought * step.torque) {
            go_on({Key::right});
            const double now = p_.course->state().joints[step.joint].torque;
            still = now > angle + 0.02 || p_.course->state().joints[step.joint].nut.speed > 0.02
                        ? 0.0
                        : still + frame;
            angle = std::max(angle, now);
        }
        for (int i = 0; i < 100 && p_.engaged() >= 0 && p_.course->state().joints[step.joint].torque > 0.5;
             ++i)
            go_on({Key::left});
    }
    void come_off() {
        for (int i = 0; i < 30; ++i) go_on({Key::e});
    }

    Played& p_;
};

// The file replays to the bit, and ends where the lesson did.
void expect_replay(const Played& played) {
    const auto reader = session::Reader::open(played.file);
    REQUIRE(reader);
    auto at = session::prepare_again(*reader);
    REQUIRE(at);
    std::size_t current = SIZE_MAX;
    const auto replayed = session::replay(*reader, std::move(*at), [&](const session::Moment& moment) {
        current = moment.lesson.current;
        return true;
    });
    REQUIRE(replayed);
    CHECK(replayed->wrong == 0);
    CHECK(current == played.course->lesson().current);
}

}  // namespace

TEST_CASE("a lesson played with keys at a station whose servo has its own time") {
    Played played("cover-m8");
    Keyboard keyboard(played);
    keyboard.play(test::sanitized ? 60.0 : 400.0, test::sanitized ? 1 : SIZE_MAX);
    if (!played.status) FAIL(played.status.error().message());
    MESSAGE("at " << played.course->time() << " s step " << played.course->lesson().current << " of "
                  << played.course->lesson().steps.size());
    for (const std::string& mistake : played.mistakes) MESSAGE(mistake);
    const auto finished = played.course->finish();
    REQUIRE(finished);
    if (test::sanitized)
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    CHECK(finished->result.finished);
    CHECK(finished->result.score > 80.0);
    MESSAGE("score " << finished->result.score);
    expect_replay(played);
}

TEST_CASE("a gloved hand pinches nuts and spins them, closes on the wrench, and opens again") {
    Played played("cover-m8", lesson::Mode::guided, true);
    REQUIRE(played.at.gloved);
    Keyboard person(played);
    person.play(test::sanitized ? 60.0 : 400.0, test::sanitized ? 1 : SIZE_MAX);
    if (!played.status) FAIL(played.status.error().message());
    MESSAGE("at " << played.course->time() << " s step " << played.course->lesson().current << " of "
                  << played.course->lesson().steps.size());
    const auto finished = played.course->finish();
    REQUIRE(finished);
    CHECK(played.course->lesson().current >= 1);
    if (test::sanitized)
        return test::skip_rest("the lesson after its first step takes minutes under a sanitizer");
    CHECK(finished->result.finished);
    CHECK(finished->result.score > 80.0);
}

TEST_CASE("a servo that was told something else than the lesson is found out at once") {
    Played played("cover-m8");
    played.pictures(0.2);
    REQUIRE(played.status);
    const double before = played.course->time();
    CHECK(before > 0.15);
    played.bench->garbles_ = true;
    played.hold({Key::d});
    played.pictures(0.1);
    CHECK_FALSE(played.status);
    CHECK(played.course->time() < before + 0.1);
}

TEST_CASE("paused, a station's lesson stands still; a step is taken back there as at the mouse") {
    Played played("cover-m8");
    Keyboard keyboard(played);
    keyboard.play(60.0, 1);
    REQUIRE(played.course->lesson().current == 1);
    const std::size_t first = played.course->lesson().steps[0].joint;
    REQUIRE(played.course->state().joints[first].nut.angle > 6.0);
    played.asked.paused = true;
    played.pictures(0.1);
    const double before = played.course->time();
    played.hold({Key::d});
    played.pictures(1.0);
    CHECK(played.course->time() == before);
    played.asked.paused = false;
    played.hold({});
    go_back(played.back, played.course->lesson(), 1);
    played.pictures(0.5);
    CHECK_FALSE(played.back.to);
    CHECK(played.course->lesson().current == 0);
    CHECK(played.course->state().joints[first].nut.angle == 0.0);
    played.pictures(0.2);
    REQUIRE(played.status);
    REQUIRE(played.course->finish());
    expect_replay(played);
}

TEST_CASE("at a station, too, a mistake in the last step begins that again; only then it is over") {
    if (test::sanitized) return test::skip_rest("playing a lesson takes minutes under a sanitizer");
    const test::OneJoint one("cover-m8");
    Played played(one.name());
    Keyboard keyboard(played);
    keyboard.play(60.0, 1);
    REQUIRE(played.course->lesson().current == 1);
    REQUIRE(played.course->lesson().steps.size() == 2);
    const joint::JointState& joint = played.course->state().joints[0];
    const double seated = joint.nut.angle;
    keyboard.sought = 1.3;
    for (int i = 0; i < 60 && played.mistakes.empty(); ++i) keyboard.play(played.course->time() + 1.0, 2);
    REQUIRE(played.mistakes.size() == 1);
    for (int i = 0; i < 100 && joint.nut.angle > seated; ++i) played.picture();
    CHECK(joint.nut.angle == seated);
    CHECK(played.course->lesson().current == 1);
    CHECK_FALSE(played.back.to);
    REQUIRE(goes_on(played.back, *played.course));

    keyboard.sought = 1.0;
    keyboard.play(200.0);
    CHECK_FALSE(goes_on(played.back, *played.course));
    if (!played.status) FAIL(played.status.error().message());
    const auto finished = played.course->finish();
    REQUIRE(finished);
    CHECK(finished->result.finished);
    CHECK(finished->result.joints[0].overall == lesson::Verdict::ok);
    CHECK(played.mistakes.size() == 1);
    expect_replay(played);
}

TEST_CASE("a gloved hand that twists a nut runs out of forearm, other hands do not") {
    StationClient at;
    at.gloved = true;
    at.now.output.joint = 0;
    at.now.input.grip = servo::Grip::fingers;
    at.taken_at = 40.0;
    at.now.output.nut_angle = 40.0;
    CHECK(hand_of(at).room == doctest::Approx(forearm_turns));
    at.now.output.nut_angle = 40.0 + to_radians(119.0);
    CHECK(hand_of(at).room == doctest::Approx(to_radians(1.0)));
    at.now.output.nut_angle = 40.0 - to_radians(150.0);
    CHECK(hand_of(at).room == 0.0);
    at.now.input.grip = servo::Grip::wrench;
    CHECK(std::isinf(hand_of(at).room));
    at.now.input.grip = servo::Grip::fingers;
    at.gloved = false;
    CHECK(std::isinf(hand_of(at).room));
    at.gloved = true;
    at.now.output.joint = -1;
    CHECK(std::isinf(hand_of(at).room));
}

#include "tests/mock_openxr/script.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "tests/mock_openxr/state.hpp"

namespace bolt::mock {

namespace {

using Words = std::vector<std::string>;

// The arguments of a command. Reading beyond the end or a wrong number throws, and the caller reports it.
class Arguments {
  public:
    explicit Arguments(const Words& words) : words_(words) {}

    const std::string& text() {
        if (next_ >= words_.size()) throw std::invalid_argument("an argument is missing");
        return words_[next_++];
    }
    double number() {
        const std::string& word = text();
        std::size_t used = 0;
        const double value = std::stod(word, &used);
        if (used != word.size()) throw std::invalid_argument(word + " is no number");
        return value;
    }
    bool flag() { return number() != 0.0; }
    float value() { return static_cast<float>(number()); }
    Pose pose() {
        const double x = number(), y = number(), z = number();
        const double qx = number(), qy = number(), qz = number(), qw = number();
        return {{x, y, z}, glm::normalize(Quat(qw, qx, qy, qz))};
    }
    [[nodiscard]] bool more() const { return next_ < words_.size(); }

  private:
    const Words& words_;
    std::size_t next_ = 0;
};

[[noreturn]] void unknown(const std::string& word) { throw std::invalid_argument("unknown word " + word); }

void set_tracked(Tracked& at, const std::string& what, Arguments& arguments) {
    if (what == "valid")
        at.valid = arguments.flag();
    else
        at.tracked = arguments.flag();
}

// A flat hand: the palm, the wrist, and five rows of joints, around the grip pose. As the specification has
// it, the fingers point along −Y of the grip, the thumb is at −Z, and X points out of a left palm and into a
// right one. A pinch brings the tips of thumb and index finger together.
void place_joints(Hand& hand, Side side) {
    const double right = side == Side::right ? 1.0 : -1.0;
    const glm::dmat3 palm_in_grip(Vec3(0.0, 0.0, right), Vec3(right, 0.0, 0.0), Vec3(0.0, 1.0, 0.0));
    const Pose palm = hand.grip.pose * Pose{Vec3(0.0), glm::quat_cast(palm_in_grip)};
    for (std::size_t i = 0; i < joint_count; ++i) {
        Vec3 at(0.0);  // x to the right, y out of the back of the hand, −z along the fingers
        if (i == 1) at.z = 0.08;
        if (i >= 2 && i < 6) at = {-0.05, 0.0, 0.04 - 0.03 * static_cast<double>(i - 2)};
        if (i >= 6) {
            const auto finger = static_cast<double>((i - 6) / 5), joint = static_cast<double>((i - 6) % 5);
            at = {-0.03 + 0.02 * finger, 0.0, 0.04 - 0.03 * joint};
        }
        if (hand.pinches && i == 5) at = {-0.035, -0.04, -0.05};
        if (hand.pinches && i == 10) at = {-0.03, -0.03, -0.055};
        at.x *= right;
        hand.joints[i] = {{palm * Pose{at}, hand.grip.valid, hand.grip.tracked}, 0.009F};
    }
}

void set_hand_value(Hand& hand, Side side, const std::string& what, Arguments& arguments) {
    if (what == "grip") {
        hand.grip.pose = arguments.pose();
        if (hand.has_joints) place_joints(hand, side);
    } else if (what == "aim") {
        hand.aim.pose = arguments.pose();
    } else if (what == "trigger") {
        hand.trigger = arguments.value();
    } else if (what == "squeeze") {
        hand.squeeze = arguments.value();
    } else if (what == "stick") {
        hand.stick.x = arguments.value();
        hand.stick.y = arguments.value();
    } else if (what == "active") {
        hand.active = arguments.flag();
    } else if (what == "menu") {
        hand.menu = arguments.flag();
    } else if (what == "secondary") {
        hand.secondary = arguments.flag();
    } else if (what == "joints") {
        hand.has_joints = arguments.flag();
        place_joints(hand, side);
    } else if (what == "pinch") {
        hand.pinches = arguments.flag();
        place_joints(hand, side);
    } else if (what == "profile") {
        hand.profile = arguments.text();
    } else if (what == "valid" || what == "tracked") {
        set_tracked(hand.grip, what, arguments);
        hand.aim.valid = hand.grip.valid;
        hand.aim.tracked = hand.grip.tracked;
        if (hand.has_joints) place_joints(hand, side);
    } else {
        unknown(what);
    }
}

std::size_t side_index(const std::string& side) {
    if (side != "left" && side != "right") unknown(side);
    return side == "left" ? 0 : 1;
}

void run_event(State& s, Arguments& arguments) {
    static const std::map<std::string, Event> events{{"ready", Event::put_on},
                                                     {"stopping", Event::taken_off},
                                                     {"visible", Event::focus_lost},
                                                     {"focused", Event::focus_gained},
                                                     {"exit", Event::exit_by_user},
                                                     {"session_loss", Event::session_loss},
                                                     {"mask", Event::mask_changed},
                                                     {"instance_loss", Event::instance_loss},
                                                     {"events_lost", Event::events_lost},
                                                     {"worn", Event::user_present},
                                                     {"not_worn", Event::user_absent},
                                                     {"room_reinit", Event::room_reinit},
                                                     {"room_failed", Event::room_failed},
                                                     {"room_interrupted", Event::room_interrupted},
                                                     {"room_restored", Event::room_restored},
                                                     {"profile", Event::profile_changed}};
    const std::string& word = arguments.text();
    if (word != "recentre") {
        const auto found = events.find(word);
        if (found == events.end()) unknown(word);
        return play(s, found->second);
    }
    const std::string& space = arguments.text();
    const XrReferenceSpaceType type = space == "stage"    ? XR_REFERENCE_SPACE_TYPE_STAGE
                                      : space == "seated" ? XR_REFERENCE_SPACE_TYPE_LOCAL
                                      : space == "floor"  ? local_floor_space
                                                         : (unknown(space), XR_REFERENCE_SPACE_TYPE_MAX_ENUM);
    std::optional<Pose> shift;
    if (arguments.more()) shift = arguments.pose();
    play_recentre(s, type, 0, shift);
}

void set_config(State& s, Arguments& arguments) {
    Config& config = s.config;
    const std::string& what = arguments.text();
    const auto whole = [&] { return static_cast<std::uint32_t>(arguments.number()); };
    std::vector<std::string>& extensions = config.extensions;
    if (what == "eyes") {
        config.eyes = whole();
        if (config.eyes != 1 && config.eyes != 2) throw std::invalid_argument("one or two eyes");
    } else if (what == "width") {
        config.width = whole();
        config.max_width = std::max(config.max_width, config.width);
    } else if (what == "height") {
        config.height = whole();
        config.max_height = std::max(config.max_height, config.height);
    } else if (what == "period") {
        config.period = static_cast<std::int64_t>(1e9 * arguments.number());
    } else if (what == "ipd") {
        config.ipd = arguments.number();
    } else if (what == "cant") {
        config.cant = arguments.number();
    } else if (what == "with") {
        extensions.push_back(arguments.text());
        if (extensions.back() == "XR_EXT_local_floor") config.spaces.push_back(local_floor_space);
    } else if (what == "without") {
        extensions.erase(std::remove(extensions.begin(), extensions.end(), arguments.text()),
                         extensions.end());
    } else if (what == "format") {
        config.formats = {whole(), 126};
    } else if (what == "separate") {
        config.refuse_arrays = arguments.flag();
    } else if (what == "foreign_gpu") {
        config.foreign_gpu = arguments.flag();
    } else if (what == "passthrough") {
        if (arguments.flag()) config.blend_modes.push_back(XR_ENVIRONMENT_BLEND_MODE_ALPHA_BLEND);
    } else if (what == "realtime") {
        config.real_time = arguments.flag();
    } else {
        unknown(what);
    }
}

void run_tracker(State& s, Arguments& arguments) {
    const std::string& serial = arguments.text();
    const std::string& what = arguments.text();
    const auto found = std::find_if(s.vive_trackers.begin(), s.vive_trackers.end(),
                                    [&](const ViveTracker& tracker) { return tracker.serial == serial; });
    ViveTracker tracker = found != s.vive_trackers.end() ? *found : ViveTracker{serial, {}, true, {}};
    if (what == "role") {
        const std::string& role = arguments.text();
        tracker.role = role == "none" ? std::string() : role;
    } else if (what == "pose") {
        tracker.at.pose = arguments.pose();
    } else if (what == "connected") {
        tracker.connected = arguments.flag();
    } else if (what == "valid" || what == "tracked") {
        set_tracked(tracker.at, what, arguments);
    } else {
        unknown(what);
    }
    set_vive_tracker(s, tracker);
}

void run_command(State& s, const Words& words) {
    Arguments arguments(words);
    const std::string& command = arguments.text();
    if (command == "config") {
        set_config(s, arguments);
    } else if (command == "report") {
        s.script.report = arguments.text();
    } else if (command == "follow") {
        s.script.followed = arguments.text();
    } else if (command == "head") {
        if (words.size() > 1 && (words[1] == "valid" || words[1] == "tracked"))
            set_tracked(s.head, arguments.text(), arguments);
        else
            s.head.pose = arguments.pose();
    } else if (command == "hand") {
        const std::size_t side = side_index(arguments.text());
        const std::string& what = arguments.text();
        set_hand_value(s.hands[side], static_cast<Side>(side), what, arguments);
    } else if (command == "tracker") {
        run_tracker(s, arguments);
    } else if (command == "event") {
        run_event(s, arguments);
    } else if (command == "headset") {
        s.config.connected = arguments.flag();
    } else if (command == "render") {
        s.should_render = arguments.flag();
    } else if (command == "fail") {
        const std::string& function = arguments.text();
        const auto result = static_cast<XrResult>(static_cast<int>(arguments.number()));
        s.injected[function] = {result, static_cast<int>(arguments.number()), 0};
    } else if (command == "picture") {
        s.script.requested.push_back(arguments.text());
    } else if (command == "exit") {
        play(s, Event::exit_by_user);
    } else {
        unknown(command);
    }
    if (arguments.more()) throw std::invalid_argument("an argument too many");
}

void write_picture(State& s, const Frame& frame, const std::string& name) {
    std::size_t width = 0, height = 0;
    for (const SubmittedView& view : frame.views) {
        if (view.picture.rgba.empty()) return violate(s, "script", "the format of the pictures is unknown");
        width += view.picture.width;
        height = std::max<std::size_t>(height, view.picture.height);
    }
    std::string texels(3 * width * height, '\0');
    std::size_t left = 0;
    for (const SubmittedView& view : frame.views) {
        const Picture& picture = view.picture;
        for (std::size_t y = 0; y < picture.height; ++y)
            for (std::size_t x = 0; x < picture.width; ++x)
                for (std::size_t c = 0; c < 3; ++c)
                    texels[3 * (y * width + left + x) + c] =
                        static_cast<char>(picture.rgba[4 * (y * picture.width + x) + c]);
        left += picture.width;
    }
    std::ofstream file(name, std::ios::binary);
    if (!(file << fmt::format("P6\n{} {}\n255\n", width, height) << texels << std::flush))
        violate(s, "script", fmt::format("{} cannot be written", name));
}

}  // namespace

Script load_script(State& s, const std::string& name) {
    Script script;
    script.file = name;
    std::ifstream file(name);
    if (!file) violate(s, "script", fmt::format("{} cannot be read", name));
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream stream(line);
        std::uint64_t frame = 0;
        if (line.find_first_not_of(" \t\r") == std::string::npos || line[0] == '#') continue;
        if (!(stream >> frame)) {
            violate(s, "script", fmt::format("{}:{}: does not begin with a frame number", name, number));
            continue;
        }
        ScriptLine parsed;
        parsed.number = number;
        for (std::string word; stream >> word;) parsed.words.push_back(word);
        script.lines.emplace(frame, std::move(parsed));
    }
    return script;
}

void run_commands(State& s, std::uint64_t frame) {
    const auto [begin, end] = s.script.lines.equal_range(frame);
    for (auto line = begin; line != end; ++line) {
        try {
            run_command(s, line->second.words);
        } catch (const std::exception& error) {
            violate(s, "script", fmt::format("{}:{}: {}", s.script.file, line->second.number, error.what()));
        }
    }
}

void run_followed(State& s) {
    if (s.script.followed.empty()) return;
    std::ifstream file(s.script.followed);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
        std::istringstream stream(line);
        Words words;
        for (std::string word; stream >> word;) words.push_back(word);
        if (words.empty()) continue;
        try {
            run_command(s, words);
        } catch (const std::exception& error) {
            violate(s, "script", fmt::format("{}:{}: {}", s.script.followed, number, error.what()));
        }
    }
}

void write_pictures(State& s, const Frame& frame) {
    std::multimap<XrTime, std::string>& pictures = s.script.pictures;
    const auto end = pictures.upper_bound(frame.time);
    for (auto picture = pictures.begin(); picture != end; ++picture) write_picture(s, frame, picture->second);
    pictures.erase(pictures.begin(), end);
}

}  // namespace bolt::mock

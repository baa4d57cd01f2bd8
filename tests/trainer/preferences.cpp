// Keys that are bound, settings that are taken and kept, and what becomes of Escape.
#include "game/trainer/preferences.hpp"

#include <doctest/doctest.h>

#include <set>

#include "engine/base/file.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"

using namespace bolt;
using namespace bolt::trainer;
namespace fs = std::filesystem;
using platform::Key;
using test::Folder;

namespace {

Preferences in(const fs::path& folder) {
    Preferences p;
    p.folder = folder;
    p.known = settings_vocabulary({"de", "en", "zh"});
    return p;
}

bool pauses(const KeyMap& keys) {
    Controls controls;
    controls.keys = keys;
    const platform::Event escape[] = {platform::KeyEvent{Key::escape, true, false, {}}};
    return apply(controls, escape, {}).wants(Action::pause);
}

}  // namespace

TEST_CASE("every key has a name of its own, by which it is found again") {
    std::set<std::string> names;
    for (std::size_t i = 1; i < platform::key_count; ++i) {
        const Key key = static_cast<Key>(i);
        CHECK(platform::key_named(platform::name(key)) == key);
        CHECK(names.insert(std::string(platform::name(key))).second);
    }
    CHECK(platform::key_named("no such key") == Key::unknown);
    CHECK(platform::key_named("?") == Key::unknown);
}

TEST_CASE("a key that is free is taken; one that another action has is swapped, never held by two") {
    KeyMap keys;
    CHECK(bind(keys, Action::tool, Key::g).how == Bound::done);
    CHECK(keys.of(Action::tool) == Key::g);
    const Binding swapped = bind(keys, Action::tool, Key::h);
    CHECK(swapped.how == Bound::swapped);
    CHECK(swapped.with == Action::hint);
    CHECK(keys.of(Action::tool) == Key::h);
    CHECK(keys.of(Action::hint) == Key::g);
    CHECK(bind(keys, Action::tool, Key::h).how == Bound::done);  // its own
}

TEST_CASE("modifiers, unknown keys and Escape are refused, and Escape is never given away") {
    const KeyMap usual;
    for (const Key key : {Key::unknown, Key::escape, Key::shift, Key::control, Key::alt, Key::super}) {
        KeyMap keys;
        CHECK(bind(keys, Action::hint, key).how == Bound::refused);
        CHECK(keys.keys == usual.keys);
    }
    KeyMap keys;
    CHECK(bind(keys, Action::pause, Key::t).how == Bound::refused);  // the wrench would get Escape
    CHECK(keys.keys == usual.keys);
    CHECK(bind(keys, Action::pause, Key::p).how == Bound::done);
    CHECK(pauses(keys));
}

TEST_CASE("whatever is pressed, each action keeps a key of its own, and Escape pauses") {
    Random random(5);
    KeyMap keys;
    for (int i = 0; i < 20000; ++i) {
        const auto action = static_cast<Action>(random.bits() % action_count);
        const auto key = static_cast<Key>(random.bits() % platform::key_count);
        (void)bind(keys, action, key);
        const std::set<Key> distinct(keys.keys.begin(), keys.keys.end());
        if (distinct.size() != action_count || distinct.count(Key::unknown) > 0) FAIL("a key is lost");
        for (std::size_t a = 0; a < action_count; ++a)
            if (keys.keys.at(a) == Key::escape && static_cast<Action>(a) != Action::pause)
                FAIL("somebody else has Escape");
        if (!pauses(keys)) FAIL("Escape does not pause");
        if (i % 100 == 0) CHECK(keys_of(names_of(keys)).keys == keys.keys);
    }
}

TEST_CASE("an action that a file does not name has its usual key, or none where that is taken") {
    const KeyMap keys = keys_of({{"hint", "T"}});
    CHECK(keys.of(Action::hint) == Key::t);
    CHECK(keys.of(Action::tool) == Key::unknown);
    CHECK(key_name(keys, Action::tool) == "–");
    CHECK(keys.of(Action::find_view) == Key::v);
    Controls controls;
    controls.keys = keys;
    const platform::Event nameless[] = {platform::KeyEvent{Key::unknown, true, false, {}}};
    CHECK_FALSE(apply(controls, nameless, {}).wants(Action::tool));
}

TEST_CASE("settings are a trainee's own: kept when changed, taken when the name is said again") {
    const Folder folder;
    Preferences p = in(folder / "new");
    take(p, "Ada");
    CHECK(keep(p));
    CHECK_FALSE(fs::exists(folder / "new"));  // nothing was changed
    p.settings.left_handed = true;
    p.settings.language = "de";
    (void)bind(p.keys, Action::tool, Key::g);
    CHECK(keep(p));
    CHECK(fs::exists(kept_in(p)));
    take(p, "Bea");
    CHECK_FALSE(p.settings.left_handed);
    CHECK(p.keys.of(Action::tool) == Key::t);
    take(p, "Ada");
    CHECK(p.settings.left_handed);
    CHECK(p.keys.of(Action::tool) == Key::g);
    Preferences later = in(folder / "new");
    take(later, "Ada");
    CHECK(later.settings.language == "de");
    CHECK(later.keys.keys == p.keys.keys);
}

TEST_CASE("what was changed before a name was said becomes that of the name, unless it has its own") {
    const Folder folder;
    Preferences p = in(folder.path());
    take(p, "");
    p.settings.captions = true;
    CHECK(keep(p));
    CHECK(fs::is_empty(folder.path()));
    take(p, "Ada");
    CHECK(p.settings.captions);
    CHECK(keep(p));
    Preferences other = in(folder.path());
    take(other, "");
    other.settings.volume = 0.5;
    take(other, "Ada");
    CHECK(other.settings.captions);
    CHECK(other.settings.volume == 1.0);
}

TEST_CASE("a file that cannot be read is told, and is not written over before something is changed") {
    const Folder folder;
    Preferences p = in(folder.path());
    const fs::path path = content::settings_path(folder.path(), "Ada");
    const std::string broken = "{\n  \"format\": \"boltwright settings 1\",\n  \"volum\": 1\n}\n";
    REQUIRE(write_file(path, broken));
    take(p, "Ada");
    CHECK(p.trouble == Preferences::Trouble::unread);
    CHECK(p.why.find(path.string() + ":3:3: ") == 0);
    CHECK(keep(p));
    CHECK(read_file(path, 1000, ErrorCode::failed).value() == broken);
    p.settings.captions = true;
    CHECK(keep(p));
    CHECK(read_file(path.string() + ".unread", 1000, ErrorCode::failed).value() == broken);
    take(p, "Ada");
    CHECK(p.trouble == Preferences::Trouble::none);
    CHECK(p.settings.captions);
}

TEST_CASE("a folder that cannot be written is told, nothing is lost, and it is tried again") {
    const Folder folder;
    Preferences p = in(folder / "taken");
    REQUIRE(write_file(folder / "taken", "a file"));
    take(p, "Ada");
    p.settings.force_scale = 0.25;
    CHECK_FALSE(keep(p));
    CHECK(p.trouble == Preferences::Trouble::unwritten);
    CHECK(p.why.find("taken") != std::string::npos);
    CHECK(p.settings.force_scale == 0.25);
    fs::remove(folder / "taken");
    CHECK(keep(p));
    CHECK(p.trouble == Preferences::Trouble::none);
    take(p, "Ada");
    CHECK(p.settings.force_scale == 0.25);
}

TEST_CASE("a file that is named holds for whoever it is") {
    const Folder folder;
    Preferences p = in({});
    p.file = folder / "bench.json";
    take(p, "");
    p.settings.volume = 0.25;
    CHECK(keep(p));
    take(p, "Ada");
    CHECK(p.settings.volume == 0.25);
    CHECK(kept_in(p) == p.file);
}

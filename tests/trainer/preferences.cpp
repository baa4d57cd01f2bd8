// Key bindings, the role of Escape, and loading and saving of settings.
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
    InputState state;
    state.keys = keys;
    const platform::InputEvent escape[] = {platform::KeyEvent{Key::escape, true, false, {}}};
    return apply_events(state, escape, {}).triggered(Action::pause);
}

}  // namespace

TEST_CASE("Key names: each key has a unique name that parses back to the key") {
    std::set<std::string> names;
    for (std::size_t i = 1; i < platform::key_count; ++i) {
        const Key key = static_cast<Key>(i);
        CHECK(platform::key_named(platform::name(key)) == key);
        CHECK(names.insert(std::string(platform::name(key))).second);
    }
    CHECK(platform::key_named("no such key") == Key::unknown);
    CHECK(platform::key_named("?") == Key::unknown);
}

TEST_CASE("Key binding: a free key is bound; a key of another action is swapped") {
    KeyMap keys;
    CHECK(bind(keys, Action::tool, Key::k).outcome == BindOutcome::done);
    CHECK(keys.of(Action::tool) == Key::k);
    const BindResult swapped = bind(keys, Action::tool, Key::h);
    CHECK(swapped.outcome == BindOutcome::swapped);
    CHECK(swapped.other == Action::hint);
    CHECK(keys.of(Action::tool) == Key::h);
    CHECK(keys.of(Action::hint) == Key::k);
    CHECK(bind(keys, Action::tool, Key::h).outcome == BindOutcome::done);  // no change
}

TEST_CASE(
    "Key binding: modifiers, unknown keys and Escape are refused, and Escape never goes to another action") {
    const KeyMap usual;
    for (const Key key : {Key::unknown, Key::escape, Key::shift, Key::control, Key::alt, Key::super}) {
        KeyMap keys;
        CHECK(bind(keys, Action::hint, key).outcome == BindOutcome::refused);
        CHECK(keys.keys == usual.keys);
    }
    KeyMap keys;
    CHECK(bind(keys, Action::pause, Key::t).outcome ==
          BindOutcome::refused);  // Escape would go to the wrench
    CHECK(keys.keys == usual.keys);
    CHECK(bind(keys, Action::pause, Key::p).outcome == BindOutcome::done);
    CHECK(pauses(keys));
}

TEST_CASE("Key binding: after any sequence each action has its own key, and Escape pauses") {
    Random random(5);
    KeyMap keys;
    for (int i = 0; i < 20000; ++i) {
        const auto action = static_cast<Action>(random.bits() % action_count);
        const auto key = static_cast<Key>(random.bits() % platform::key_count);
        (void)bind(keys, action, key);
        const std::set<Key> distinct(keys.keys.begin(), keys.keys.end());
        if (distinct.size() != action_count || distinct.count(Key::unknown) > 0)
            FAIL("an action has no key of its own");
        for (std::size_t a = 0; a < action_count; ++a)
            if (keys.keys.at(a) == Key::escape && static_cast<Action>(a) != Action::pause)
                FAIL("an action other than pause has Escape");
        if (!pauses(keys)) FAIL("Escape does not pause");
        if (i % 100 == 0) CHECK(keys_of(names_of(keys)).keys == keys.keys);
    }
}

TEST_CASE("Key map: an action missing in the file gets its default key, or none if another action has it") {
    const KeyMap keys = keys_of({{"hint", "T"}});
    CHECK(keys.of(Action::hint) == Key::t);
    CHECK(keys.of(Action::tool) == Key::unknown);
    CHECK(key_name(keys, Action::tool) == "–");
    CHECK(keys.of(Action::find_view) == Key::v);
    InputState state;
    state.keys = keys;
    const platform::InputEvent nameless[] = {platform::KeyEvent{Key::unknown, true, false, {}}};
    CHECK_FALSE(apply_events(state, nameless, {}).triggered(Action::tool));
}

TEST_CASE("Preferences: each trainee's settings are saved when changed and loaded by name") {
    const Folder folder;
    Preferences p = in(folder / "new");
    load_preferences(p, "Ada");
    CHECK(save_preferences(p));
    CHECK_FALSE(fs::exists(folder / "new"));  // nothing was changed
    p.settings.left_handed = true;
    p.settings.language = "de";
    (void)bind(p.keys, Action::tool, Key::k);
    CHECK(save_preferences(p));
    CHECK(fs::exists(settings_file(p)));
    load_preferences(p, "Bea");
    CHECK_FALSE(p.settings.left_handed);
    CHECK(p.keys.of(Action::tool) == Key::t);
    load_preferences(p, "Ada");
    CHECK(p.settings.left_handed);
    CHECK(p.keys.of(Action::tool) == Key::k);
    Preferences later = in(folder / "new");
    load_preferences(later, "Ada");
    CHECK(later.settings.language == "de");
    CHECK(later.keys.keys == p.keys.keys);
}

TEST_CASE("Preferences: changes made before a name is entered go to a trainee who has no settings yet") {
    const Folder folder;
    Preferences p = in(folder.path());
    load_preferences(p, "");
    p.settings.captions = true;
    CHECK(save_preferences(p));
    CHECK(fs::is_empty(folder.path()));
    load_preferences(p, "Ada");
    CHECK(p.settings.captions);
    CHECK(save_preferences(p));
    Preferences other = in(folder.path());
    load_preferences(other, "");
    other.settings.volume = 0.5;
    load_preferences(other, "Ada");
    CHECK(other.settings.captions);
    CHECK(other.settings.volume == 1.0);
}

TEST_CASE("Preferences: an unreadable file is reported and not overwritten until a setting changes") {
    const Folder folder;
    Preferences p = in(folder.path());
    const fs::path path = content::settings_path(folder.path(), "Ada");
    const std::string broken = "{\n  \"format\": \"boltwright settings 1\",\n  \"volum\": 1\n}\n";
    REQUIRE(write_file(path, broken));
    load_preferences(p, "Ada");
    CHECK(p.file_error == Preferences::FileError::read_failed);
    CHECK(p.file_error_message.find(path.string() + ":3:3: ") == 0);
    CHECK(save_preferences(p));
    CHECK(read_file(path, 1000, ErrorCode::failed).value() == broken);
    p.settings.captions = true;
    CHECK(save_preferences(p));
    CHECK(read_file(path.string() + ".unread", 1000, ErrorCode::failed).value() == broken);
    load_preferences(p, "Ada");
    CHECK(p.file_error == Preferences::FileError::none);
    CHECK(p.settings.captions);
}

TEST_CASE(
    "Preferences: an unwritable folder is reported, the settings stay in force, and saving is retried") {
    const Folder folder;
    Preferences p = in(folder / "taken");
    REQUIRE(write_file(folder / "taken", "a file"));
    load_preferences(p, "Ada");
    p.settings.force_scale = 0.25;
    CHECK_FALSE(save_preferences(p));
    CHECK(p.file_error == Preferences::FileError::write_failed);
    CHECK(p.file_error_message.find("taken") != std::string::npos);
    CHECK(p.settings.force_scale == 0.25);
    fs::remove(folder / "taken");
    CHECK(save_preferences(p));
    CHECK(p.file_error == Preferences::FileError::none);
    load_preferences(p, "Ada");
    CHECK(p.settings.force_scale == 0.25);
}

TEST_CASE("Preferences: a named file is used for every trainee") {
    const Folder folder;
    Preferences p = in({});
    p.file = folder / "bench.json";
    load_preferences(p, "");
    p.settings.volume = 0.25;
    CHECK(save_preferences(p));
    load_preferences(p, "Ada");
    CHECK(p.settings.volume == 0.25);
    CHECK(settings_file(p) == p.file);
    p.settings.volume = 0.5;
    CHECK(save_preferences(p));
    load_preferences(p, "T-7K3M9Q");
    CHECK(save_preferences(p));  // nothing was changed, so nothing is written
    CHECK(content::load_settings(p.file, p.known)->trainee == "Ada");
    p.settings.volume = 0.75;
    CHECK(save_preferences(p));
    CHECK(content::load_settings(p.file, p.known)->trainee == "T-7K3M9Q");
}

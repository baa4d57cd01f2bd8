#include "content/trainee/people.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <random>
#include <set>
#include <thread>

#include "content/format/json_members.hpp"
#include "content/trainee/settings.hpp"
#include "engine/base/file.hpp"

namespace bolt::content {

namespace fs = std::filesystem;

namespace {

constexpr const char* names_format = "boltwright names 1";
constexpr std::string_view code_prefix = "T-";
constexpr std::string_view code_characters = "0123456789ABCDEFGHJKMNPQRSTVWXYZ";
constexpr std::size_t code_length = 6;  // characters after the prefix
constexpr std::string_view blanks = " \t\r\n";

constexpr auto lock_timeout = std::chrono::seconds(5);
constexpr auto lock_poll = std::chrono::milliseconds(5);

bool is_control(char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7F; }

// Lets one program at a time change names.json. The file of the lock stays, because removing it would let two
// programs hold the lock.
class NamesLock {
  public:
    static Result<NamesLock> acquire(const fs::path& folder);
    NamesLock(const NamesLock&) = delete;
    NamesLock& operator=(const NamesLock&) = delete;
    NamesLock(NamesLock&& other) noexcept : handle_(std::exchange(other.handle_, -1)) {}
    NamesLock& operator=(NamesLock&&) = delete;
    ~NamesLock() {
        if (handle_ >= 0) (void)::close(handle_);
    }

  private:
    explicit NamesLock(int handle) : handle_(handle) {}
    int handle_;
};

Result<NamesLock> NamesLock::acquire(const fs::path& folder) {
    const fs::path path = folder / "names.lock";
    const auto failed = [&](const std::string& what, const char* expected) {
        Error error;
        error.file = path.string();
        error.what = what;
        error.expected = expected;
        return fail(std::move(error));
    };
    NamesLock lock(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600));
    if (lock.handle_ < 0)
        return failed(fmt::format("cannot be opened: {}", std::strerror(errno)),
                      "a folder with write permission");
    const auto deadline = std::chrono::steady_clock::now() + lock_timeout;
    while (::flock(lock.handle_, LOCK_EX | LOCK_NB) != 0) {
        if (errno != EWOULDBLOCK && errno != EINTR)
            return failed(fmt::format("cannot be locked: {}", std::strerror(errno)),
                          "a file system with locks");
        if (std::chrono::steady_clock::now() > deadline)
            return failed("another program has held this lock for 5 s", "the end of that program");
        std::this_thread::sleep_for(lock_poll);
    }
    return lock;
}

Status make_private_folder(const fs::path& folder) {
    std::error_code problem;
    if (fs::create_directories(folder, problem))
        fs::permissions(folder, fs::perms::owner_all, problem);  // a failure leaves the user's own umask
    if (fs::is_directory(folder)) return {};
    Error error;
    error.file = folder.string();
    error.what = "this folder cannot be created: " + problem.message();
    error.expected = "a folder that this user may write to";
    return fail(std::move(error));
}

void check_entry(MemberReader& members, const std::string& at, const Person& person) {
    if (!is_person_code(person.code))
        members.report(at + "/code", JsonPart::value, fmt::format("{} is not a code", in_quotes(person.code)),
                       "a code as \"T-7K3M9Q\"");
    if (person.name.empty() || trim_blanks(person.name) != person.name ||
        std::any_of(person.name.begin(), person.name.end(), is_control))
        members.report(at + "/name", JsonPart::value, fmt::format("{} is not a name", in_quotes(person.name)),
                       "a name without blanks around it");
    if (typed_person_code(person.name))
        members.report(at + "/name", JsonPart::value, fmt::format("{} is a code", in_quotes(person.name)),
                       "a name");
}

std::vector<Person> read_people(MemberReader& members, const nlohmann::json& root) {
    const nlohmann::json* list = members.find(root, "", "people");
    if (list == nullptr) return {};
    if (!list->is_array()) {
        members.report("/people", JsonPart::value, "\"people\" is not a list",
                       "a list as [{\"code\": \"T-7K3M9Q\", \"name\": \"Ada\"}]");
        return {};
    }
    std::vector<Person> people;
    std::set<std::string> codes, names;
    for (std::size_t i = 0; i < list->size() && !members.first_error; ++i) {
        const nlohmann::json& entry = (*list)[i];
        const std::string at = fmt::format("/people/{}", i);
        if (!entry.is_object()) {
            members.report(at, JsonPart::value, "the entry is not an object",
                           "an object with \"code\" and \"name\"");
            break;
        }
        members.check_known(entry, at, {"code", "name"});
        Person person{members.text(entry, at, "code"),
                      members.text(entry, at, "name", max_trainee_name_size)};
        check_entry(members, at, person);
        if (!codes.insert(person.code).second)
            members.report(at + "/code", JsonPart::value,
                           fmt::format("{} is the code of two people", in_quotes(person.code)),
                           "a different code for each person");
        if (!names.insert(person.name).second)
            members.report(at + "/name", JsonPart::value,
                           fmt::format("{} is the name of two people", in_quotes(person.name)),
                           "a different name for each person");
        people.push_back(std::move(person));
    }
    return people;
}

bool is_utf8(std::string_view text) {
    using Handler = nlohmann::json::error_handler_t;
    const nlohmann::json value = std::string(text);
    return value.dump(-1, ' ', false, Handler::ignore) == value.dump(-1, ' ', false, Handler::replace);
}

// A text that the program may save as a name.
Status check_name(std::string_view name) {
    const auto wrong = [&](std::string what, const char* expected) {
        return fail(ErrorCode::usage, fmt::format("the name {} {}", in_quotes(name), what), expected);
    };
    if (name.empty()) return fail(ErrorCode::usage, "the trainee's name is empty", "a name or a code");
    if (name.size() > max_trainee_name_size)
        return wrong(fmt::format("has {} bytes", name.size()), "at most 64 bytes");
    if (std::any_of(name.begin(), name.end(), is_control))
        return wrong("has a control character", "a name on one line");
    if (!is_utf8(name)) return wrong("is not in UTF-8, the encoding of the file", "a name in UTF-8");
    return {};
}

const Person* find_in(std::span<const Person> people, std::string_view code_or_name) {
    const auto found = std::find_if(people.begin(), people.end(), [&](const Person& p) {
        return p.code == code_or_name || p.name == code_or_name;
    });
    return found == people.end() ? nullptr : &*found;
}

std::string unused_code(std::span<const Person> people) {
    for (;;) {
        std::string code = make_person_code();
        if (std::all_of(people.begin(), people.end(),
                        [&](const Person& p) { return code_distance(p.code, code) >= 2; }))
            return code;
    }
}

}  // namespace

std::string name_and_code(const Person& person) {
    if (person.name.empty() || person.code.empty()) return person.code + person.name;
    return fmt::format("{} ({})", person.name, person.code);
}

std::string make_person_code() {
    unsigned char bytes[code_length];
    if (::getentropy(bytes, sizeof bytes) != 0) {  // only in an old kernel
        std::random_device device;
        for (unsigned char& byte : bytes) byte = static_cast<unsigned char>(device());
    }
    std::string code(code_prefix);
    for (const unsigned char byte : bytes) code += code_characters[byte % code_characters.size()];
    return code;
}

bool is_person_code(std::string_view text) {
    if (!text.starts_with(code_prefix)) return false;
    text.remove_prefix(code_prefix.size());
    return text.size() == code_length && text.find_first_not_of(code_characters) == std::string_view::npos;
}

std::optional<std::string> typed_person_code(std::string_view typed) {
    std::string code(trim_blanks(typed));
    for (char& c : code) {
        if (c >= 'a' && c <= 'z') c = static_cast<char>(c - 'a' + 'A');
        if (c == 'O') c = '0';
        if (c == 'I' || c == 'L') c = '1';
    }
    return is_person_code(code) ? std::optional(std::move(code)) : std::nullopt;
}

std::size_t code_distance(std::string_view a, std::string_view b) {
    std::size_t different = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        if (a[i] != b[i]) ++different;
    return different;
}

std::string_view trim_blanks(std::string_view text) {
    const std::size_t first = text.find_first_not_of(blanks);
    if (first == std::string_view::npos) return {};
    return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

Result<std::vector<Person>> parse_names(std::string_view text, const std::string& file) {
    const FileHead head{"file of names", names_format, {"people"}};
    return parse_small_file(text, file, head, read_people);
}

std::string names_text(std::span<const Person> people) {
    nlohmann::ordered_json root;
    root["format"] = names_format;
    root["people"] = nlohmann::ordered_json::array();
    for (const Person& person : people)
        root["people"].push_back({{"code", person.code}, {"name", person.name}});
    return root.dump(2) + "\n";
}

Result<fs::path> people_folder() {
    BOLT_TRY_ASSIGN(const auto data, user_data_folder());
    return data / "people";
}

fs::path names_path(const fs::path& folder) { return folder / "names.json"; }

Result<std::vector<Person>> list_people(const fs::path& folder) {
    const fs::path path = names_path(folder);
    std::error_code unknown;
    if (fs::symlink_status(path, unknown).type() == fs::file_type::not_found) return std::vector<Person>();
    BOLT_TRY_ASSIGN(const auto text, read_file(path, json_size_limit, ErrorCode::bad_content));
    return parse_names(text, path.string());
}

Result<std::optional<Person>> find_person(const fs::path& folder, std::string_view typed) {
    BOLT_TRY_ASSIGN(const auto people, list_people(folder));
    const std::optional<std::string> code = typed_person_code(typed);
    const Person* found = find_in(people, code ? std::string_view(*code) : trim_blanks(typed));
    return found == nullptr ? std::nullopt : std::optional(*found);
}

Result<Person> find_or_add_person(const fs::path& folder, std::string_view typed) {
    // A known person needs no lock and no permission to write.
    BOLT_TRY_ASSIGN(auto known, find_person(folder, typed));
    if (known) return std::move(*known);
    if (auto code = typed_person_code(typed)) return Person{std::move(*code), {}};
    const std::string name(trim_blanks(typed));
    BOLT_TRY(check_name(name));
    BOLT_TRY(make_private_folder(folder));
    BOLT_TRY_ASSIGN(const auto lock, NamesLock::acquire(folder));
    BOLT_TRY_ASSIGN(auto people, list_people(folder));
    if (const Person* added = find_in(people, name)) return *added;  // by another program
    people.push_back({unused_code(people), name});
    const std::string text = names_text(people);
    // A text that cannot be read back must not replace a valid file.
    BOLT_TRY(parse_names(text, names_path(folder).string()));
    BOLT_TRY(write_private_file(names_path(folder), text));
    return people.back();
}

Result<bool> forget_name(const fs::path& folder, std::string_view code) {
    std::error_code unknown;
    if (!fs::is_directory(folder, unknown)) return false;
    BOLT_TRY_ASSIGN(const auto lock, NamesLock::acquire(folder));
    BOLT_TRY_ASSIGN(auto people, list_people(folder));
    // A killed program may have left names in the temporary file.
    fs::remove(names_path(folder).string() + ".part", unknown);
    if (std::erase_if(people, [&](const Person& p) { return p.code == code; }) == 0) return false;
    BOLT_TRY(write_private_file(names_path(folder), names_text(people)));
    return true;
}

}  // namespace bolt::content

// import_fuzz BOLT_AUTHOR STEP [SEEDS [FIRST_SEED]]: damages a STEP file in SEEDS different ways (default 60)
// and runs `bolt-author import-step` on each. The program must end by itself with exit code 0 or 3, an error
// must name the file and an expectation, and only a complete output folder may be left. Damaged files that
// violate this are kept in import_fuzz_failures below the working folder; SEEDS 1 with FIRST_SEED repeats one
// of them.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <mutex>
#include <set>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "engine/base/process.hpp"
#include "engine/base/random.hpp"
#include "tests/support/folder.hpp"

namespace {

using namespace bolt;
namespace fs = std::filesystem;

constexpr int processor_limit_s = 5;  // the undamaged file takes 0.1 s
constexpr int wall_limit_s = 100;     // of one run on a busy machine
constexpr unsigned workers = 2;

struct Token {
    std::size_t begin = 0, length = 0;
};

std::size_t below(Random& random, std::size_t count) {
    return static_cast<std::size_t>(random.bits() % count);
}

// Returns every token of at least `shortest` characters that starts with a character that `first` accepts and
// continues with characters that `inside` accepts.
template <class Inside>
std::vector<Token> find_tokens(const std::string& text, std::size_t from, const Inside& first,
                               const Inside& inside, std::size_t shortest) {
    std::vector<Token> tokens;
    for (std::size_t at = from; at < text.size();) {
        std::size_t end = at + 1;
        if (first(text[at])) {
            while (end < text.size() && inside(text[end])) ++end;
            if (end - at >= shortest) tokens.push_back({at, end - at});
        }
        at = end;
    }
    return tokens;
}

using CharacterTest = bool (*)(char);
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_hash(char c) { return c == '#'; }
bool is_number(char c) { return is_digit(c) || c == '.' || c == 'E' || c == '-'; }

void change_bytes(std::string& text, std::size_t data, Random& random) {
    for (std::size_t count = 1 + below(random, 4); count > 0; --count) {
        const std::size_t at = data + below(random, text.size() - data);
        text[at] = below(random, 2) == 0 ? static_cast<char>('0' + below(random, 10))
                                         : static_cast<char>(below(random, 256));
    }
}

void delete_lines(std::string& text, std::size_t data, Random& random) {
    for (std::size_t count = 1 + below(random, 4); count > 0; --count) {
        const std::size_t begin = text.find('\n', data + below(random, text.size() - data));
        const std::size_t end = begin == std::string::npos ? begin : text.find('\n', begin + 1);
        if (end != std::string::npos) text.erase(begin, end - begin);
    }
}

void swap_references(std::string& text, std::size_t data, Random& random) {
    const auto references = find_tokens<CharacterTest>(text, data, is_hash, is_digit, 2);
    if (references.size() < 2) return;
    Token a = references[below(random, references.size())], b = references[below(random, references.size())];
    if (a.begin == b.begin) return;
    if (a.begin > b.begin) std::swap(a, b);
    const std::string first = text.substr(a.begin, a.length), second = text.substr(b.begin, b.length);
    text.replace(b.begin, b.length, first);
    text.replace(a.begin, a.length, second);
}

void truncate_numbers(std::string& text, std::size_t data, Random& random) {
    for (std::size_t count = 1 + below(random, 4); count > 0; --count) {
        const auto numbers = find_tokens<CharacterTest>(text, data, is_digit, is_number, 2);
        if (numbers.empty()) return;
        const Token& number = numbers[below(random, numbers.size())];
        const std::size_t kept = below(random, number.length);
        text.erase(number.begin + kept, number.length - kept);
    }
}

std::string damage(std::string text, std::uint64_t seed) {
    Random random(seed);
    const std::size_t data = text.find("DATA;") + 5;
    for (std::size_t count = 1 + below(random, 8) / 6; count > 0; --count) {
        switch (below(random, 4)) {
            case 0:
                change_bytes(text, data, random);
                break;
            case 1:
                delete_lines(text, data, random);
                break;
            case 2:
                swap_references(text, data, random);
                break;
            default:
                truncate_numbers(text, data, random);
                break;
        }
    }
    return text;
}

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator(folder, ignored))
        names.insert(entry.path().filename().string());
    return names;
}

struct Tally {
    std::atomic<int> imported{0}, refused{0}, crashed{0}, out_of_time{0}, out_of_memory{0}, failed{0};
};

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

// Runs the program on the file. Returns a description of its failure; empty if it behaved correctly.
std::string check(const std::string& program, const fs::path& folder, Tally& tally) {
    const fs::path file = folder / "damaged.step", out = folder / "out";
    const auto begin = std::chrono::steady_clock::now();
    const auto run = run_program(
        {"timeout", "-s", "KILL", std::to_string(wall_limit_s), program, "import-step", file.string(), "-o",
         out.string(), "--time-limit", std::to_string(processor_limit_s), "--memory-limit", "2048"},
        Capture::output_and_errors);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (!run) return run.error().message();
    if (seconds > wall_limit_s) return fmt::format("still runs after {} s", wall_limit_s);
    if (run->exit_code < 0) return "the program itself was ended by a signal\n" + run->output;
    const bool imported = run->exit_code == 0;
    if (!imported && run->exit_code != 3)
        return fmt::format("exit code {}; expected 0 or 3\n{}", run->exit_code, run->output);
    if (!imported && !contains(run->output, file.string() + ":"))
        return "the error does not name the file\n" + run->output;
    if (!imported && !contains(run->output, "; expected "))
        return "the error names no expectation\n" + run->output;
    const std::set<std::string> expected_names =
        imported ? std::set<std::string>{"damaged.step", "out"} : std::set<std::string>{"damaged.step"};
    if (names_in(folder) != expected_names)
        return "files are left beside the output folder, or it is missing";
    if (imported &&
        (names_in(out).count("damaged.glb") == 0 || names_in(out).count("damaged.contact.glb") == 0))
        return "the output folder is not complete";
    ++(imported                                               ? tally.imported
       : contains(run->output, "OpenCASCADE ended by signal") ? tally.crashed
       : contains(run->output, "of processor time")           ? tally.out_of_time
       : contains(run->output, "of memory while")             ? tally.out_of_memory
                                                              : tally.refused);
    return {};
}

void work(const std::string& program, const std::string& good, std::uint64_t first, std::uint64_t seeds,
          std::atomic<std::uint64_t>& next, Tally& tally) {
    static std::mutex console;
    for (std::uint64_t i = next++; i < seeds; i = next++) {
        const test::Folder folder;
        std::ofstream(folder / "damaged.step", std::ios::binary) << damage(good, first + i);
        const std::string problem = check(program, folder.path(), tally);
        if (problem.empty()) continue;
        ++tally.failed;
        std::error_code ignored;
        fs::create_directory("import_fuzz_failures", ignored);
        const fs::path kept = fs::path("import_fuzz_failures") / fmt::format("seed-{}.step", first + i);
        fs::copy_file(folder / "damaged.step", kept, fs::copy_options::overwrite_existing, ignored);
        const std::lock_guard lock(console);
        fmt::print("seed {}: {} (kept as {})\n", first + i, problem, fs::absolute(kept).string());
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 3 || argc > 5) {
        fmt::print(stderr, "usage: import_fuzz BOLT_AUTHOR STEP [SEEDS [FIRST_SEED]]\n");
        return 2;
    }
    std::ifstream file(argv[2], std::ios::binary);
    std::ostringstream good;
    good << file.rdbuf();
    if (good.str().find("DATA;") == std::string::npos) {
        fmt::print(stderr, "{}: has no DATA section; expected a STEP file\n", argv[2]);
        return 3;
    }
    const std::uint64_t seeds = argc > 3 ? std::strtoull(argv[3], nullptr, 10) : 60;
    const std::uint64_t first = argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1;
    Tally tally;
    std::atomic<std::uint64_t> next{0};
    std::vector<std::thread> threads;
    for (unsigned i = 0; i < workers; ++i)
        threads.emplace_back([&] { work(argv[1], good.str(), first, seeds, next, tally); });
    for (std::thread& thread : threads) thread.join();
    fmt::print(
        "{} damaged files: {} imported, {} refused, {} crashes, {} without end and {} without memory "
        "contained, {} failures\n",
        seeds, tally.imported.load(), tally.refused.load(), tally.crashed.load(), tally.out_of_time.load(),
        tally.out_of_memory.load(), tally.failed.load());
    // Both results must occur; otherwise the damage is too weak or too strong.
    const bool varied = seeds < 20 || (tally.imported > 0 && tally.imported < static_cast<int>(seeds));
    if (!varied) fmt::print("expected some damaged files to be imported and some to be refused\n");
    return tally.failed == 0 && varied ? 0 : 1;
}

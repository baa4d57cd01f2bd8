#include "tools/author/import/guard.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <new>
#include <string>
#include <utility>
#include <vector>

namespace bolt::step_import {

namespace {

// Exit code of a child process that caught std::bad_alloc. No program of ours uses it otherwise.
constexpr int memory_exit_code = 250;
constexpr std::array stop_signals = {SIGINT, SIGTERM, SIGHUP, SIGQUIT};

void set_limit(decltype(RLIMIT_CPU) resource, rlim_t value) {
    rlimit limit{};
    if (getrlimit(resource, &limit) != 0) return;
    limit.rlim_cur = std::min(limit.rlim_cur, value);
    (void)setrlimit(resource, &limit);
}

[[noreturn]] void run_child(const GuardLimits& limits, const std::function<int(GuardChannel&)>& work,
                            GuardChannel& channel) {
    set_limit(RLIMIT_CPU, limits.processor_s);
    set_limit(RLIMIT_CORE, 0);
#ifndef BOLT_SANITIZES_ADDRESS  // its shadow memory takes terabytes of address space
    if (limits.memory_mib > 0) set_limit(RLIMIT_AS, limits.memory_mib << 20U);
#endif
    for (const int number : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGXCPU})
        (void)std::signal(number, SIG_DFL);
    int code = 1;
    try {
        code = work(channel);
    } catch (const std::bad_alloc&) {
        code = memory_exit_code;
    } catch (const std::exception& error) {
        (void)std::fprintf(stderr, "error: %s\n", error.what());
    }
    (void)std::fflush(nullptr);
    _exit(code);  // the parent runs the destructors of static objects
}

// Returns the first stop signal that waits for this process; 0 if there is none.
int pending_stop_signal(const sigset_t& stop) {
    const timespec no_time{};
    const int number = sigtimedwait(&stop, nullptr, &no_time);
    return std::max(number, 0);
}

// Waits until the child process ends or a stop signal arrives. Kills the child process on a stop signal and
// returns the signal. Otherwise returns a pending stop signal, or 0.
int wait_for_child(pid_t child, const sigset_t& stop, const sigset_t& all, int& status) {
    while (waitpid(child, &status, WNOHANG) == 0) {
        const int number = sigwaitinfo(&all, nullptr);
        if (number <= 0 || number == SIGCHLD) continue;
        (void)kill(child, SIGKILL);
        while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
        }
        return number;
    }
    // Ctrl-C in a terminal reaches both processes, and the child may be the first to end.
    return pending_stop_signal(stop);
}

void classify(int status, GuardedRun& run) {
    if (WIFEXITED(status)) {
        run.code = WEXITSTATUS(status);
        run.outcome = run.code == memory_exit_code ? GuardOutcome::out_of_memory : GuardOutcome::exited;
        return;
    }
    run.code = WTERMSIG(status);
    const bool is_stop = std::find(stop_signals.begin(), stop_signals.end(), run.code) != stop_signals.end();
    run.outcome = run.code == SIGXCPU              ? GuardOutcome::out_of_time
                  : run.code == SIGKILL || is_stop ? GuardOutcome::killed
                                                   : GuardOutcome::crashed;
}

}  // namespace

struct GuardChannel::SharedPage {
    std::array<char, 201> phase;
};

GuardChannel::GuardChannel() {
    void* page = mmap(nullptr, sizeof(SharedPage), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (page != MAP_FAILED) page_ = static_cast<SharedPage*>(page);
    result_file_ = memfd_create("guarded-result", MFD_CLOEXEC);
}

GuardChannel::~GuardChannel() {
    if (page_ != nullptr) (void)munmap(page_, sizeof(SharedPage));
    if (result_file_ >= 0) (void)close(result_file_);
}

void GuardChannel::set_phase(std::string_view phase) {
    if (page_ == nullptr) return;
    const std::size_t length = std::min(phase.size(), page_->phase.size() - 1);
    std::memcpy(page_->phase.data(), phase.data(), length);
    page_->phase[length] = '\0';
}

std::string GuardChannel::phase() const { return page_ == nullptr ? std::string() : page_->phase.data(); }

bool GuardChannel::append_result(std::string_view text) {
    while (!text.empty()) {
        const ssize_t written = ::write(result_file_, text.data(), text.size());
        if (written < 0 && errno == EINTR) continue;
        if (written <= 0) return false;
        text.remove_prefix(static_cast<std::size_t>(written));
    }
    return true;
}

std::string GuardChannel::result() const {
    std::string text;
    std::array<char, 4096> buffer{};
    for (;;) {
        const ssize_t count =
            pread(result_file_, buffer.data(), buffer.size(), static_cast<off_t>(text.size()));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return text;
        text.append(buffer.data(), static_cast<std::size_t>(count));
    }
}

GuardLimits default_limits(const std::filesystem::path& step) {
    std::error_code problem;
    const auto bytes = std::filesystem::file_size(step, problem);
    GuardLimits limits;
    if (!problem)
        limits.processor_s += static_cast<unsigned>(std::min<std::uintmax_t>(bytes / 16384, 100000));
    const long pages = sysconf(_SC_PHYS_PAGES), page_bytes = sysconf(_SC_PAGE_SIZE);
    if (pages > 0 && page_bytes > 0)
        limits.memory_mib =
            static_cast<std::uint64_t>(pages) * static_cast<std::uint64_t>(page_bytes) / 4 * 3 >> 20U;
    return limits;
}

GuardedRun run_guarded(const GuardLimits& limits, const std::function<int(GuardChannel&)>& work) {
    GuardChannel channel;
    // Stop signals are blocked and polled, so that the caller can remove its files before it ends.
    sigset_t stop, all, before;
    sigemptyset(&stop);
    for (const int number : stop_signals) {
        struct sigaction action {};
        if (sigaction(number, nullptr, &action) == 0 && action.sa_handler != SIG_IGN)
            sigaddset(&stop, number);
    }
    all = stop;
    sigaddset(&all, SIGCHLD);
    const auto sigchld_before = std::signal(SIGCHLD, SIG_DFL);
    sigprocmask(SIG_BLOCK, &all, &before);
    (void)std::fflush(nullptr);

    GuardedRun run;
    const pid_t parent = getpid();
    const pid_t child = fork();
    if (child == 0) {
        (void)prctl(PR_SET_PDEATHSIG, SIGKILL);
        if (getppid() != parent) _exit(1);
        sigprocmask(SIG_SETMASK, &before, nullptr);
        run_child(limits, work, channel);
    }
    if (child < 0) {
        run.code = errno;
    } else {
        int status = 0;
        if (const int number = wait_for_child(child, stop, all, status); number != 0) {
            run.outcome = GuardOutcome::interrupted;
            run.code = number;
        } else {
            classify(status, run);
        }
    }
    sigprocmask(SIG_SETMASK, &before, nullptr);
    (void)std::signal(SIGCHLD, sigchld_before);
    run.phase = channel.phase();
    run.result = channel.result();
    return run;
}

namespace fs = std::filesystem;

namespace {

tl::unexpected<Error> file_error(const fs::path& file, const std::string& what) {
    Error error;
    error.code = ErrorCode::failed;
    error.file = file.string();
    error.what = what;
    error.expected = "a path that this user may write to, and free space";
    return fail(std::move(error));
}

fs::path without_trailing_slash(const fs::path& path) {
    std::error_code ignored;
    const fs::path whole = fs::absolute(path, ignored).lexically_normal();
    return whole.has_filename() ? whole : whole.parent_path();
}

// Returns the nearest folder above `output` that exists.
fs::path existing_parent(const fs::path& output) {
    std::error_code ignored;
    fs::path parent = output.parent_path();
    while (!fs::exists(parent, ignored) && parent.has_relative_path()) parent = parent.parent_path();
    return parent;
}

bool same_file_system(const fs::path& a, const fs::path& b) {
    struct stat of_a {
    }, of_b{};
    return ::stat(a.c_str(), &of_a) == 0 && ::stat(b.c_str(), &of_b) == 0 && of_a.st_dev == of_b.st_dev;
}

// Returns a locked descriptor of the folder; −1 if another process holds the lock or the folder is gone.
int lock_folder(const fs::path& folder) {
    const int file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    if (file < 0) return -1;
    if (::flock(file, LOCK_EX | LOCK_NB) == 0) return file;
    (void)::close(file);
    return -1;
}

void remove_stale(const fs::path& parent, const std::string& prefix) {
    std::error_code problem;
    std::vector<fs::path> stale;
    for (fs::directory_iterator at(parent, problem), end; !problem && at != end; at.increment(problem))
        if (at->path().filename().string().starts_with(prefix)) stale.push_back(at->path());
    for (const fs::path& folder : stale)
        if (const int lock = lock_folder(folder); lock >= 0) {
            fs::remove_all(folder, problem);
            (void)::close(lock);
        }
}

}  // namespace

Result<StagingFolder> StagingFolder::create(const fs::path& output) {
    const fs::path whole = without_trailing_slash(output);
    const std::string prefix = "." + whole.filename().string() + ".import-";
    std::error_code ignored;
    const bool output_exists = fs::is_directory(whole, ignored);
    const fs::path beside = existing_parent(whole);
    std::vector<fs::path> parents;
    if (!output_exists || same_file_system(beside, whole)) parents.push_back(beside);
    if (output_exists) parents.push_back(whole);
    for (const fs::path& parent : parents) remove_stale(parent, prefix);
    int problem = 0;
    for (const fs::path& parent : parents) {
        for (int number = 1; number <= 1000; ++number) {
            const fs::path path = parent / (prefix + std::to_string(number));
            if (::mkdir(path.c_str(), 0777) != 0) {
                problem = errno;
                if (problem == EEXIST) continue;
                break;
            }
            // Another import may have taken the new folder for a stale one before it was locked.
            if (const int lock = lock_folder(path); lock >= 0) {
                if (fs::exists(path, ignored)) return StagingFolder(path, output, lock);
                (void)::close(lock);
            }
        }
    }
    return file_error(output, std::string("cannot be created: ") + std::strerror(problem));
}

StagingFolder::StagingFolder(StagingFolder&& other) noexcept
    : path_(std::move(other.path_)),
      output_(std::move(other.output_)),
      lock_(std::exchange(other.lock_, -1)) {}

StagingFolder::~StagingFolder() {
    if (lock_ < 0) return;
    std::error_code ignored;
    fs::remove_all(path_, ignored);
    (void)::close(lock_);
}

Status StagingFolder::publish() {
    std::error_code problem;
    if (!fs::exists(output_, problem)) {
        fs::create_directories(without_trailing_slash(output_).parent_path(), problem);
        fs::rename(path_, without_trailing_slash(output_), problem);
        if (!problem) {
            (void)::close(std::exchange(lock_, -1));
            return {};
        }
        if (!fs::is_directory(output_)) return file_error(output_, "cannot be created: " + problem.message());
    }
    std::vector<fs::path> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(path_, problem))
        files.push_back(entry.path().filename());
    // Models before the assembly.json that names them.
    std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
        return std::pair(a.extension() == ".json", a) < std::pair(b.extension() == ".json", b);
    });
    for (const fs::path& file : files) {
        fs::rename(path_ / file, output_ / file, problem);
        if (problem) return file_error(output_ / file, "cannot be written: " + problem.message());
    }
    return {};
}

}  // namespace bolt::step_import

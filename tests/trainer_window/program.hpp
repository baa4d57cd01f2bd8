// The trainer in a window on the test screen, with Vulkan validation.
#pragma once

#include <doctest/doctest.h>

#include <filesystem>
#include <functional>
#include <mutex>
#include <thread>

#include "game/trainer/app.hpp"
#include "game/view/window.hpp"
#include "tests/support/need.hpp"
#include "tests/trainer_window/window_driver.hpp"

namespace bolt::test {

// The program's log, which another thread can poll.
class Log {
  public:
    void add(const std::string& line) {
        const std::lock_guard lock(mutex_);
        lines_.push_back(line);
    }
    bool has(const std::string& part) {
        const std::lock_guard lock(mutex_);
        for (const std::string& line : lines_)
            if (line.find(part) != std::string::npos) return true;
        return false;
    }

    std::vector<std::string> lines() {
        const std::lock_guard lock(mutex_);
        return lines_;
    }

  private:
    std::mutex mutex_;
    std::vector<std::string> lines_;
};

struct Program {
    Log log;
    std::filesystem::path out;
    platform::Desktop desktop = need(platform::Desktop::open());
    platform::Window window;
    std::optional<gpu::Instance> instance;
    std::optional<trainer::App> app;
    std::optional<session::LessonOutcome> played;

    Program(trainer::AppOptions options, platform::Size size)
        : out(options.out),
          window(need(platform::Window::open(desktop, {"boltwright", size.width, size.height}))) {
        gpu::InstanceOptions validated;
        validated.validation = true;
        const std::vector<const char*> extensions = need(desktop.vulkan_extensions());
        validated.extensions = extensions;
        instance.emplace(need(gpu::Instance::create(validated)));
        std::filesystem::create_directories(out);
        options.log = [this](const std::string& line) { log.add(line); };
        options.on_end = [this](const content::Assembly&, const session::LessonOptions&,
                                const session::LessonOutcome& how, const std::filesystem::path&) {
            played = how;
            return Status{};
        };
        app.emplace(std::move(options));
    }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    ~Program() {
        app->release();
        for (const std::string& message : instance->log().messages) FAIL_CHECK(message);
    }
};

// Runs the program while `act` uses it in a thread of its own, until `act` is done. Throws what `act` throws.
inline Status run_with_user(Program& program, WindowDriver& driver, const std::function<void()>& act) {
    std::exception_ptr thrown;
    std::thread user_thread([&] {
        try {
            driver.run(act);
        } catch (...) {
            thrown = std::current_exception();
        }
    });
    const Status run = view::run_in_window(*program.app, program.window, *program.instance,
                                           {{}, [&] { return driver.turn(); }});
    driver.window_closed();
    user_thread.join();
    if (thrown) std::rethrow_exception(thrown);
    return run;
}

}  // namespace bolt::test

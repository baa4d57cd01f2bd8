// Fault injection for Vulkan: while a Fault lives, one of volk's function pointers points to a failing
// function.
#pragma once

#include "engine/gpu/vk.hpp"

namespace bolt::test {

enum class Happens : std::uint8_t {
    instead,    // the real function is not called
    afterwards  // the real function is called, and its result is replaced
};

template <auto* function, class Pointer = std::remove_pointer_t<decltype(function)>>
class Fault;

template <auto* function, class... Args>
class Fault<function, VkResult(VKAPI_PTR*)(Args...)> {
  public:
    // Fails `times` times after `first` successful calls.
    Fault(VkResult result, int times = 1, Happens how = Happens::instead, int first = 0) {
        original() = *function;
        plan() = {result, times, first, how, 0};
        *function = call;
    }
    Fault(const Fault&) = delete;
    Fault& operator=(const Fault&) = delete;
    ~Fault() {
        if (*function == call) *function = original();  // unless a new device has loaded its own
    }

    [[nodiscard]] int failed() const { return plan().failed; }

  private:
    struct Plan {
        VkResult result = VK_SUCCESS;
        int times = 0, first = 0;
        Happens how = Happens::instead;
        int failed = 0;
    };
    static Plan& plan() {
        static Plan it;
        return it;
    }
    static auto original() -> VkResult(VKAPI_PTR*&)(Args...) {
        static VkResult(VKAPI_PTR * it)(Args...) = nullptr;
        return it;
    }
    static VKAPI_ATTR VkResult VKAPI_CALL call(Args... args) {
        Plan& p = plan();
        const bool fails = p.first <= 0 && p.failed < p.times;
        if (p.first > 0) --p.first;
        if (fails) ++p.failed;
        if (fails && p.how == Happens::instead) return p.result;
        const VkResult result = original()(args...);
        return fails && result == VK_SUCCESS ? p.result : result;
    }
};

}  // namespace bolt::test

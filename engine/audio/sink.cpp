#include "engine/audio/sink.hpp"

#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>
#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <vector>

namespace bolt::audio {

namespace {

struct CloseDevice {
    void operator()(ALCdevice* device) const { alcCloseDevice(device); }
};
struct DestroyContext {
    void operator()(ALCcontext* context) const { alcDestroyContext(context); }
};
using AlDevice = std::unique_ptr<ALCdevice, CloseDevice>;
using AlContext = std::unique_ptr<ALCcontext, DestroyContext>;

tl::unexpected<Error> no_sound(std::string what) {
    return fail(ErrorCode::no_device, std::move(what),
                "a sound card, PulseAudio or PipeWire; ALSOFT_DRIVERS chooses among them");
}

tl::unexpected<Error> disconnected() {
    Error error;
    error.code = ErrorCode::no_device;
    error.what = "the sound device was disconnected";
    error.expected = "a connected one";
    error.lost = true;
    return fail(std::move(error));
}

void ignore_message(const char*, int, const char*, int, const char*, ...) {}

// Without a sound card, ALSA prints eight lines to the console. They are suppressed, because the error is
// reported anyway. ALSA is not linked, because it may not be installed.
void silence_alsa() {
    void* alsa = dlopen("libasound.so.2", RTLD_LAZY);
    if (alsa == nullptr) return;
    using Handler = void (*)(const char*, int, const char*, int, const char*, ...);
    using Set = int (*)(Handler);
    if (auto* set = reinterpret_cast<Set>(dlsym(alsa, "snd_lib_error_set_handler")); set != nullptr)
        set(ignore_message);
}

class OpenAl final : public Sink {
  public:
    OpenAl(AlDevice device, AlContext context) : device_(std::move(device)), context_(std::move(context)) {}
    ~OpenAl() override {
        if (source_ != 0) {
            alSourceStop(source_);
            alSourcei(source_, AL_BUFFER, 0);
            alDeleteSources(1, &source_);
        }
        if (buffers_[0] != 0) alDeleteBuffers(static_cast<ALsizei>(buffers_.size()), buffers_.data());
        set_context(nullptr);
    }

    Status prepare() {
        if (!set_context(context_.get())) return no_sound("OpenAL cannot activate its context");
        alGetError();
        alGenBuffers(static_cast<ALsizei>(buffers_.size()), buffers_.data());
        alGenSources(1, &source_);
        if (alGetError() != AL_NO_ERROR) return no_sound("OpenAL cannot create a source");
        alSourcei(source_, AL_SOURCE_RELATIVE, AL_TRUE);  // independent of the listener's position
        free_.assign(buffers_.begin(), buffers_.end());
        return {};
    }

    [[nodiscard]] std::string name() const override {
        const ALCchar* name = alcGetString(device_.get(), ALC_DEVICE_SPECIFIER);
        return name != nullptr ? name : "OpenAL";
    }

    Result<std::size_t> free_blocks() override {
        ALCint connected = ALC_TRUE;
        if (alcIsExtensionPresent(device_.get(), "ALC_EXT_disconnect") == ALC_TRUE)
            alcGetIntegerv(device_.get(), ALC_CONNECTED, 1, &connected);
        if (connected != ALC_TRUE) return disconnected();
        ALint done = 0;
        alGetSourcei(source_, AL_BUFFERS_PROCESSED, &done);
        for (; done > 0; --done) {
            ALuint buffer = 0;
            alSourceUnqueueBuffers(source_, 1, &buffer);
            if (alGetError() != AL_NO_ERROR) return disconnected();
            free_.push_back(buffer);
        }
        start_if_stopped();
        return free_.size();
    }

    Status play(std::span<const float, block_size> samples) override {
        if (free_.empty())
            return fail(ErrorCode::failed, "the sound device has no free buffer",
                        "a call only after free_blocks() > 0");
        std::array<std::int16_t, block_size> pcm{};
        std::transform(samples.begin(), samples.end(), pcm.begin(), to_pcm16);
        const ALuint buffer = free_.back();
        alBufferData(buffer, AL_FORMAT_MONO16, pcm.data(), static_cast<ALsizei>(sizeof pcm), sample_rate);
        alSourceQueueBuffers(source_, 1, &buffer);
        if (alGetError() != AL_NO_ERROR) return disconnected();
        free_.pop_back();
        start_if_stopped();
        return {};
    }

    Status set_volume(double volume) override {
        alSourcef(source_, AL_GAIN, static_cast<ALfloat>(volume));
        return {};
    }

  private:
    // Starts playback for the first time and after an underrun, which stops the source. Does nothing until
    // the queue is full, to avoid another underrun.
    void start_if_stopped() {
        ALint state = AL_INITIAL;
        alGetSourcei(source_, AL_SOURCE_STATE, &state);
        if (state != AL_PLAYING && free_.empty()) alSourcePlay(source_);
    }

    // Sets the context for this thread only, if OpenAL supports that, so that other contexts are not
    // disturbed.
    bool set_context(ALCcontext* context) {
        if (alcIsExtensionPresent(nullptr, "ALC_EXT_thread_local_context") != ALC_TRUE)
            return alcMakeContextCurrent(context) == ALC_TRUE;
        using Set = ALCboolean (*)(ALCcontext*);
        const auto set = reinterpret_cast<Set>(alcGetProcAddress(nullptr, "alcSetThreadContext"));
        return set(context) == ALC_TRUE;
    }

    AlDevice device_;
    AlContext context_;
    std::array<ALuint, max_queued_blocks> buffers_{};
    std::vector<ALuint> free_;
    ALuint source_ = 0;
};

}  // namespace

Result<std::unique_ptr<Sink>> open_openal() {
    silence_alsa();
    AlDevice device(alcOpenDevice(nullptr));
    if (!device) return no_sound("no sound device can be opened");
    const std::array<ALCint, 3> attributes{ALC_FREQUENCY, sample_rate, 0};
    AlContext context(alcCreateContext(device.get(), attributes.data()));
    if (!context) return no_sound("the sound device accepts no context");
    auto sink = std::make_unique<OpenAl>(std::move(device), std::move(context));
    BOLT_TRY(sink->prepare());
    return sink;
}

}  // namespace bolt::audio

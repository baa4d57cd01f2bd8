#include "engine/audio/wav.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "engine/audio/sink.hpp"

namespace bolt::audio {

namespace {

constexpr std::size_t header_size = 44;
constexpr std::uint32_t unknown_length = 0xFFFFFFFFU;

void put(std::string& bytes, std::uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes += static_cast<char>((value >> (8 * i)) & 0xFFU);
}

// RIFF/WAVE (IBM and Microsoft, Multimedia Programming Interface and Data Specifications 1.0, 1991):
// little-endian chunks, `fmt ` with plain PCM, `data`.
std::string header(int rate, std::uint32_t data_bytes) {
    const auto samples_per_second = static_cast<std::uint32_t>(rate);
    std::string bytes = "RIFF";
    put(bytes, data_bytes == unknown_length ? unknown_length : data_bytes + (header_size - 8), 4);
    bytes += "WAVEfmt ";
    put(bytes, 16, 4);
    put(bytes, 1, 2);  // PCM
    put(bytes, 1, 2);  // channels
    put(bytes, samples_per_second, 4);
    put(bytes, 2 * samples_per_second, 4);  // bytes per second
    put(bytes, 2, 2);                       // bytes per sample
    put(bytes, 16, 2);                      // bits
    bytes += "data";
    put(bytes, data_bytes, 4);
    return bytes;
}

struct CloseFile {
    void operator()(std::FILE* file) const { (void)std::fclose(file); }
};

}  // namespace

struct WavWriter::State {
    std::filesystem::path path, part;
    std::unique_ptr<std::FILE, CloseFile> file;
    bool not_regular = false;  // a pipe or a device
    int rate = 0;
    std::uint64_t samples = 0;
    std::optional<Error> first_error;
    std::string bytes;

    ~State() {
        if (file && !not_regular) remove_part();
    }
    void remove_part() {
        file.reset();
        std::error_code ignored;
        if (!not_regular) std::filesystem::remove(part, ignored);
    }
    Status fail_writing(const std::string& why,
                        const std::string& expected = "a path that this user may write to, and free space") {
        Error error;
        error.file = path.string();
        error.what = "cannot be written: " + why;
        error.expected = expected;
        first_error = error;
        remove_part();
        return fail(error);
    }
    Status put_bytes(std::string_view bytes_to_write) {
        if (std::fwrite(bytes_to_write.data(), 1, bytes_to_write.size(), file.get()) != bytes_to_write.size())
            return fail_writing(std::strerror(errno));
        return {};
    }
};

WavWriter::WavWriter(std::unique_ptr<State> state) : state_(std::move(state)) {}
WavWriter::WavWriter(WavWriter&& other) noexcept = default;
WavWriter& WavWriter::operator=(WavWriter&& other) noexcept = default;
WavWriter::~WavWriter() = default;

Result<WavWriter> WavWriter::create(const std::filesystem::path& path, int rate) {
    auto state = std::make_unique<State>();
    std::error_code ignored;
    const std::filesystem::file_status target = std::filesystem::status(path, ignored);
    state->not_regular = std::filesystem::exists(target) && !std::filesystem::is_regular_file(target);
    state->path = state->part = path;
    if (!state->not_regular) state->part += ".part";
    state->rate = rate;
    state->file.reset(std::fopen(state->part.c_str(), "wb"));
    if (!state->file) return fail(state->fail_writing(std::strerror(errno)).error());
    BOLT_TRY(state->put_bytes(header(rate, unknown_length)));
    return WavWriter(std::move(state));
}

Status WavWriter::write(std::span<const float> samples) {
    State& s = *state_;
    if (s.first_error) return fail(*s.first_error);
    if (!s.not_regular && s.samples + samples.size() > max_wav_samples)
        return s.fail_writing("a WAV file cannot be larger than 4 GiB", "a shorter recording");
    s.samples += samples.size();
    s.bytes.clear();
    for (const float sample : samples) put(s.bytes, static_cast<std::uint16_t>(to_pcm16(sample)), 2);
    return s.put_bytes(s.bytes);
}

Status WavWriter::finish() {
    State& s = *state_;
    if (s.first_error) return fail(*s.first_error);
    if (!s.not_regular) {
        if (std::fseek(s.file.get(), 0, SEEK_SET) != 0) return s.fail_writing(std::strerror(errno));
        BOLT_TRY(s.put_bytes(header(s.rate, static_cast<std::uint32_t>(2 * s.samples))));
    }
    if (std::fclose(s.file.release()) != 0) {
        const std::string why = std::strerror(errno);
        return s.fail_writing(why);
    }
    s.first_error = Error{
        ErrorCode::failed, "is already finished", "one call of finish()", s.path.string(), 0, 0, {}, false};
    if (s.not_regular) return {};
    std::error_code renamed;
    std::filesystem::rename(s.part, s.path, renamed);
    if (renamed) return s.fail_writing(renamed.message());
    return {};
}

}  // namespace bolt::audio

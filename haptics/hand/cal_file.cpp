#include "haptics/hand/cal_file.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

namespace bolt::hand {

namespace {

constexpr std::size_t blocks = 6, lines_of_block = 4;
constexpr std::size_t offset_word = 5, gain_word = 8;  // from 0
constexpr double steepest = 0.2;                       // rad a count: 255 of them are eight turns

// The sensor of each line; nullopt: none.
constexpr std::array<std::array<std::optional<Sensor>, lines_of_block>, blocks> order = {{
    {Sensor::thumb_roll, Sensor::thumb_mpj, Sensor::thumb_ij, Sensor::thumb_abduction},
    {Sensor::index_mpj, Sensor::index_pij, Sensor::index_dij, std::nullopt},
    {Sensor::middle_mpj, Sensor::middle_pij, Sensor::middle_dij, Sensor::middle_abduction},
    {Sensor::ring_mpj, Sensor::ring_pij, Sensor::ring_dij, Sensor::ring_abduction},
    {Sensor::little_mpj, Sensor::little_pij, Sensor::little_dij, Sensor::little_abduction},
    {Sensor::palm_arch, Sensor::wrist_pitch, Sensor::wrist_yaw, std::nullopt},
}};
constexpr std::size_t index_block = 1, gain_of_middle_abduction = 3;

struct Word {
    std::string_view text;
    int column = 1;
};

std::vector<Word> words_of(std::string_view line) {
    std::vector<Word> words;
    constexpr std::string_view blank = " \t\r";
    for (std::size_t at = line.find_first_not_of(blank); at != std::string_view::npos;) {
        const std::size_t end = std::min(line.find_first_of(blank, at), line.size());
        words.push_back({line.substr(at, end - at), static_cast<int>(at) + 1});
        at = line.find_first_not_of(blank, end);
    }
    return words;
}

struct Reader {
    std::string_view left;
    const std::string& file;
    int line = 0;

    [[nodiscard]] tl::unexpected<Error> wrong(int column, std::string what, std::string expected) const {
        Error error;
        error.code = ErrorCode::bad_content;
        error.what = std::move(what);
        error.expected = std::move(expected);
        error.file = file;
        error.line = line;
        error.column = column;
        return fail(std::move(error));
    }
    Result<std::string_view> next(const char* wanted) {
        ++line;
        if (left.empty()) return wrong(1, "the calibration ends here", wanted);
        const std::size_t end = std::min(left.find('\n'), left.size());
        const std::string_view text = left.substr(0, end);
        left.remove_prefix(std::min(end + 1, left.size()));
        return text;
    }
    [[nodiscard]] Result<double> number(const std::vector<Word>& words, std::size_t i,
                                        const char* what) const {
        if (i >= words.size())
            return wrong(words.empty() ? 1 : words.back().column,
                         fmt::format("the line has {} words", words.size()),
                         fmt::format("the {} as word {}", what, i + 1));
        double value = 0.0;
        const std::string_view text = words[i].text;
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value))
            return wrong(words[i].column, fmt::format("\"{}\" is not a number", text.substr(0, 40)),
                         fmt::format("the {}", what));
        return value;
    }
};

}  // namespace

Result<Calibration> parse_cal(std::string_view text, const std::string& file) {
    Reader reader{text, file};
    BOLT_TRY(reader.next("a line of title"));
    Calibration calibration;
    std::optional<double> gain_elsewhere;
    for (std::size_t block = 0; block < blocks; ++block) {
        BOLT_TRY(reader.next("the heading of a finger or of the palm"));
        for (std::size_t i = 0; i < lines_of_block; ++i) {
            BOLT_TRY_ASSIGN(const auto line, reader.next("a sensor's line"));
            const auto words = words_of(line);
            BOLT_TRY_ASSIGN(const auto offset, reader.number(words, offset_word, "offset in counts"));
            BOLT_TRY_ASSIGN(const auto gain, reader.number(words, gain_word, "gain in radians a count"));
            if (std::abs(gain) > steepest)
                return reader.wrong(words[gain_word].column, fmt::format("a gain of {} rad per count", gain),
                                    fmt::format("at most {}", steepest));
            if (block == index_block && i == gain_of_middle_abduction) gain_elsewhere = gain;
            const auto& sensor = order[block][i];
            if (sensor && gain != 0.0) calibration.fits[index(*sensor)] = LinearFit{gain, offset};
        }
    }
    auto& abduction = calibration.fits[index(Sensor::middle_abduction)];
    if (abduction && gain_elsewhere && *gain_elsewhere != 0.0) abduction->gain = *gain_elsewhere;
    return calibration;
}

}  // namespace bolt::hand

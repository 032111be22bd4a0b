// Gray and colour maps, binary: PGM and PPM. The reader of the other common pictures takes the two bytes of a texel the
// wrong way round, and makes gray of two-byte colours as if they had one, past their end.
#include "jit/picture/picture.h"
#include "lang/text/number.h"

#include <algorithm>
#include <charconv>
#include <cstdint>

namespace haptel::jit {

Picture read_pnm(std::string_view bytes, Colours kept)
{
    // Width, height and greatest value, in digits, and one character. What is no digit parts them, and lines from '#'
    // on.
    int32_t width = 0, height = 0, most = 0;
    size_t at = 2;
    for (int32_t* const number : {&width, &height, &most}) {
        for (; at < bytes.size() && !lang::is_digit(bytes[at]); ++at)
            if (bytes[at] == '#') at = std::min(bytes.find_first_of("\r\n", at), bytes.size());
        const char* const begin = bytes.data() + std::min(at, bytes.size());
        const auto [end, error] = std::from_chars(begin, bytes.data() + bytes.size(), *number);
        if (error == std::errc::result_out_of_range)
            return no_picture("is damaged: a number in its header is too large");
        at += static_cast<size_t>(end - begin);
    }
    if (most < 1 || most > 65535) return no_picture("is damaged: its greatest value is not one from 1 to 65535");
    Picture made = picture_of(width, height);
    if (!made.error.empty()) return made;
    made.levels = most;
    const size_t colours = bytes[1] == '6' ? 3 : 1, value_bytes = most > 255 ? 2 : 1;
    bytes.remove_prefix(std::min(at + 1, bytes.size()));
    if (bytes.size() / (colours * value_bytes) < made.gray.size())
        return no_picture("is damaged: it ends before its last texel");
    if (kept == Colours::kept) keep_colours(made, colours);

    const auto* from = reinterpret_cast<const uint8_t*>(bytes.data());
    const auto value = [&] {
        const int first = *from++, whole = value_bytes == 1 ? first : first << 8 | *from++;
        return static_cast<double>(std::min(whole, most)) / most;
    };
    for (int64_t row = height; row-- > 0;) // files begin at the top
        for (int64_t column = 0; column < width; ++column) {
            double values[3] = {};
            for (size_t i = 0; i < colours; ++i) values[i] = value();
            put_texel(made, static_cast<size_t>(row * width + column), {values, colours});
        }
    return made;
}

} // namespace haptel::jit

// Gray and colour maps, binary: PGM and PPM. The reader of the other common pictures takes the two bytes of a texel the
// wrong way round, and makes gray of two-byte colours as if they had one, past their end.
#include "jit/picture/picture.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace haptel::jit {
namespace {

struct Header {
    int64_t width = 0, height = 0, most = 0;
    size_t end = 0; // of the header: the first texel
    bool too_large = false;
};

// Width, height and greatest value, in digits, and one character. What is no digit parts them, and lines from '#' on.
Header header_of(std::string_view bytes)
{
    Header header;
    size_t at = 2;
    for (int64_t* const number : {&header.width, &header.height, &header.most}) {
        for (; at < bytes.size() && (bytes[at] < '0' || bytes[at] > '9'); ++at)
            if (bytes[at] == '#') at = std::min(bytes.find_first_of("\r\n", at), bytes.size());
        int digits = 0;
        for (; at < bytes.size() && bytes[at] >= '0' && bytes[at] <= '9'; ++at) {
            if (++digits > 9) return {.too_large = true};
            *number = 10 * *number + (bytes[at] - '0');
        }
    }
    header.end = std::min(at + 1, bytes.size());
    return header;
}

} // namespace

bool is_pnm(std::string_view bytes)
{
    return bytes.starts_with("P5") || bytes.starts_with("P6");
}

Picture read_pnm(std::string_view bytes)
{
    const Header header = header_of(bytes);
    if (header.too_large) return no_picture("is damaged: a number in its header is too large");
    if (header.most < 1 || header.most > 65535)
        return no_picture("is damaged: its greatest value is not one from 1 to 65535");
    Picture made = picture_of(header.width, header.height);
    if (!made.error.empty()) return made;
    made.levels = static_cast<double>(header.most);
    const size_t colours = bytes[1] == '6' ? 3 : 1, value_bytes = header.most > 255 ? 2 : 1;
    bytes.remove_prefix(header.end);
    if (bytes.size() / (colours * value_bytes) < made.gray.size())
        return no_picture("is damaged: it ends before its last texel");

    const auto* from = reinterpret_cast<const uint8_t*>(bytes.data());
    const auto value = [&] {
        const int first = *from++, whole = value_bytes == 1 ? first : first << 8 | *from++;
        return static_cast<double>(std::min<int64_t>(whole, header.most)) / static_cast<double>(header.most);
    };
    for (int64_t row = header.height; row-- > 0;) // files begin at the top
        for (int64_t column = 0; column < header.width; ++column) {
            double values[3] = {};
            for (size_t i = 0; i < colours; ++i) values[i] = value();
            made.gray[static_cast<size_t>(row * header.width + column)] =
                colours == 1 ? values[0] : brightness(values[0], values[1], values[2]);
        }
    return made;
}

} // namespace haptel::jit

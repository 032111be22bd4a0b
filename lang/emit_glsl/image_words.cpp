#include "lang/emit_glsl/image_words.h"

#include <bit>
#include <map>

namespace haptel::emit_glsl {

namespace {

uint32_t place_in(const std::vector<uint32_t>& words)
{
    return static_cast<uint32_t>(words.size());
}

// Coefficients that several images share stand there once.
class ImageWriter {
public:
    explicit ImageWriter(std::vector<uint32_t>& to) : words(to) {}

    void write(uint32_t place, const haptel_image& image, uint32_t first_part)
    {
        const int32_t head[] = {image.width, image.height, image.channels, image.levels, image.channel, image.level};
        for (size_t i = 0; i < std::size(head); ++i) words[place + i] = static_cast<uint32_t>(head[i]);
        words[place + 6] = first_part;
        for (int edge : {HAPTEL_EDGE_CLAMPED, HAPTEL_EDGE_TILED, HAPTEL_EDGE_MIRRORED}) {
            const uint64_t border = edge == HAPTEL_EDGE_CLAMPED ? 2 : 0;
            const uint64_t count = (image.width + border) * (image.height + border);
            const uint32_t coefficients = place_of(image.coefficients[edge], count);
            words[place + 7 + edge] = coefficients;
        }
    }

private:
    std::vector<uint32_t>& words;
    std::map<std::pair<const double*, uint64_t>, uint32_t> places;

    uint32_t place_of(const double* coefficients, uint64_t count)
    {
        const auto [known, is_new] = places.emplace(std::pair{coefficients, count}, place_in(words));
        if (is_new)
            for (uint64_t i = 0; i < count; ++i)
                words.push_back(std::bit_cast<uint32_t>(static_cast<float>(coefficients[i])));
        return known->second;
    }
};

} // namespace

int32_t append_image(std::vector<uint32_t>& words, const haptel_image& image)
{
    if (words.empty()) words.push_back(0);
    const uint32_t place = place_in(words);
    const uint32_t parts = image.parts ? static_cast<uint32_t>(image.channels * image.levels) : 0;
    words.resize(words.size() + (1 + parts) * words_of_image);
    const uint32_t first_part = parts ? place + words_of_image : 0;
    ImageWriter writer(words);
    writer.write(place, image, first_part);
    for (uint32_t i = 0; i < parts; ++i) writer.write(first_part + i * words_of_image, image.parts[i], first_part);
    return static_cast<int32_t>(place);
}

} // namespace haptel::emit_glsl

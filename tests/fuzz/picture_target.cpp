// Files that claim to be pictures.
#include "jit/picture/picture.h"
#include "lang/ir/bounds/spline_image.h"
#include "lang/math/spline.h"
#include "tests/fuzz/target.h"
#include "tests/jit/picture/pictures.h"

#include <cmath>

namespace haptel::fuzz {

void read_picture(std::string_view bytes)
{
    const jit::Picture picture = jit::read_picture(bytes, jit::Colours::kept);
    if (picture.error.empty() == picture.gray.empty()) fail("neither a picture nor a reason, or both");
    if (picture.gray.size() != static_cast<size_t>(picture.width * picture.height)) fail("a picture of two sizes");
    count(picture.error.empty() ? "pictures" : "refused");
    std::string error;
    for (const auto& colour : picture.colours)
        if (!colour.empty() && colour.size() != picture.gray.size()) fail("a colour of another size");
    const auto& [red, green, blue, alpha] = picture.colours;
    const auto image = ir::SplineImage::make({picture.gray, {red, green, blue, alpha}, picture.width, picture.height},
                                             {.channels = 15, .levels = true}, error);
    if (!image) return;
    for (int32_t colour = 0; colour < 4; ++colour)
        for (int32_t level : {0, 1, 20})
            for (const double place : {-1e9, -0.5, 0.25, 3.0, 1e9})
                if (!std::isfinite(ir::spline(ir::image_coarser(ir::image_channel(&image->view(), colour), level),
                                              place, 2 * place, ir::spline_order(0, 0))))
                    fail("a height that is not finite");
}

std::vector<std::string> picture_corpus()
{
    const test::Texels value = [](int column, int row) { return 0.5 + 0.3 * std::sin(0.4 * column + 0.3 * row); };
    test::TiffKind tiled{32, test::Numbers::real}, colour{8, test::Numbers::unsigned_whole};
    tiled.tile = 16;
    colour.colour = colour.planes_apart = true;
    return {test::png(20, 15, 8, value),
            test::png(20, 15, 16, value),
            "P5\n3 2\n255\nabcdef",
            "P6\n2 1\n1000\nabcdefghijkl",
            test::tiff(20, 15, {16, test::Numbers::unsigned_whole}, value),
            test::tiff(20, 15, tiled, value),
            test::tiff(20, 15, colour, value),
            test::exr(20, 15, false, {{"Y"}}, value),
            test::exr(20, 15, true, {{"B"}, {"G"}, {"R"}}, value)};
}

} // namespace haptel::fuzz

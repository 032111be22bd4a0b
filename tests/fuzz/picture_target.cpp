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
    const jit::Picture picture = jit::read_picture(bytes);
    if (picture.error.empty() == picture.gray.empty()) fail("neither a picture nor a reason, or both");
    if (picture.gray.size() != static_cast<size_t>(picture.width * picture.height)) fail("a picture of two sizes");
    count(picture.error.empty() ? "pictures" : "refused");
    std::string error;
    const auto image = ir::SplineImage::make(picture.gray, picture.width, picture.height, error);
    if (!image) return;
    for (const double place : {-1e9, -0.5, 0.25, 3.0, 1e9})
        if (!std::isfinite(ir::spline(&image->view(), place, 2 * place, ir::spline_order(0, 0))))
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

#include "tools/plot/plot_picture.h"

#include <algorithm>
#include <cairo.h>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fmt/format.h>
#include <numbers>

namespace haptel::tools::plot {

Picture::Picture(double width, double height, double pixels_per_point)
    : width_(width)
    , height_(height)
    , pixels_per_point_(pixels_per_point)
    , surface_(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::lround(width * pixels_per_point)),
                                          static_cast<int>(std::lround(height * pixels_per_point))),
               cairo_surface_destroy)
    , cairo_(cairo_create(surface_.get()), cairo_destroy)
{
    cairo_scale(cairo_.get(), pixels_per_point, pixels_per_point);
    cairo_set_line_join(cairo_.get(), CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(cairo_.get(), CAIRO_LINE_CAP_ROUND);
    fill({0, 0, width, height}, {1, 1, 1});
}

void Picture::use(const Color& color)
{
    cairo_set_source_rgba(cairo_.get(), color.red, color.green, color.blue, color.alpha);
}

void Picture::use(const TextStyle& style)
{
    cairo_select_font_face(cairo_.get(), "DejaVu Sans", CAIRO_FONT_SLANT_NORMAL,
                           style.bold ? CAIRO_FONT_WEIGHT_BOLD : CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(cairo_.get(), style.size);
    use(style.color);
}

void Picture::fill(const Rect& rect, const Color& color)
{
    use(color);
    cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
    cairo_fill(cairo_.get());
}

void Picture::frame(const Rect& rect, const Color& color, double line_width)
{
    use(color);
    cairo_set_line_width(cairo_.get(), line_width);
    cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
    cairo_stroke(cairo_.get());
}

void Picture::line(Point from, Point to, const Color& color, double line_width)
{
    const Point points[] = {from, to};
    polyline(points, color, line_width);
}

void Picture::polyline(std::span<const Point> points, const Color& color, double line_width)
{
    use(color);
    cairo_set_line_width(cairo_.get(), line_width);
    for (const Point& point : points) cairo_line_to(cairo_.get(), point.x, point.y);
    cairo_stroke(cairo_.get());
}

void Picture::image(const Rect& rect, const Image& image)
{
    const auto byte = [](double share) {
        return static_cast<uint32_t>(std::lround(std::clamp(share, 0.0, 1.0) * 255));
    };
    std::vector<uint32_t> pixels; // of CAIRO_FORMAT_RGB24, whose stride for 4-byte pixels is the width
    pixels.reserve(image.pixels.size());
    for (const Color& c : image.pixels) pixels.push_back(byte(c.red) << 16 | byte(c.green) << 8 | byte(c.blue));
    const std::shared_ptr<cairo_surface_t> source(
        cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(pixels.data()), CAIRO_FORMAT_RGB24,
                                            image.width, image.height, image.width * 4),
        cairo_surface_destroy);
    cairo_save(cairo_.get());
    cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
    cairo_clip(cairo_.get());
    cairo_translate(cairo_.get(), rect.x, rect.y);
    cairo_scale(cairo_.get(), rect.width / image.width, rect.height / image.height);
    cairo_set_source_surface(cairo_.get(), source.get(), 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo_.get()), CAIRO_FILTER_NEAREST);
    cairo_pattern_set_extend(cairo_get_source(cairo_.get()), CAIRO_EXTEND_PAD);
    cairo_paint(cairo_.get());
    cairo_restore(cairo_.get());
}

double Picture::text_width(std::string_view text, const TextStyle& style)
{
    use(style);
    cairo_text_extents_t extents;
    cairo_text_extents(cairo_.get(), std::string(text).c_str(), &extents);
    return extents.x_advance;
}

void Picture::text(Point at, std::string_view text, const TextStyle& style)
{
    const double width = text_width(text, style);
    cairo_save(cairo_.get());
    cairo_translate(cairo_.get(), at.x, at.y);
    if (style.upright) cairo_rotate(cairo_.get(), -std::numbers::pi / 2);
    cairo_move_to(cairo_.get(), style.align == Align::left ? 0 : style.align == Align::center ? -width / 2 : -width, 0);
    cairo_show_text(cairo_.get(), std::string(text).c_str());
    cairo_new_path(cairo_.get());
    cairo_restore(cairo_.get());
}

void Picture::begin_clip(const Rect& rect)
{
    cairo_save(cairo_.get());
    cairo_rectangle(cairo_.get(), rect.x, rect.y, rect.width, rect.height);
    cairo_clip(cairo_.get());
}

void Picture::end_clip()
{
    cairo_restore(cairo_.get());
}

std::string Picture::write_png(const std::string& file)
{
    cairo_status_t status = cairo_status(cairo_.get());
    errno = 0; // cairo does not tell what the system said
    if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_write_to_png(surface_.get(), file.c_str());
    if (status == CAIRO_STATUS_SUCCESS) return {};
    const bool is_of_system = status == CAIRO_STATUS_WRITE_ERROR && errno != 0;
    return fmt::format("cannot write the picture '{}': {}", file,
                       is_of_system ? std::strerror(errno) : cairo_status_to_string(status));
}

std::string Picture::png()
{
    std::string bytes;
    const auto append = [](void* to, const unsigned char* data, unsigned int count) {
        static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), count);
        return CAIRO_STATUS_SUCCESS;
    };
    const cairo_status_t status = cairo_surface_write_to_png_stream(surface_.get(), append, &bytes);
    return status == CAIRO_STATUS_SUCCESS ? bytes : "";
}

} // namespace haptel::tools::plot
